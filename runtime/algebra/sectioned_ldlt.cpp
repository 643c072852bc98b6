#include "railtab/runtime/algebra/sectioned_ldlt.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>
#include <string>

#include "railtab/runtime/algebra/elimination_order.hpp"
#include "railtab/runtime/algebra/elimination_tree.hpp"
#include "railtab/runtime/base/index.hpp"
#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

namespace {

using Sparse = Eigen::SparseMatrix<double>;
constexpr int side_by_side = SectionLayout::sections;
constexpr int widest = 4;  // columns of a strip: their parts of the vector stay in registers

// The entry of L that stands at a place, of all sections.
Lanes entry(const float* value, int place) noexcept {
  Lanes of_sections;
  widen(value + place * side_by_side, of_sections);
  return of_sections;
}

template <int n>
void forward_columns(const int* slot, int rows, const float* value, Lanes* y) noexcept {
  Lanes own[n];
  own[0] = y[slot[0]];
  for (int j = 1; j < n; ++j) {
    own[j] = y[slot[j]];
    for (int k = 0; k < j; ++k) own[j] -= entry(value, j * (j - 1) / 2 + k) * own[k];
    y[slot[j]] = own[j];
  }
  value += n * (n - 1) / 2 * side_by_side;
  for (const int* row = slot + n; row < slot + n + rows; ++row, value += n * side_by_side) {
    Lanes sum = y[*row];
    for (int k = 0; k < n; ++k) sum -= entry(value, k) * own[k];
    y[*row] = sum;
  }
}

template <int n>
void backward_columns(const int* slot, int rows, const float* value, const Lanes* inverse_D, const Lanes* y,
                      Lanes* x) noexcept {
  Lanes own[n];
  for (int j = 0; j < n; ++j) own[j] = y[slot[j]] * inverse_D[j];
  // From the last row on, which was solved first: x of the first rows may just have been stored.
  const float* below = value + (n * (n - 1) / 2 + n * rows) * side_by_side;
  for (const int* row = slot + n + rows; row-- > slot + n;) {
    below -= n * side_by_side;
    for (int k = 0; k < n; ++k) own[k] -= entry(below, k) * x[*row];
  }
  for (int j = n; j-- > 1;) {
    for (int k = 0; k < j; ++k) own[k] -= entry(value, j * (j - 1) / 2 + k) * own[j];
  }
  for (int j = 0; j < n; ++j) x[slot[j]] = own[j];
}

// To floats. Those that would be denormal are zero: widening them again takes some processors a hundred times as long.
Lanes rounded(Lanes numbers) noexcept {
  for (int s = 0; s < side_by_side; ++s) {
    const auto number = static_cast<float>(numbers[s]);
    numbers[s] = std::abs(number) < std::numeric_limits<float>::min() ? 0.0 : double{number};
  }
  return numbers;
}

// Far from its load a solution decays until it is a denormal number, on which a processor is a hundred times slower.
bool vanishes(Lanes& y) noexcept {
  constexpr double nothing = 1e-40;
  const bool fades = all(abs(y) < broadcast<Lanes>(nothing));  // false for a NaN, which must reach the solution
  if (fades) y = Lanes{};
  return fades;
}

}  // namespace

/// Columns of L by ranks in the order of elimination, the border's slots last.
struct SectionedLdlt::Numbers {
  std::vector<int> begin{0}, row;
  std::vector<Lanes> value, diagonal;
  std::vector<Lanes> border;                          // borders × borders, of the lower triangle, by columns
  std::vector<Eigen::Triplet<double>> of_interfaces;  // entries between interface unknowns

  /// Where the entry of a row stands in a column.
  [[nodiscard]] std::size_t at(int rank, int column) const {
    const auto first = row.begin() + begin[index(column)], last = row.begin() + begin[index(column + 1)];
    return index(static_cast<int>(std::lower_bound(first, last, rank) - row.begin()));
  }
};

namespace {

// Minimum degree, the borders' slots as a clique that comes last.
EliminationTree tree_of(int slots, int borders, std::vector<Eigen::Triplet<double>> pairs) {
  const int all = slots + borders;
  for (int i = slots; i < all; ++i) {
    for (int j = slots; j < all; ++j) pairs.emplace_back(i, j, 1.0);
  }
  Sparse pattern(all, all);
  pattern.setFromTriplets(pairs.begin(), pairs.end());
  const DofRange whole{0, all};
  std::vector<int> order = elimination_order(pattern, whole, EliminationOrder::minimum_degree);
  std::erase_if(order, [&](int slot) { return slot >= slots; });
  for (int i = slots; i < all; ++i) order.push_back(i);
  return {pattern, whole, std::move(order)};
}

}  // namespace

SectionedLdlt::SectionedLdlt(const Sparse& matrix, std::shared_ptr<const SectionLayout> layout,
                             std::string_view message)
    : layout_(std::move(layout)) {
  const SectionLayout& l = *layout_;
  const SectionLayout::Entries entries = l.entries({&matrix});
  std::vector<Eigen::Triplet<double>> pairs;  // of slots that some section couples
  for (int j = 0; j < l.slots; ++j) {
    entries.visit_rows(j, [&](int row, auto) {
      pairs.emplace_back(row, j, 1.0);
      if (row != j) pairs.emplace_back(j, row, 1.0);
    });
  }
  const EliminationTree tree = tree_of(l.slots, l.borders, std::move(pairs));
  set_strips(tree);
  Numbers numbers;
  for (const Strip& strip : strip_) {
    const int* const slot = &slot_[index(strip.slot)];
    for (int j = 0; j < strip.columns; ++j) {
      for (int k = j + 1; k < strip.columns + strip.rows; ++k) numbers.row.push_back(tree.position[index(slot[k])]);
      numbers.begin.push_back(static_cast<int>(numbers.row.size()));
    }
  }
  numbers.value.assign(numbers.row.size(), Lanes{});
  numbers.diagonal.assign(index(l.slots), broadcast<Lanes>(1.0));  // of a section that lacks the unknown
  numbers.border.assign(index(l.borders * l.borders), Lanes{});
  for (int j = 0; j < l.slots; ++j) {
    entries.visit_rows(j, [&](int i, std::span<const SectionLayout::Entries::OfSection> of_sections) {
      const auto [column, row] = std::minmax(tree.position[index(i)], tree.position[index(j)]);
      Lanes& value = row == column ? numbers.diagonal[index(column)] : numbers.value[numbers.at(row, column)];
      for (const SectionLayout::Entries::OfSection& e : of_sections) value[e.section] = e.value;
    });
  }
  for (const auto& e : entries.interfaces) {
    numbers.of_interfaces.emplace_back(e.row, e.column, e.value);
    if (e.row != e.column) numbers.of_interfaces.emplace_back(e.column, e.row, e.value);
  }
  eliminate(numbers, message);
  factor_interfaces(numbers, message);
  store(numbers);
}

// The border's columns stay rows: theirs are eliminated with the interface unknowns.
void SectionedLdlt::set_strips(const EliminationTree& tree) {
  const int slots = layout_->slots;
  strip_of_.resize(index(slots));
  for (int b = 0; b < tree.blocks(); ++b) {
    const int end = tree.first[index(b) + 1], last = std::min(end, slots);
    for (int first = tree.first[index(b)]; first < last; first += widest) {
      Strip strip{std::min(widest, last - first), 0, -1, first, static_cast<int>(slot_.size()), 0};
      for (int k = first; k < end; ++k) slot_.push_back(tree.unknown[index(k)]);
      for (const int k : tree.rows(b)) slot_.push_back(tree.unknown[index(k)]);
      strip.rows = static_cast<int>(slot_.size()) - strip.slot - strip.columns;
      for (int j = 0; j < strip.columns; ++j) {
        strip_of_[index(slot_[index(strip.slot + j)])] = static_cast<int>(strip_.size());
      }
      strip_.push_back(strip);
    }
  }
  int values = 0;
  for (Strip& strip : strip_) {
    if (strip.rows > 0) {
      const int row = slot_[index(strip.slot + strip.columns)];
      strip.parent = row < slots ? strip_of_[index(row)] : -1;
    }
    strip.value = values;
    values += strip.columns * (strip.columns - 1) / 2 + strip.columns * strip.rows;
  }
  value_.resize(index(values) * side_by_side);
}

// Right-looking: a finished column changes the columns of its rows, whose rows include the further ones of its own. Its
// entries are rounded to floats before they do: the factor then is that of a matrix whose diagonal is the given one.
void SectionedLdlt::eliminate(Numbers& n, std::string_view message) const {
  const int slots = layout_->slots, borders = layout_->borders;
  for (int j = 0; j < slots; ++j) {
    const Lanes d = n.diagonal[index(j)], inverse = 1.0 / d;
    for (int s = 0; s < side_by_side; ++s) {
      if (!(d[s] > 0.0)) throw ComputationError(std::string(message));
    }
    n.diagonal[index(j)] = inverse;
    const int begin = n.begin[index(j)], end = n.begin[index(j + 1)];
    for (int p = begin; p < end; ++p) n.value[index(p)] = rounded(n.value[index(p)] * inverse);
    for (int p = begin; p < end; ++p) {
      const int k = n.row[index(p)];
      const Lanes factor = n.value[index(p)] * d;
      if (k >= slots) {
        for (int q = p; q < end; ++q) {
          n.border[index((k - slots) * borders + n.row[index(q)] - slots)] -= factor * n.value[index(q)];
        }
        continue;
      }
      n.diagonal[index(k)] -= factor * n.value[index(p)];
      int place = n.begin[index(k)];
      for (int q = p + 1; q < end; ++q) {
        while (n.row[index(place)] != n.row[index(q)]) ++place;
        n.value[index(place)] -= factor * n.value[index(q)];
      }
    }
  }
}

void SectionedLdlt::store(const Numbers& numbers) {
  inverse_D_ = numbers.diagonal;
  for (const Strip& strip : strip_) {
    for (int j = 0; j < strip.columns; ++j) {
      const int* const unknown = &layout_->unknown[index(slot_[index(strip.slot + j)]) * side_by_side];
      // Where a section lacks the unknown, its solution is zero. The load there is not: SectionedProduct takes entries
      // as alike in all sections.
      for (int k = 0; k < side_by_side; ++k) {
        if (unknown[k] < 0) inverse_D_[index(strip.first + j)][k] = 0.0;
      }
    }
    float* value = value_.data() + index(strip.value) * side_by_side;
    for (int row = 1; row < strip.columns + strip.rows; ++row) {
      for (int j = 0; j < std::min(row, strip.columns); ++j) {
        const Lanes& of = numbers.value[index(numbers.begin[index(strip.first + j)] + row - j - 1)];
        for (int k = 0; k < side_by_side; ++k) *value++ = static_cast<float>(of[k]);
      }
    }
  }
}

void SectionedLdlt::factor_interfaces(const Numbers& numbers, std::string_view message) {
  const SectionLayout& l = *layout_;
  const auto count = static_cast<Eigen::Index>(l.interfaces.size());
  if (count == 0) return;
  std::vector<Eigen::Triplet<double>> entries = numbers.of_interfaces;
  for (int c = 0; c < l.borders; ++c) {
    for (int r = c; r < l.borders; ++r) {
      const Lanes& change = numbers.border[static_cast<std::size_t>(c * l.borders + r)];
      for (int s = 0; s < side_by_side; ++s) {
        const int i = l.border_of[static_cast<std::size_t>(side_by_side * r + s)];
        const int j = l.border_of[static_cast<std::size_t>(side_by_side * c + s)];
        if (i < 0 || j < 0 || change[s] == 0.0) continue;
        entries.emplace_back(i, j, change[s]);
        if (i != j) entries.emplace_back(j, i, change[s]);
      }
    }
  }
  Sparse schur(count, count);
  schur.setFromTriplets(entries.begin(), entries.end());
  interfaces_ = std::make_unique<SparseLdlt>(schur, message);
}

Eigen::Index SectionedLdlt::room() const noexcept { return factor_begin() + (interfaces_ ? interfaces_->room() : 0); }

std::size_t SectionedLdlt::bytes() const noexcept {
  return value_.size() * sizeof(float) + inverse_D_.size() * sizeof(Lanes) + slot_.size() * sizeof(int) +
         strip_.size() * sizeof(Strip) + (interfaces_ ? interfaces_->bytes() : 0);
}

std::size_t SectionedLdlt::stored_bytes() const noexcept {
  return bytes() + layout_->bytes() + strip_of_.size() * sizeof(int) +
         (interfaces_ ? interfaces_->stored_bytes() - interfaces_->bytes() : 0);
}

void SectionedLdlt::find_path(std::span<const int> unknowns, Path& path) const {
  path.clear(strip_.size());
  for (int unknown : unknowns) {
    for (const int part : {unknown, layout_->standing[index(unknown - range_begin())].other}) {
      if (part < 0) continue;
      const SectionLayout::Place& p = layout_->place[index(part - range_begin())];
      if (p.section < 0) continue;
      path.add(strip_of_[index(p.number)], [&](int s) { return strip_[index(s)].parent; });
    }
  }
  path.sort();
}

bool SectionedLdlt::covers(const Path& path, std::span<const int> unknowns) const {
  const auto covered = [&](int unknown) {
    assert(unknown >= layout_->range.begin && unknown < layout_->range.end());
    const SectionLayout::Place& p = layout_->place[index(unknown - range_begin())];
    return p.section < 0 || path.contains(strip_of_[index(p.number)]);
  };
  return std::all_of(unknowns.begin(), unknowns.end(), [&](int unknown) {
    const int other = layout_->standing[index(unknown - range_begin())].other;
    return covered(unknown) && (other < 0 || covered(other));
  });
}

template <class Visitor>
void SectionedLdlt::visit_slots(const Path& path, Visitor&& visitor) const {
  for (int s : path.nodes()) {
    const Strip& strip = strip_[index(s)];
    for (int j = 0; j < strip.columns; ++j) visitor(slot_[index(strip.slot + j)]);
  }
}

void SectionedLdlt::into(const Vector& natural, Vector& ordered) const {
  ordered.resize(room());
  ordered.tail(room() - layout_->border_begin()).setZero();
  layout_->into(natural, ordered);
}

void SectionedLdlt::into(std::span<const int> few, double weight, const Vector& natural, Vector& ordered) const {
  ordered.setZero(room());
  set(few, weight, natural, ordered);
}

void SectionedLdlt::set(std::span<const int> few, double weight, const Vector& natural, Vector& ordered) const {
  const double of_pair = root_half * weight;
  for (int unknown : few) {
    const auto& [sum, difference, other] = layout_->standing[index(unknown - range_begin())];
    const double value = natural[unknown];
    if (other < 0) {
      ordered[sum] = weight * value;
      continue;
    }
    const double of_other = natural[other];
    if (other < unknown && of_other != 0.0) continue;  // not zero, so one of the few: it sets both
    ordered[sum] = of_pair * (value + of_other);
    ordered[difference] = of_pair * (unknown < other ? value - of_other : of_other - value);
  }
}

void SectionedLdlt::out_of(const Vector& ordered, Vector& natural) const {
  natural.conservativeResize(std::max(natural.size(), layout_->range.end()));
  layout_->out_of(ordered, natural);
}

void SectionedLdlt::load(const Path& path, std::span<const int> few, double weight, const Vector& natural,
                         Vector& ordered) const {
  Lanes* const y = lanes(ordered);
  visit_slots(path, [&](int slot) { y[slot] = Lanes{}; });
  ordered.tail(room() - layout_->border_begin()).setZero();
  set(few, weight, natural, ordered);
}

void SectionedLdlt::read(std::span<const int> few, const Vector& ordered, Vector& natural) const {
  for (int unknown : few) natural[unknown] = layout_->value(ordered, unknown);
}

void SectionedLdlt::forward_interfaces(Vector& y) const {
  if (!interfaces_) return;
  layout_->fold_borders(y);
  const double* const natural = y.data() + layout_->interface_begin();
  double* const ordered = y.data() + factor_begin();
  for (int k = 0; k < interfaces_->size(); ++k) ordered[interfaces_->position(k)] = natural[k];
  interfaces_->forward(ordered);
}

void SectionedLdlt::backward_interfaces(const Vector& y, Vector& x) const {
  if (!interfaces_) return;
  double* const natural = x.data() + layout_->interface_begin();
  double* const ordered = x.data() + factor_begin();
  std::copy_n(y.data() + factor_begin(), interfaces_->size(), ordered);
  interfaces_->backward(ordered);
  for (int k = 0; k < interfaces_->size(); ++k) natural[k] = ordered[interfaces_->position(k)];
  layout_->spread_interfaces(x);
}

void SectionedLdlt::forward_strip(const Strip& strip, Lanes* y) const noexcept {
  const int* const slot = &slot_[index(strip.slot)];
  const float* const value = value_.data() + index(strip.value) * side_by_side;
  switch (strip.columns) {
    case 1:
      return forward_columns<1>(slot, strip.rows, value, y);
    case 2:
      return forward_columns<2>(slot, strip.rows, value, y);
    case 3:
      return forward_columns<3>(slot, strip.rows, value, y);
    default:
      return forward_columns<widest>(slot, strip.rows, value, y);
  }
}

void SectionedLdlt::backward_strip(const Strip& strip, const Lanes* y, Lanes* x) const noexcept {
  const int* const slot = &slot_[index(strip.slot)];
  const float* const value = value_.data() + index(strip.value) * side_by_side;
  const Lanes* const inverse_D = &inverse_D_[index(strip.first)];
  switch (strip.columns) {
    case 1:
      return backward_columns<1>(slot, strip.rows, value, inverse_D, y, x);
    case 2:
      return backward_columns<2>(slot, strip.rows, value, inverse_D, y, x);
    case 3:
      return backward_columns<3>(slot, strip.rows, value, inverse_D, y, x);
    default:
      return backward_columns<widest>(slot, strip.rows, value, inverse_D, y, x);
  }
}

void SectionedLdlt::forward(Vector& y) const {
  for (const Strip& strip : strip_) forward_strip(strip, lanes(y));
  forward_interfaces(y);
}

void SectionedLdlt::forward(Vector& y, const Path& path, const Vector& known) const {
  Lanes* const numbers = lanes(y);
  const Lanes* const more = lanes(known);
  for (int s : path.nodes()) {
    const Strip& strip = strip_[index(s)];
    const std::span slots = std::span(slot_).subspan(index(strip.slot), index(strip.columns));
    bool nothing = true;
    for (int slot : slots) nothing &= vanishes(numbers[slot]);
    if (!nothing) forward_strip(strip, numbers);
    for (int slot : slots) numbers[slot] += more[slot];  // no strip after this one reads them
  }
  forward_interfaces(y);
  if (!interfaces_) return;
  y.segment(factor_begin(), interfaces_->size()) += known.segment(factor_begin(), interfaces_->size());
}

void SectionedLdlt::backward(const Vector& y, Vector& x, const Path& path) const {
  backward_interfaces(y, x);
  for (auto s = path.nodes().rbegin(); s != path.nodes().rend(); ++s) {
    backward_strip(strip_[index(*s)], lanes(y), lanes(x));
  }
}

void SectionedLdlt::backward_off(const Path& path, const Vector& y, Vector& x) const {
  for (int s = static_cast<int>(strip_.size()); s-- > 0;) {
    if (!path.contains(s)) backward_strip(strip_[index(s)], lanes(y), lanes(x));
  }
}

}  // namespace railtab
