#include "railtab/runtime/algebra/sectioned_ldlt.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <string>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

namespace {

using Sparse = Eigen::SparseMatrix<double>;
constexpr int side_by_side = SectionLayout::sections;

/// Columns of the factor as a substitution reads them, in the order of elimination; their slots and rows.
struct LaneColumns {
  const int* slot;
  const int* begin;
  const int* row;
  const Lanes* value;
};

void forward_column(const LaneColumns& c, int j, Lanes* y) noexcept {
  const Lanes own = y[c.slot[j]];
  for (int p = c.begin[j]; p < c.begin[j + 1]; ++p) y[c.row[p]] -= c.value[p] * own;
}

void backward_column(const LaneColumns& c, int j, const Lanes* inverse_D, const Lanes* y, Lanes* x) noexcept {
  Lanes own = y[c.slot[j]] * inverse_D[j];
  // The first row is often the column just solved: read last, it hides the time that its store takes.
  for (int p = c.begin[j + 1]; p-- > c.begin[j];) own -= c.value[p] * x[c.row[p]];
  x[c.slot[j]] = own;
}

// Far from its load a solution decays until it is a denormal number, on which a processor is a hundred times slower.
bool vanishes(Lanes& y) noexcept {
  constexpr double nothing = 1e-40;
  bool all = true;  // false for a NaN, which must reach the solution
  for (int s = 0; s < side_by_side; ++s) all &= std::abs(y[s]) < nothing;
  if (all) y = Lanes{};
  return all;
}

}  // namespace

/// LaneColumns with their rows' places, and what is left of the border's slots, while the factor is made.
struct SectionedLdlt::Numbers {
  std::vector<Lanes> diagonal;                        // of the slots
  std::vector<Lanes> border;                          // borders × borders, of the lower triangle, by columns
  std::vector<Eigen::Triplet<double>> of_interfaces;  // entries between interface unknowns

  explicit Numbers(const SectionLayout& layout)
      : diagonal(static_cast<std::size_t>(layout.slots)),
        border(static_cast<std::size_t>(layout.borders) * static_cast<std::size_t>(layout.borders)) {}
};

SectionedLdlt::SectionedLdlt(const Sparse& matrix, std::shared_ptr<const SectionLayout> layout,
                             std::string_view message)
    : layout_(std::move(layout)), rank_(static_cast<std::size_t>(layout_->slots + layout_->borders)) {
  for (int k = 0; k < layout_->slots; ++k) {
    rank_[static_cast<std::size_t>(layout_->elimination[static_cast<std::size_t>(k)])] = k;
  }
  std::iota(rank_.begin() + layout_->slots, rank_.end(), layout_->slots);
  find_columns(matrix);
  Numbers numbers(*layout_);
  const SectionLayout& l = *layout_;
  for (Lanes& d : numbers.diagonal) {
    for (int s = 0; s < side_by_side; ++s) d[s] = 1.0;  // of a section that lacks the unknown
  }
  l.visit_places(matrix, [&](const SectionLayout::EntryPlace& p, double value) {
    if (p.section < 0) {
      numbers.of_interfaces.emplace_back(p.row, p.column, value);
    } else if (const int row = rank(p.row), column = rank(p.column); row == column) {
      numbers.diagonal[static_cast<std::size_t>(row)][p.section] = value;
    } else if (row > column) {
      const auto first = row_.begin() + begin_[static_cast<std::size_t>(column)];
      const auto last = row_.begin() + begin_[static_cast<std::size_t>(column + 1)];
      value_[static_cast<std::size_t>(std::lower_bound(first, last, row) - row_.begin())][p.section] = value;
    }
  });
  eliminate(numbers, message);
  factor_interfaces(numbers, message);
  for (int& row : row_) {
    if (row < l.slots) row = l.elimination[static_cast<std::size_t>(row)];
  }
}

// Rows of L: those of the matrix's column and of every column whose first row this one is [Davis2006, Sect. 4.1].
void SectionedLdlt::find_columns(const Sparse& matrix) {
  const SectionLayout& l = *layout_;
  const auto n = static_cast<std::size_t>(l.slots);
  std::vector<std::vector<int>> rows(n);
  l.visit_places(matrix, [&](const SectionLayout::EntryPlace& p, double) {
    if (p.section < 0) return;
    const int row = rank(p.row), column = rank(p.column);
    if (row > column) rows[static_cast<std::size_t>(column)].push_back(row);
  });
  begin_.assign(1, 0);
  for (std::vector<int>& column : rows) {
    std::sort(column.begin(), column.end());
    column.erase(std::unique(column.begin(), column.end()), column.end());
    row_.insert(row_.end(), column.begin(), column.end());
    begin_.push_back(static_cast<int>(row_.size()));
    if (column.empty() || column.front() >= l.slots) continue;
    std::vector<int>& parent = rows[static_cast<std::size_t>(column.front())];
    parent.insert(parent.end(), column.begin() + 1, column.end());
    column = {};
  }
  value_.assign(row_.size(), Lanes{});
  inverse_D_.resize(n);
}

// Right-looking: a finished column changes the columns of its rows, whose rows include the further ones of its own.
void SectionedLdlt::eliminate(Numbers& numbers, std::string_view message) {
  const int n = layout_->slots, borders = layout_->borders;
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  for (int j = 0; j < n; ++j) {
    const Lanes& d = numbers.diagonal[at(j)];
    for (int s = 0; s < side_by_side; ++s) {
      if (!(d[s] > 0.0)) throw ComputationError(std::string(message));
    }
    const Lanes inverse = 1.0 / d;
    inverse_D_[at(j)] = inverse;
    const int end = begin_[at(j + 1)];
    for (int p = begin_[at(j)]; p < end; ++p) {
      const int k = row_[at(p)];
      const Lanes factor = value_[at(p)] * inverse;
      if (k >= n) {
        for (int q = p; q < end; ++q) {
          numbers.border[at((k - n) * borders + row_[at(q)] - n)] -= factor * value_[at(q)];
        }
        continue;
      }
      numbers.diagonal[at(k)] -= factor * value_[at(p)];
      int place = begin_[at(k)];
      for (int q = p + 1; q < end; ++q) {
        while (row_[at(place)] != row_[at(q)]) ++place;
        value_[at(place)] -= factor * value_[at(q)];
      }
    }
    for (int p = begin_[at(j)]; p < end; ++p) value_[at(p)] *= inverse;
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
  return (value_.size() + inverse_D_.size()) * sizeof(Lanes) + (row_.size() + begin_.size()) * sizeof(int) +
         (interfaces_ ? interfaces_->bytes() : 0);
}

std::size_t SectionedLdlt::stored_bytes() const noexcept {
  return bytes() + layout_->place.size() * sizeof(SectionLayout::Place) + layout_->border_of.size() * sizeof(int) +
         (interfaces_ ? interfaces_->stored_bytes() - interfaces_->bytes() : 0);
}

void SectionedLdlt::find_path(std::span<const int> unknowns, Path& path) const {
  path.clear(inverse_D_.size());
  for (int unknown : unknowns) {
    const auto own = static_cast<std::size_t>(unknown - layout_->range.begin);
    for (const int part : {unknown, layout_->mirrored[own]}) {
      if (part < 0) continue;
      const SectionLayout::Place& p = layout_->place[static_cast<std::size_t>(part - layout_->range.begin)];
      if (p.section < 0) continue;
      path.add(rank(p.number), [&](int j) {
        const int first = begin_[static_cast<std::size_t>(j)];
        if (first == begin_[static_cast<std::size_t>(j + 1)]) return -1;
        const int row = row_[static_cast<std::size_t>(first)];
        return row < layout_->slots ? rank(row) : -1;
      });
    }
  }
  path.sort();
}

bool SectionedLdlt::covers(const Path& path, std::span<const int> unknowns) const {
  const auto covered = [&](int unknown) {
    assert(unknown >= layout_->range.begin && unknown < layout_->range.end());
    const SectionLayout::Place& p = layout_->place[static_cast<std::size_t>(unknown - layout_->range.begin)];
    return p.section < 0 || path.contains(rank(p.number));
  };
  return std::all_of(unknowns.begin(), unknowns.end(), [&](int unknown) {
    const int other = layout_->mirrored[static_cast<std::size_t>(unknown - layout_->range.begin)];
    return covered(unknown) && (other < 0 || covered(other));
  });
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
    const int other = layout_->mirrored[static_cast<std::size_t>(unknown - layout_->range.begin)];
    const double value = natural[unknown];
    if (other < 0) {
      ordered[layout_->position(unknown)] = weight * value;
      continue;
    }
    const double of_other = natural[other];
    if (other < unknown && of_other != 0.0) continue;  // not zero, so one of the few: it sets both
    const auto [first, second] = std::minmax(unknown, other);
    ordered[layout_->position(first)] = of_pair * (value + of_other);
    ordered[layout_->position(second)] = of_pair * (unknown < other ? value - of_other : of_other - value);
  }
}

void SectionedLdlt::out_of(const Vector& ordered, Vector& natural) const {
  natural.conservativeResize(std::max(natural.size(), layout_->range.end()));
  layout_->out_of(ordered, natural);
}

void SectionedLdlt::load(const Path& path, std::span<const int> few, double weight, const Vector& natural,
                         Vector& ordered) const {
  Lanes* const y = lanes(ordered);
  for (int j : path.nodes()) y[layout_->elimination[static_cast<std::size_t>(j)]] = Lanes{};
  ordered.tail(room() - layout_->border_begin()).setZero();
  set(few, weight, natural, ordered);
}

void SectionedLdlt::add(const Path& path, const Vector& known, Vector& y) const {
  Lanes* const to = lanes(y);
  const Lanes* const from = lanes(known);
  for (int j : path.nodes()) {
    const int slot = layout_->elimination[static_cast<std::size_t>(j)];
    to[slot] += from[slot];
  }
  const Eigen::Index count = room() - factor_begin();
  y.tail(count) += known.tail(count);
}

void SectionedLdlt::read(std::span<const int> few, const Vector& ordered, Vector& natural) const {
  for (int unknown : few) {
    natural[unknown] = layout_->combined(unknown, [&](Eigen::Index k) { return ordered[layout_->position(k)]; });
  }
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
  std::copy_n(y.data() + factor_begin(), interfaces_->room(), ordered);
  interfaces_->backward(ordered);
  for (int k = 0; k < interfaces_->size(); ++k) natural[k] = ordered[interfaces_->position(k)];
  layout_->spread_interfaces(x);
}

void SectionedLdlt::forward(Vector& y) const {
  const LaneColumns columns{layout_->elimination.data(), begin_.data(), row_.data(), value_.data()};
  for (int j = 0; j < layout_->slots; ++j) forward_column(columns, j, lanes(y));
  forward_interfaces(y);
}

void SectionedLdlt::forward(Vector& y, const Path& path) const {
  const LaneColumns columns{layout_->elimination.data(), begin_.data(), row_.data(), value_.data()};
  Lanes* const numbers = lanes(y);
  for (int j : path.nodes()) {
    if (!vanishes(numbers[columns.slot[j]])) forward_column(columns, j, numbers);
  }
  forward_interfaces(y);
}

void SectionedLdlt::backward(const Vector& y, Vector& x, const Path& path) const {
  backward_interfaces(y, x);
  const LaneColumns columns{layout_->elimination.data(), begin_.data(), row_.data(), value_.data()};
  for (auto j = path.nodes().rbegin(); j != path.nodes().rend(); ++j) {
    backward_column(columns, *j, inverse_D_.data(), lanes(y), lanes(x));
  }
}

void SectionedLdlt::backward_off(const Path& path, const Vector& y, Vector& x) const {
  const LaneColumns columns{layout_->elimination.data(), begin_.data(), row_.data(), value_.data()};
  for (int j = layout_->slots; j-- > 0;) {
    if (!path.contains(j)) backward_column(columns, j, inverse_D_.data(), lanes(y), lanes(x));
  }
}

}  // namespace railtab
