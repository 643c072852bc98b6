#include "railtab/runtime/algebra/section_layout.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "railtab/runtime/base/index.hpp"
#include "railtab/runtime/base/pack.hpp"

namespace railtab {

namespace {

using Sparse = Eigen::SparseMatrix<double>;
constexpr int sections = SectionLayout::sections;
constexpr double rounding = 1e-6;  // of positions [m]

struct Cuts {
  std::array<double, sections> x;  // where each section begins; what stands before the first belongs to it

  [[nodiscard]] int section(double at) const {
    return static_cast<int>(std::upper_bound(x.begin() + 1, x.end(), at + rounding) - x.begin()) - 1;
  }
};

/// Positions of a line's unknowns in the range, increasing.
using Lines = std::map<int, std::vector<double>>;

Lines lines_of(const UnknownPlaces& places, const DofRange& range) {
  Lines lines;
  for (Eigen::Index i = range.begin; i < range.end(); ++i) {
    const auto u = static_cast<std::size_t>(i);
    lines[places.line[u]].push_back(places.x[u]);
  }
  return lines;
}

/// The line with the fewest nodes of those that go nearly all the way; empty where there is none.
std::vector<double> sparsest_line(const Lines& lines, double from, double to) {
  constexpr double share = 0.95;
  std::vector<double> sparsest;
  for (const auto& [line, x] : lines) {
    if (x.back() - x.front() < share * (to - from)) continue;
    if (sparsest.empty() || x.size() < sparsest.size()) sparsest = x;
  }
  return sparsest;
}

/// How far the sections' nodes stand from each other: of every line and cut, the distance from the cut to the next node
/// against that of the cut before [m].
double mismatch(const Lines& lines, const Cuts& cuts) {
  double sum = 0.0;
  for (const auto& [line, x] : lines) {
    double before = std::nan("");
    for (int k = 1; k < sections; ++k) {
      const double cut = cuts.x[static_cast<std::size_t>(k)];
      const auto next = std::lower_bound(x.begin(), x.end(), cut - rounding);
      if (next == x.end() || next == x.begin()) continue;
      const double offset = *next - cut;
      if (!std::isnan(before)) sum += std::abs(offset - before);
      before = offset;
    }
  }
  return sum;
}

/// Cuts at equal numbers of bays of the sparsest line, the last section being what is left; up to an eighth more than
/// needed where the sections' nodes then coincide better.
std::optional<Cuts> best_cuts(const Lines& lines, double from, double to) {
  const std::vector<double> node = sparsest_line(lines, from, to);
  constexpr int least_bays = 6;  // of a section
  if (node.size() < static_cast<std::size_t>(least_bays * sections)) return std::nullopt;
  const int bays = static_cast<int>(node.size()) - 1;
  const int equal = (bays + sections - 1) / sections;
  std::optional<Cuts> best;
  double least = 0.0;
  for (int length = equal; length <= equal + equal / 8 && (sections - 1) * length < bays; ++length) {
    Cuts cuts;
    for (int k = 0; k < sections; ++k) {
      cuts.x[static_cast<std::size_t>(k)] = node[static_cast<std::size_t>(k * length)];
    }
    const double sum = mismatch(lines, cuts);
    if (best && sum > least - rounding) continue;
    best = cuts;
    least = sum;
  }
  return best;
}

/// An unknown that waits for its slot.
struct Waiting {
  double x;  // from where its section begins [m]
  int section;
  Eigen::Index unknown;
};

/// Slots of one line: unknowns of different sections share one where they stand nearly at the same place; calls
/// assign(unknown, slot).
template <class Assign>
int share_slots(std::vector<Waiting>& line, int slot, Assign&& assign) {
  constexpr double reach = 0.75;  // of the spacing: nodes of sections cut at any phase then share few slots
  std::stable_sort(line.begin(), line.end(), [](const Waiting& a, const Waiting& b) { return a.x < b.x; });
  std::array<double, sections> last{};
  last.fill(-std::numeric_limits<double>::infinity());
  double spacing = std::numeric_limits<double>::infinity();
  for (const Waiting& w : line) {
    double& before = last[static_cast<std::size_t>(w.section)];
    if (w.x - before > rounding) spacing = std::min(spacing, w.x - before);
    before = w.x;
  }
  unsigned taken = 0;
  double begin = 0.0;
  for (const Waiting& w : line) {
    const unsigned bit = 1U << static_cast<unsigned>(w.section);
    if (taken != 0 && ((taken & bit) != 0 || w.x - begin > reach * spacing)) {
      ++slot;
      taken = 0;
    }
    if (taken == 0) begin = w.x;
    taken |= bit;
    assign(w.unknown, slot);
  }
  return line.empty() ? slot : slot + 1;
}

class Division {
 public:
  Division(const Sparse& matrix, const UnknownPlaces& places, const DofRange& range, const Cuts& cuts)
      : matrix_(matrix), places_(places), cuts_(cuts) {
    layout_.range = range;
    section_.resize(static_cast<std::size_t>(range.count));
    for (Eigen::Index i = 0; i < range.count; ++i) {
      section_[static_cast<std::size_t>(i)] = cuts.section(places.x[static_cast<std::size_t>(range.begin + i)]);
    }
  }

  std::optional<SectionLayout> make(const MirrorPairs& pairs) {
    if (!find_interfaces()) return std::nullopt;
    number_slots();
    constexpr double most_padding = 1.5;  // slots of all sections over unknowns
    const auto unknowns = static_cast<double>(layout_.range.count);
    if (static_cast<double>(layout_.border_begin()) > most_padding * unknowns) return std::nullopt;
    if (!pair_slots(pairs)) return std::nullopt;
    return std::move(layout_);
  }

 private:
  [[nodiscard]] int section(Eigen::Index unknown) const {
    return section_[static_cast<std::size_t>(unknown - layout_.range.begin)];
  }
  SectionLayout::Place& place(Eigen::Index unknown) {
    return layout_.place[static_cast<std::size_t>(unknown - layout_.range.begin)];
  }

  // Those that act upon an unknown of the section before.
  bool find_interfaces() {
    layout_.place.assign(section_.size(), {0, -1});
    bool neighbours = true;
    visit_entries(matrix_, layout_.range, [&](Eigen::Index i, Eigen::Index j, double) {
      if (section(i) >= section(j)) return;
      neighbours = neighbours && section(i) == section(j) - 1;
      place(j).section = -1;
    });
    if (!neighbours) return false;
    for (Eigen::Index i = 0; i < layout_.range.count; ++i) {
      SectionLayout::Place& p = layout_.place[static_cast<std::size_t>(i)];
      if (p.section == 0) {
        p.section = section_[static_cast<std::size_t>(i)];
      } else {
        p.number = static_cast<int>(layout_.interfaces.size());
        layout_.interfaces.push_back(
            {section_[static_cast<std::size_t>(i)], {-1, -1}, static_cast<int>(layout_.range.begin + i)});
      }
    }
    // An interface unknown acts upon the sections on both sides of its cut and on no other.
    visit_entries(matrix_, layout_.range, [&](Eigen::Index i, Eigen::Index j, double) {
      if (place(i).section >= 0 || place(j).section < 0) return;
      const int cut = section(i), beside = place(j).section;
      neighbours = neighbours && (beside == cut || beside == cut - 1);
    });
    return neighbours;
  }

  void number_slots() {
    enum Role { inside, at_end, at_begin };
    std::map<std::pair<Role, int>, std::vector<Waiting>> lines;
    for (Eigen::Index i = layout_.range.begin; i < layout_.range.end(); ++i) {
      const auto u = static_cast<std::size_t>(i);
      const int line = places_.line[u], in = section(i);
      const double x = places_.x[u] - cuts_.x[static_cast<std::size_t>(in)];
      if (place(i).section >= 0) {
        lines[{inside, line}].push_back({x, in, i});
      } else {
        lines[{at_begin, line}].push_back({x, in, i});
        lines[{at_end, line}].push_back({x, in - 1, i});
      }
    }
    for (auto& [key, line] : lines) {
      const Role role = key.first;
      int& count = role == inside ? layout_.slots : layout_.borders;
      count = share_slots(line, count, [&](Eigen::Index unknown, int slot) {
        if (role == inside) {
          place(unknown).number = slot;
        } else {
          layout_.interfaces[static_cast<std::size_t>(place(unknown).number)].slot[role == at_begin ? 1 : 0] = slot;
        }
      });
    }
    number_along_x();
    layout_.border_of.assign(static_cast<std::size_t>(sections * layout_.borders), -1);
    for (std::size_t k = 0; k < layout_.interfaces.size(); ++k) {
      const SectionLayout::Interface& f = layout_.interfaces[k];
      layout_.border_of[static_cast<std::size_t>(sections * f.slot[0] + f.cut - 1)] = static_cast<int>(k);
      layout_.border_of[static_cast<std::size_t>(sections * f.slot[1] + f.cut)] = static_cast<int>(k);
    }
  }

  // Neighbours of a section stand beside each other in the layout as they do in the unknowns' own order.
  void number_along_x() {
    std::vector<std::pair<double, Eigen::Index>> first(static_cast<std::size_t>(layout_.slots),
                                                       {std::numeric_limits<double>::infinity(), 0});
    const DofRange& range = layout_.range;
    for (Eigen::Index i = range.begin; i < range.end(); ++i) {
      if (place(i).section < 0) continue;
      auto& [x, unknown] = first[static_cast<std::size_t>(place(i).number)];
      if (x < std::numeric_limits<double>::infinity()) continue;
      x = places_.x[static_cast<std::size_t>(i)] - cuts_.x[static_cast<std::size_t>(place(i).section)];
      unknown = i;
    }
    std::vector<int> order(first.size()), number(first.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int a, int b) {
      const auto& [x, u] = first[static_cast<std::size_t>(a)];
      const auto& [y, v] = first[static_cast<std::size_t>(b)];
      return std::abs(x - y) > rounding ? x < y : u < v;
    });
    for (std::size_t k = 0; k < order.size(); ++k) number[static_cast<std::size_t>(order[k])] = static_cast<int>(k);
    for (SectionLayout::Place& p : layout_.place) {
      if (p.section >= 0) p.number = number[static_cast<std::size_t>(p.number)];
    }
  }

  void find_consecutive() {
    layout_.consecutive.assign(static_cast<std::size_t>(layout_.slots / 4 * sections), -1);
    for (std::size_t c = 0; c < layout_.consecutive.size(); ++c) {
      const int* const column = &layout_.unknown[SectionLayout::column_begin(c)];
      bool is_run = column[0] >= 0;
      for (int k = 1; k < 4; ++k) is_run = is_run && column[sections * k] == column[0] + k;
      if (is_run) {
        layout_.consecutive[c] = column[0];
        continue;
      }
      for (int k = 0; k < 4; ++k) append_single(SectionLayout::column_begin(c) + index(sections * k));
    }
    for (std::size_t entry = 4 * layout_.consecutive.size(); entry < layout_.unknown.size(); ++entry) {
      append_single(entry);
    }
  }

  void append_single(std::size_t entry) {
    const int u = layout_.unknown[entry];
    if (u >= 0) layout_.single.push_back({static_cast<int>(entry), u});
  }

  void append_interfaces() {
    const auto first = static_cast<int>(layout_.interface_begin());
    for (int k = 0; k < static_cast<int>(layout_.interfaces.size()); ++k) {
      const int u = layout_.interfaces[index(k)].unknown;
      const int other = mirrored_[index(u - static_cast<int>(layout_.range.begin))];
      layout_.single.push_back({first + k, u});
      if (u < other) layout_.interface_pair.push_back({first + k, static_cast<int>(layout_.position(other))});
    }
  }

  void set_standing() {
    const auto position = [&](int u) { return static_cast<int>(layout_.position(u)); };
    for (int i = 0; i < static_cast<int>(layout_.range.count); ++i) {
      const int u = static_cast<int>(layout_.range.begin) + i, other = mirrored_[index(i)];
      if (other < 0) {
        layout_.standing.push_back({position(u), -1, -1});
      } else {
        layout_.standing.push_back({position(std::min(u, other)), position(std::max(u, other)), other});
      }
    }
  }

  // False where pairs stand in slots that differ from section to section.
  bool pair_slots(const MirrorPairs& pairs) {
    mirrored_.assign(section_.size(), -1);
    layout_.partner.assign(static_cast<std::size_t>(layout_.slots), {});
    for (const auto& [u, v] : pairs) {
      if (u < layout_.range.begin || v >= layout_.range.end()) continue;
      mirrored_[static_cast<std::size_t>(u - layout_.range.begin)] = v;
      mirrored_[static_cast<std::size_t>(v - layout_.range.begin)] = u;
      const SectionLayout::Place &p = place(u), &q = place(v);
      if (p.section != q.section) return false;
      if (p.section < 0) continue;
      const SectionLayout::Partner of_first{q.number, false}, of_second{p.number, true};
      for (const auto& [slot, partner] : {std::pair{p.number, of_first}, std::pair{q.number, of_second}}) {
        SectionLayout::Partner& known = layout_.partner[static_cast<std::size_t>(slot)];
        if (known.slot >= 0 && known != partner) return false;
        known = partner;
      }
    }
    layout_.unknown.assign(static_cast<std::size_t>(layout_.border_begin()), -1);
    for (Eigen::Index i = layout_.range.begin; i < layout_.range.end(); ++i) {
      const SectionLayout::Place& p = place(i);
      if (p.section < 0) continue;
      const int paired = layout_.partner[static_cast<std::size_t>(p.number)].slot;
      if ((paired >= 0) != (mirrored_[static_cast<std::size_t>(i - layout_.range.begin)] >= 0)) return false;
      layout_.unknown[static_cast<std::size_t>(sections * p.number + p.section)] = static_cast<int>(i);
    }
    find_consecutive();
    append_interfaces();
    set_standing();
    return true;
  }

  const Sparse& matrix_;
  const UnknownPlaces& places_;
  const Cuts& cuts_;
  SectionLayout layout_;
  std::vector<int> section_;   // of the unknowns in the range
  std::vector<int> mirrored_;  ///< of the unknowns in the range the other one of the pair; -1: none
};

}  // namespace

Sparse by_sums_and_differences(const Sparse& matrix, const MirrorPairs& pairs) {
  constexpr double nothing = 1e-14;  // of the entries that it comes from
  std::vector<int> other(static_cast<std::size_t>(matrix.rows()), -1);
  for (const auto& [u, v] : pairs) {
    other[static_cast<std::size_t>(u)] = v;
    other[static_cast<std::size_t>(v)] = u;
  }
  // One column after the other, of a pair the sum or the difference of both; then its rows likewise.
  std::vector<double> sum(other.size(), 0.0), size(other.size(), 0.0);
  std::vector<int> touched;
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(matrix.nonZeros()));
  const auto add = [&](int column, double weight) {
    for (Sparse::InnerIterator entry(matrix, column); entry; ++entry) {
      const auto row = static_cast<std::size_t>(entry.row());
      if (size[row] == 0.0) touched.push_back(static_cast<int>(row));
      sum[row] += weight * entry.value();
      size[row] += std::abs(weight * entry.value());
    }
  };
  const auto keep = [&](int row, int column, double value, double of) {
    if (std::abs(value) > nothing * of) entries.emplace_back(row, column, value);
  };
  for (int j = 0; j < matrix.outerSize(); ++j) {
    const int twin = other[static_cast<std::size_t>(j)];
    if (twin < 0) {
      add(j, 1.0);
    } else {
      add(std::min(j, twin), root_half);
      add(std::max(j, twin), j < twin ? root_half : -root_half);
    }
    for (const int i : touched) {
      const auto row = static_cast<std::size_t>(i);
      const int pair = other[row];
      if (pair < 0) {
        keep(i, j, sum[row], size[row]);
      } else if (const auto last = static_cast<std::size_t>(pair); i < pair || size[last] == 0.0) {
        const auto [u, v] = std::minmax(row, last);
        const double of = root_half * (size[u] + size[v]);
        keep(static_cast<int>(u), j, root_half * (sum[u] + sum[v]), of);
        keep(static_cast<int>(v), j, root_half * (sum[u] - sum[v]), of);
      }
    }
    for (const int i : touched) sum[static_cast<std::size_t>(i)] = size[static_cast<std::size_t>(i)] = 0.0;
    touched.clear();
  }
  Sparse result(matrix.rows(), matrix.cols());
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

void SectionLayout::into(const Eigen::VectorXd& natural, Eigen::VectorXd& ordered) const {
  double* const to = ordered.data();
  for (std::size_t c = 0; c < consecutive.size(); c += 4) {  // four slots of four sections
    Pack of_section[4] = {}, of_slot[4];
    for (std::size_t s = 0; s < 4; ++s) {
      if (consecutive[c + s] < 0) continue;
      std::memcpy(&of_section[s], natural.data() + consecutive[c + s], sizeof of_section[s]);
    }
    transpose(of_section[0], of_section[1], of_section[2], of_section[3], of_slot);
    for (std::size_t row = 0; row < 4; ++row) {
      std::memcpy(to + column_begin(c) + sections * row, &of_slot[row], sizeof of_slot[row]);
    }
  }
  std::fill(to + 4 * consecutive.size(), to + unknown.size(), 0.0);
  for (const Single& of : single) to[of.entry] = natural[of.unknown];
  Lanes* const slot = lanes(ordered);
  for (std::size_t first = 0; first < partner.size(); ++first) {
    const auto& [second, is_second] = partner[first];
    if (second < 0 || is_second) continue;
    const Lanes u = slot[first], v = slot[second];
    slot[first] = root_half * (u + v);
    slot[second] = root_half * (u - v);
  }
  for (const auto& [first, second] : interface_pair) {
    const double u = to[first], v = to[second];
    to[first] = root_half * (u + v);
    to[second] = root_half * (u - v);
  }
}

void SectionLayout::out_of(const Eigen::VectorXd& ordered, Eigen::VectorXd& natural) const {
  double* const to = natural.data();
  const Lanes* const slot = lanes(ordered);
  // what stands in a slot, in the place of the sum or the difference
  const auto own = [&](std::size_t k) {
    const auto& [other, is_second] = partner[k];
    if (other < 0) return slot[k];
    return is_second ? root_half * (slot[other] - slot[k]) : root_half * (slot[k] + slot[other]);
  };
  Lanes slots_of_column[4];
  for (std::size_t c = 0; c < consecutive.size(); c += 4) {  // four slots of four sections
    const std::size_t first = column_begin(c), section = first % sections;
    if (section == 0) {
      for (std::size_t k = 0; k < 4; ++k) slots_of_column[k] = own(first / sections + k);
    }
    Pack of_slot[4], of_section[4];
    for (std::size_t k = 0; k < 4; ++k) {
      std::memcpy(&of_slot[k], reinterpret_cast<const double*>(&slots_of_column[k]) + section,  // NOLINT
                  sizeof of_slot[k]);
    }
    transpose(of_slot[0], of_slot[1], of_slot[2], of_slot[3], of_section);
    for (std::size_t s = 0; s < 4; ++s) {
      if (consecutive[c + s] >= 0) std::memcpy(to + consecutive[c + s], &of_section[s], sizeof of_section[s]);
    }
  }
  for (const Single& of : single) to[of.unknown] = value(ordered, of.unknown);
}

void SectionLayout::set(int u, double value, Eigen::VectorXd& ordered) const noexcept {
  const auto [sum, difference, other] = standing[static_cast<std::size_t>(u - range.begin)];
  if (other < 0) {
    ordered[sum] = value;
    return;
  }
  const double of_other = this->value(ordered, other);
  ordered[sum] = root_half * (value + of_other);
  ordered[difference] = root_half * (u < other ? value - of_other : of_other - value);
}

void SectionLayout::spread_interfaces(Eigen::VectorXd& ordered) const {
  const double* const from = ordered.data() + interface_begin();
  double* const to = ordered.data() + border_begin();
  for (std::size_t b = 0; b < border_of.size(); ++b) to[b] = border_of[b] < 0 ? 0.0 : from[border_of[b]];
}

void SectionLayout::fold_borders(Eigen::VectorXd& ordered) const {
  const double* const from = ordered.data() + border_begin();
  double* const to = ordered.data() + interface_begin();
  for (std::size_t b = 0; b < border_of.size(); ++b) {
    if (border_of[b] >= 0) to[border_of[b]] += from[b];
  }
}

SectionLayout::Entries SectionLayout::entries(std::initializer_list<const Sparse*> matrices) const {
  struct OfColumn {
    int column;
    Entries::OfSection entry;
  };
  std::vector<OfColumn> found;
  Entries result;
  result.begin.assign(index(slots + 1), 0);
  int number = 0;
  for (const Sparse* matrix : matrices) {
    visit_entries(*matrix, range, [&](Eigen::Index i, Eigen::Index j, double value) {
      if (i < j) return;
      const Place& p = place[static_cast<std::size_t>(i - range.begin)];
      const Place& q = place[static_cast<std::size_t>(j - range.begin)];
      const int section = std::max(p.section, q.section);
      if (section < 0) {
        const auto [column, row] = std::minmax(p.number, q.number);
        result.interfaces.push_back({row, column, number, value});
        return;
      }
      const auto slot = [&](const Place& at) {
        if (at.section >= 0) return at.number;
        const Interface& f = interfaces[index(at.number)];
        return slots + f.slot[f.cut == section ? 1 : 0];
      };
      const auto [column, row] = std::minmax({slot(p), slot(q)});
      found.push_back({column, {row, section, number, value}});
      ++result.begin[index(column + 1)];
    });
    ++number;
  }
  std::partial_sum(result.begin.begin(), result.begin.end(), result.begin.begin());
  result.section.resize(found.size());
  std::vector<int> next(result.begin.begin(), result.begin.end() - 1);
  for (const OfColumn& of : found) result.section[index(next[index(of.column)]++)] = of.entry;
  for (std::size_t j = 0; j + 1 < result.begin.size(); ++j) {
    std::stable_sort(result.section.begin() + result.begin[j], result.section.begin() + result.begin[j + 1],
                     [](const Entries::OfSection& a, const Entries::OfSection& b) { return a.row < b.row; });
  }
  return result;
}

std::size_t SectionLayout::bytes() const noexcept {
  const auto of = [](const auto& list) { return list.size() * sizeof(list[0]); };
  return of(place) + of(interfaces) + of(border_of) + of(standing) + of(unknown) + of(partner) + of(consecutive) +
         of(single) + of(interface_pair);
}

std::optional<SectionLayout> divide(const Sparse& matrix, const UnknownPlaces& places, const MirrorPairs& pairs,
                                    const DofRange& range) {
  if (places.x.empty() || range.count == 0) return std::nullopt;
  const auto line = places.line.begin() + range.begin;
  if (std::find(line, line + range.count, -1) != line + range.count) return std::nullopt;
  const double from = places.x[static_cast<std::size_t>(range.begin)];
  const double to = places.x[static_cast<std::size_t>(range.end() - 1)];
  const std::optional<Cuts> cuts = best_cuts(lines_of(places, range), from, to);
  if (!cuts) return std::nullopt;
  return Division(matrix, places, range, *cuts).make(pairs);
}

}  // namespace railtab
