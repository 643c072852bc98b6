#include "railtab/tables/loaded_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/lane_transpose.hpp"
#include "railtab/runtime/base/pack.hpp"
#include "railtab/runtime/base/smooth_step.hpp"
#include "railtab/tables/hermite_basis.hpp"

namespace railtab {

namespace {

void require_increasing(const std::string& place, const std::vector<double>& nodes, std::size_t least,
                        std::size_t most) {
  const bool increasing = std::adjacent_find(nodes.begin(), nodes.end(), std::greater_equal<>()) == nodes.end();
  if (nodes.size() < least || nodes.size() > most || !increasing) {
    throw input_error(place, fmt::format("{} nodes", nodes.size()),
                      fmt::format("{} to {} increasing nodes", least, most));
  }
}

void require_size(const std::string& place, std::size_t found, std::size_t expected) {
  if (found == expected) return;
  throw input_error(place, fmt::format("{} numbers", found), fmt::format("{}", expected));
}

// The polynomials of Lagrange with value 1 at one node, with two derivatives.
template <class V>
struct Lagrange {
  std::array<V, LoadedTable::most_yaws> value, first, second;

  /// @param inverse 1/(node i − node j), j fastest
  Lagrange(const std::vector<double>& node, const std::vector<double>& inverse, const V& x) noexcept {
    for (std::size_t i = 0; i < node.size(); ++i) {
      V p = broadcast<V>(1.0), dp{}, ddp{};
      for (std::size_t j = 0; j < node.size(); ++j) {
        if (j == i) continue;
        const double slope = inverse[i * node.size() + j];
        const V factor = (x - node[j]) * slope;
        ddp = ddp * factor + (2.0 * slope) * dp;
        dp = dp * factor + slope * p;
        p = p * factor;
      }
      value[i] = p;
      first[i] = dp;
      second[i] = ddp;
    }
  }
};

std::vector<double> inverse_distances(const std::vector<double>& node) {
  std::vector<double> inverse;
  for (const double a : node)
    for (const double b : node) inverse.push_back(a == b ? 0.0 : 1.0 / (a - b));
  return inverse;
}

constexpr std::size_t buckets = 2048;

// Derivatives along roll and yaw.
enum Direction : std::size_t { here, by_roll, by_yaw, by_roll_roll, by_roll_yaw, by_yaw_yaw, directions };

}  // namespace

namespace {

// The derivative at a node of the parabola through it and the nodes beside it, as weights of the nodes from `first` on.
Pack parabola_slope(const std::vector<double>& node, std::size_t at, std::size_t first) {
  const std::size_t points = std::min<std::size_t>(3, node.size());
  const std::size_t from = std::min(at > 0 ? at - 1 : 0, node.size() - points), to = from + points - 1;
  Pack weight{};
  for (std::size_t k = from; k <= to; ++k) {
    for (std::size_t m = from; m <= to; ++m) {
      if (m == k) continue;
      double product = 1.0 / (node[k] - node[m]);
      for (std::size_t j = from; j <= to; ++j)
        if (j != k && j != m) product *= (node[at] - node[j]) / (node[k] - node[j]);
      weight[k - first] += product;
    }
  }
  return weight;
}

}  // namespace

LoadedTable::RollCubic::RollCubic(const std::vector<double>& node, std::size_t low) noexcept
    : first(std::min(low > 0 ? low - 1 : 0, node.size() - std::min(rolls_read, node.size()))),
      begin(node[low]),
      inverse(1.0 / (node[low + 1] - node[low])) {
  const double width = node[low + 1] - begin;
  Pack below{}, above{};
  below[low - first] = above[low + 1 - first] = 1.0;
  const Pack slope_below = width * parabola_slope(node, low, first);
  const Pack slope_above = width * parabola_slope(node, low + 1, first);
  const std::array<Pack, 4> coefficients{below, slope_below, 3.0 * (above - below) - 2.0 * slope_below - slope_above,
                                         2.0 * (below - above) + slope_below + slope_above};
  std::memcpy(power.data(), coefficients.data(), sizeof power);
}

/// Weights of the nodes of roll and of yaw² that are read: in the value, and in the first and second derivatives with
/// respect to roll and yaw. The weight of a column is a product of both.
template <class V>
struct LoadedTable::Weights {
  enum Order : std::size_t { value, first, second, orders };

  std::size_t rolls, yaws;                          ///< that are read
  std::array<std::size_t, lanes_of<V>> first_roll;  ///< of the nodes, by place
  std::array<std::array<V, rolls_read>, orders> roll;
  std::array<std::array<V, most_yaws>, orders> yaw;

  Weights(const LoadedTable& table, const V& at_roll, const V& at_yaw) noexcept
      : rolls(std::min(rolls_read, table.data_.roll.size())), yaws(table.data_.yaw_squared.size()) {
    const LoadedTableData& data = table.data_;
    for (int i = 0; i < lanes_of<V>; ++i) {
      const double x = lane(at_roll, i);
      const auto above = std::upper_bound(data.roll.begin() + 1, data.roll.end() - 1, x);
      const RollCubic& cubic = table.roll_cubic_[static_cast<std::size_t>(above - data.roll.begin()) - 1];
      first_roll[static_cast<std::size_t>(i)] = cubic.first;
      const double t = (x - cubic.begin) * cubic.inverse;
      std::array<Pack, 4> p;
      std::memcpy(p.data(), cubic.power.data(), sizeof p);
      const Pack weight[orders]{p[0] + t * (p[1] + t * (p[2] + t * p[3])),
                                cubic.inverse * (p[1] + t * (2.0 * p[2] + (3.0 * t) * p[3])),
                                cubic.inverse * cubic.inverse * (2.0 * p[2] + (6.0 * t) * p[3])};
      for (std::size_t order = 0; order < orders; ++order)
        for (std::size_t k = 0; k < rolls_read; ++k) lane(roll[order][k], i) = weight[order][k];
    }
    const Lagrange<V> s(data.yaw_squared, table.inverse_yaw_, at_yaw * at_yaw);
    for (std::size_t j = 0; j < yaws; ++j) {
      yaw[value][j] = s.value[j];
      yaw[first][j] = 2.0 * at_yaw * s.first[j];
      yaw[second][j] = 2.0 * s.first[j] + 4.0 * at_yaw * at_yaw * s.second[j];
    }
  }
};

/// Sums over the nodes of roll and yaw² of one pose, in the directions that are wanted.
template <bool slopes>
struct LoadedTable::NodeSums {
  static constexpr std::size_t wanted = slopes ? directions : by_yaw + 1, orders = slopes ? 3 : 2;
  static constexpr std::size_t most_pairs = (most_yaws + 1) / 2;
  template <class Numbers>
  using Sums = std::array<Numbers, wanted>;

  std::size_t first, rolls, yaws;  ///< columns that are read
  double roll[orders][rolls_read], yaw[orders][most_yaws];
  Lanes yaw_pair[orders][most_pairs];  ///< weights of two neighbouring nodes, each four times; 0: there is no second

  template <class V>
  void set(const Weights<V>& weights, int place) noexcept {
    rolls = weights.rolls;
    yaws = weights.yaws;
    first = weights.first_roll[static_cast<std::size_t>(place)] * yaws;
    for (std::size_t order = 0; order < orders; ++order) {
      for (std::size_t i = 0; i < rolls; ++i) roll[order][i] = lane(weights.roll[order][i], place);
      for (std::size_t j = 0; j < yaws; ++j) yaw[order][j] = lane(weights.yaw[order][j], place);
      for (std::size_t p = 0; 2 * p < yaws; ++p) {
        const double next = 2 * p + 1 < yaws ? yaw[order][2 * p + 1] : 0.0;
        for (int q = 0; q < 4; ++q) {
          yaw_pair[order][p][q] = yaw[order][2 * p];
          yaw_pair[order][p][4 + q] = next;
        }
      }
    }
  }

  /// Of eight numbers per column. @param numbers of the first column
  void of_eight(const double* numbers, Sums<Lanes>& sum) const noexcept {
    sum = {};
    with_counts([&](auto rolls_here, auto yaws_here) {
      for (std::size_t i = 0; i < rolls_here; ++i) {
        Lanes over_yaw[orders]{};
        for (std::size_t j = 0; j < yaws_here; ++j, numbers += Lanes::count) {
          Lanes stored;
          std::memcpy(&stored, numbers, sizeof stored);
          for (std::size_t order = 0; order < orders; ++order) over_yaw[order] += yaw[order][j] * stored;
        }
        add_over_roll(i, over_yaw, sum);
      }
    });
  }

  /// Of four numbers per column, two columns at a time. @param numbers of the first column
  void of_four(const float* numbers, Sums<Pack>& sum) const noexcept {
    Sums<Lanes> pair{};
    with_counts([&](auto rolls_here, auto yaws_here) {
      for (std::size_t i = 0; i < rolls_here; ++i, numbers += 4 * yaws_here) {
        Lanes over_yaw[orders]{};
        for (std::size_t p = 0; 2 * p < yaws_here; ++p) {
          Lanes stored{};
          if (2 * p + 1 < yaws_here) {
            widen(numbers + 8 * p, stored);
          } else {
            Pack last;
            widen(numbers + 8 * p, last);
            std::memcpy(&stored, &last, sizeof last);
          }
          for (std::size_t order = 0; order < orders; ++order) over_yaw[order] += yaw_pair[order][p] * stored;
        }
        add_over_roll(i, over_yaw, pair);
      }
    });
    for (std::size_t d = 0; d < wanted; ++d) {
      Pack half[2];
      std::memcpy(half, &pair[d], sizeof half);
      sum[d] = half[0] + half[1];
    }
  }

 private:
  /// Calls sum(rolls, yaws), with constants where they are those of ordinary tables: loops over them are unrolled.
  void with_counts(auto&& sum) const noexcept {
    constexpr std::size_t usual_yaws = 4;
    if (rolls == rolls_read && yaws == usual_yaws) {
      sum(std::integral_constant<std::size_t, rolls_read>{}, std::integral_constant<std::size_t, usual_yaws>{});
    } else {
      sum(rolls, yaws);
    }
  }
  void add_over_roll(std::size_t i, const Lanes* over_yaw, Sums<Lanes>& sum) const noexcept {
    sum[here] += roll[0][i] * over_yaw[0];
    sum[by_roll] += roll[1][i] * over_yaw[0];
    sum[by_yaw] += roll[0][i] * over_yaw[1];
    if constexpr (slopes) {
      sum[by_roll_roll] += roll[2][i] * over_yaw[0];
      sum[by_roll_yaw] += roll[1][i] * over_yaw[1];
      sum[by_yaw_yaw] += roll[0][i] * over_yaw[2];
    }
  }
};

double LoadedTableData::certified_force_error() const noexcept {
  const auto found = std::find_if(statistics.begin(), statistics.end(),
                                  [](const auto& s) { return s.first == "certified.error.force.p99"; });
  return found == statistics.end() ? 0.0 : found->second;
}

void require_consistent(const LoadedTableData& table, const std::string& source) {
  constexpr std::size_t many = 100000;
  const auto place = [&](const char* name) { return fmt::format("{}: {}", source, name); };
  require_increasing(place("lateral"), table.lateral, 2, many);
  require_increasing(place("roll"), table.roll, 2, LoadedTable::most_rolls);
  require_increasing(place("yaw_squared"), table.yaw_squared, 1, LoadedTable::most_yaws);
  if (table.levels < 3 || table.levels > 10000 || !(table.largest_level > 0.0)) {
    throw input_error(place("levels"), fmt::format("{} up to {}", table.levels, table.largest_level),
                      "3..10000, up to more than 0");
  }
  if (!(table.climb >= 0.0 && table.climb <= largest_climb)) {
    throw input_error(place("climb"), fmt::format("{}", table.climb), fmt::format("0..{} rad/m", largest_climb));
  }
  if (table.parts() > LoadedLookup::capacity) {
    throw input_error(place("cut"), fmt::format("{}", table.cut.size()),
                      fmt::format("at most {}", LoadedLookup::capacity - 1));
  }
  const std::size_t columns = table.columns(), nodes = table.lateral.size() * static_cast<std::size_t>(table.levels);
  require_size(place("shift"), table.shift.size(), 2 * table.lateral.size() * columns);
  require_size(place("touch"), table.touch.size(), table.lateral.size() * columns);
  require_size(place("height"), table.height.size(), 4 * nodes * columns);
  require_size(place("pressed"), table.pressed.size(), nodes);
  std::size_t part_size = 0;
  for (const std::uint32_t pressed : table.pressed) {
    if (pressed >> table.parts() != 0) {
      throw input_error(place("pressed"), fmt::format("{}", pressed), fmt::format("bits of {} parts", table.parts()));
    }
    part_size += static_cast<std::size_t>(std::popcount(pressed)) * columns * LoadedPart::quantities;
  }
  require_size(place("part"), table.part.size(), part_size);
}

LoadedTable::LoadedTable(LoadedTableData data) : data_(std::move(data)) {
  require_consistent(data_, "loaded table");
  const std::size_t columns = data_.columns(), nodes = data_.pressed.size();
  std::size_t part_size = 0;
  for (const std::uint32_t pressed : data_.pressed) {
    part_at_.push_back(part_size);
    part_size += static_cast<std::size_t>(std::popcount(pressed)) * columns * LoadedPart::quantities;
  }
  for (std::size_t i = 0; i + 1 < data_.roll.size(); ++i) roll_cubic_.emplace_back(data_.roll, i);
  inverse_yaw_ = inverse_distances(data_.yaw_squared);
  level_step_ = data_.largest_level / (data_.levels - 1);
  for (std::size_t i = 0, node = 0; i < buckets; ++i) {
    const double y0 = data_.lateral.front() + (data_.lateral.back() - data_.lateral.front()) * static_cast<double>(i) /
                                                  static_cast<double>(buckets);
    while (node + 2 < data_.lateral.size() && data_.lateral[node + 1] <= y0) ++node;
    bucket_.push_back(static_cast<std::uint32_t>(node));
  }
  for (std::size_t cell = 0; cell + 1 < data_.lateral.size(); ++cell) {
    for (std::size_t c = cell * columns; c < (cell + 1) * columns; ++c) {
      const double* const low = &data_.shift[2 * c];
      const double* const high = low + 2 * columns;
      ends_.insert(ends_.end(), {low[0], low[1], high[0], high[1], data_.touch[c], data_.touch[c + columns], 0.0, 0.0});
    }
  }
  for (std::size_t i = 0; i < data_.lateral.size() * columns; i += data_.yaw_squared.size()) {
    displaced_.push_back(data_.shift[2 * i] - data_.lateral[i / columns]);
  }
  const std::size_t middle = data_.roll.size() / 2 * data_.yaw_squared.size();
  for (std::size_t i = 0; i < nodes; ++i) rise_.push_back(data_.height[4 * (i * columns + middle)]);
  const auto levels = static_cast<std::size_t>(data_.levels);
  for (std::size_t last = levels - 1; last < nodes; last += levels) {
    if (rise_[last] > 0.0F) continue;
    throw input_error(fmt::format("loaded table: height, lateral node {}", last / levels),
                      fmt::format("{} m at the last level", rise_[last]), "above first touch");
  }
  weight_parts();
}

std::size_t LoadedTable::bytes() const noexcept {
  return sizeof(double) * (ends_.size() + displaced_.size() + data_.lateral.size()) +
         sizeof(RollCubic) * roll_cubic_.size() + sizeof(std::uint32_t) * bucket_.size() +
         sizeof(float) * (data_.height.size() + data_.pressed.size() + weighted_part_.size() + rise_.size()) +
         sizeof(std::size_t) * part_at_.size();
}

template <bool slopes>
std::size_t LoadedTable::guess_cell(double y, const NodeSums<slopes>& sums) const noexcept {
  const double first = data_.lateral.front(), range = data_.lateral.back() - first;
  const auto cell_of = [&](double y0) {
    const double at = std::clamp((y0 - first) / range, 0.0, 1.0) * static_cast<double>(buckets);
    return static_cast<std::size_t>(bucket_[std::min(static_cast<std::size_t>(at), buckets - 1)]);
  };
  // The displacement changes little along y0 and with yaw: from the cell at y to that at y less its displacement at the
  // first node of yaw.
  const double* const displaced = &displaced_[cell_of(y) * data_.roll.size() + sums.first / sums.yaws];
  double by = 0.0;
  for (std::size_t i = 0; i < sums.rolls; ++i) by += sums.roll[0][i] * displaced[i];
  return cell_of(y - by);
}

template <bool slopes>
bool LoadedTable::find_cell(double y, const NodeSums<slopes>& sums, std::size_t& cell,
                            CellEnds<slopes>& ends) const noexcept {
  const std::size_t last = data_.lateral.size() - 2;
  const auto low = [&] { return ends[here][0]; };
  const auto high = [&] { return ends[here][2]; };
  sums.of_eight(ends_of(cell, sums.first), ends);
  while (cell > 0 && low() > y) sums.of_eight(ends_of(--cell, sums.first), ends);
  while (cell < last && high() <= y) sums.of_eight(ends_of(++cell, sums.first), ends);
  return y >= low() && y <= high();
}

int LoadedTable::guess_level(double above, std::size_t node, double t) const noexcept {
  const std::size_t levels = static_cast<std::size_t>(data_.levels);
  if (!(above > 0.0)) return 0;
  // By the rise of the middle column.
  const float *const rise_low = &rise_[node * levels], *const rise_high = rise_low + levels;
  const auto rise = [&](int level) {
    const auto k = static_cast<std::size_t>(level);
    return (1.0 - t) * static_cast<double>(rise_low[k]) + t * static_cast<double>(rise_high[k]);
  };
  const double share = std::sqrt(above / rise(data_.levels - 1));
  int level = std::clamp(static_cast<int>(std::min(share, 1.0) * (data_.levels - 1)), 0, data_.levels - 2);
  while (level > 0 && rise(level) > above) --level;
  while (level < data_.levels - 2 && rise(level + 1) <= above) ++level;
  return level;
}

/// The corners' values, slopes along w and y0 and mixed derivatives, by Direction: of the lower lateral node at both
/// levels, then of the upper one.
struct LoadedTable::Corners {
  Pack of[4][directions];

  /// Along w, of one direction's corners contracted across: value and slope at the lower level, then at the upper one.
  void across(const std::array<double, 4>& basis, Direction d, Pack& result) const noexcept {
    const Pack below{basis[0], basis[0], basis[1], basis[1]}, above{basis[2], basis[2], basis[3], basis[3]};
    const Pack low = below * of[0][d] + above * of[2][d], high = below * of[1][d] + above * of[3][d];
    result = __builtin_shufflevector(low, high, 0, 1, 4, 5) + __builtin_shufflevector(low, high, 2, 3, 6, 7);
  }
};

/// The corners in the directions that are wanted.
template <bool slopes>
void LoadedTable::add_corners(std::size_t node, int level, const NodeSums<slopes>& sums, const CellEnds<slopes>& ends,
                              Corners& corners) const noexcept {
  const std::size_t columns = data_.columns(), levels = static_cast<std::size_t>(data_.levels);
  for (std::size_t lateral = 0; lateral < 2; ++lateral) {
    for (std::size_t above = 0; above < 2; ++above) {
      const std::size_t at = (node + lateral) * levels + static_cast<std::size_t>(level) + above;
      typename NodeSums<slopes>::template Sums<Pack> sum;
      sums.of_four(&data_.height[4 * (at * columns + sums.first)], sum);
      for (std::size_t d = 0; d < sum.size(); ++d) {
        sum[d][0] += ends[d][static_cast<int>(4 + lateral)];
        corners.of[2 * lateral + above][d] = sum[d];
      }
    }
  }
}

/// Where a pose lies among the nodes of the parts.
struct LoadedTable::PartPlace {
  /// Linear interpolation between the two nodes around a place: the lower one, the place between them, and its rate.
  struct Linear {
    std::size_t low;
    double part, rate;

    Linear() = default;  // not set: a look-up sets those of the poses in contact before it reads them
    Linear(const std::vector<double>& node, double x) noexcept : low(0), part(0.0), rate(0.0) {
      if (node.size() == 1) return;
      const auto above = std::upper_bound(node.begin() + 1, node.end() - 1, x);
      const auto high = static_cast<std::size_t>(above - node.begin());
      low = high - 1;
      rate = 1.0 / (node[high] - node[low]);
      part = (x - node[low]) * rate;
    }
  };

  std::array<std::size_t, 4> node;  ///< (lateral, level): lower, next lateral, next level, both

  [[nodiscard]] static std::array<std::size_t, 4> nodes(std::size_t lateral, int level, int levels) noexcept {
    const auto count = static_cast<std::size_t>(levels);
    const std::size_t first = lateral * count + static_cast<std::size_t>(level);
    return {first, first + count, first + 1, first + count + 1};
  }
  double t, u, width;  ///< between the lateral nodes, between the levels; of the lateral cell [m]
  Linear r, s;
};

namespace {

// Asks the memory for what will be read soon.
void fetch(const void* from, std::size_t bytes) {
  constexpr std::size_t line = 64;
  for (std::size_t at = 0; at < bytes + line - 1; at += line) __builtin_prefetch(static_cast<const char*>(from) + at);
}

}  // namespace

void LoadedTable::fetch_ends(std::size_t cell, std::size_t first, std::size_t count) const noexcept {
  fetch(ends_of(cell, first), count * sizeof(Lanes));
}

void LoadedTable::fetch_rise(std::size_t node) const noexcept {
  const auto levels = static_cast<std::size_t>(data_.levels);
  fetch(&rise_[node * levels], 2 * levels * sizeof(float));
}

void LoadedTable::fetch_corners(std::size_t node, int level, std::size_t first, std::size_t count) const noexcept {
  const std::size_t columns = data_.columns(), levels = static_cast<std::size_t>(data_.levels);
  for (const std::size_t lateral : {node, node + 1}) {
    const std::size_t at = lateral * levels + static_cast<std::size_t>(level);
    const float* const height = &data_.height[4 * (at * columns + first)];
    fetch(height, 4 * count * sizeof(float));
    fetch(height + 4 * columns, 4 * count * sizeof(float));
  }
}

void LoadedTable::fetch_parts(const PartPlace& place) const noexcept {
  const std::size_t columns = data_.columns(), yaws = data_.yaw_squared.size();
  const PartPlace::Linear &r = place.r, &s = place.s;
  for (const std::size_t corner : place.node) {
    const float* part = weighted_part_.data() + part_at_[corner] + (r.low * yaws + s.low) * LoadedPart::quantities;
    for (std::uint32_t pressed = data_.pressed[corner]; pressed != 0; pressed &= pressed - 1) {
      for (std::size_t i = 0; i < 2; ++i) {
        fetch(part + i * yaws * LoadedPart::quantities, 2 * LoadedPart::quantities * sizeof(float));
      }
      part += columns * LoadedPart::quantities;
    }
  }
}

/// Of one part the share, every other quantity but the pressure weighted with it, and the pressure's square; the sums
/// and their derivatives along the coordinates. The square is nearly linear also where a part begins: there the
/// pressure grows with the cube root of its force, on a strip between others with the square root or faster.
struct LoadedTable::PartSums {
  enum Along : std::size_t { value, by_lateral, by_level, by_roll_node, by_yaw_node, count };
  static constexpr std::size_t packs = LoadedPart::quantities / 4, pressure = LoadedPart::quantities - 1;
  static constexpr std::size_t arm_y = 2, arm_z = 3;
  Pack sum[count][packs];
};

void LoadedTable::weight_parts() {
  std::size_t first = 0;  // that presses
  while (first < data_.part.size() && !(data_.part[first] > 0.0F)) first += LoadedPart::quantities;
  if (first < data_.part.size()) {
    for (const std::size_t q : {PartSums::arm_y, PartSums::arm_z}) reference_[q] = double{data_.part[first + q]};
  }
  for (std::size_t i = 0; i < data_.part.size(); i += LoadedPart::quantities) {
    float* const quantity = &data_.part[i];
    for (std::size_t q = 1; q < PartSums::pressure; ++q) {
      quantity[q] = static_cast<float>(double{quantity[0]} * (double{quantity[q]} - reference_[q]));
    }
    quantity[PartSums::pressure] *= quantity[PartSums::pressure];
  }
  weighted_part_ = std::move(data_.part);
  // Two nodes of yaw² are read also where there is one.
  if (data_.yaw_squared.size() == 1) weighted_part_.resize(weighted_part_.size() + LoadedPart::quantities);
}

template <bool slopes>
bool LoadedTable::sum_part(const PartPlace& place, std::size_t part, PartSums& sums) const noexcept {
  constexpr std::size_t kinds = slopes ? std::size_t{PartSums::by_yaw_node} : 1, lanes = 3;
  const std::size_t columns = data_.columns(), yaws = data_.yaw_squared.size();
  const PartPlace::Linear &r = place.r, &s = place.s;
  const std::array<double, 2> ft{1.0 - place.t, place.t}, fu{1.0 - place.u, place.u}, fr{1.0 - r.part, r.part};
  const std::array<double, 2> t_rate{-1.0 / place.width, 1.0 / place.width},
      u_rate{-1.0 / level_step_, 1.0 / level_step_}, r_rate{-r.rate, r.rate};
  Lanes sum[kinds][lanes]{};  // of the lower node of yaw², then of the upper one
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const std::uint32_t pressed = data_.pressed[place.node[corner]];
    if ((pressed >> part & 1U) == 0) continue;
    const auto before = static_cast<std::size_t>(std::popcount(pressed & ((1U << part) - 1U)));
    const float* stored = &weighted_part_[part_at_[place.node[corner]] +
                                          (before * columns + r.low * yaws + s.low) * LoadedPart::quantities];
    const std::size_t t = corner & 1U, u = corner >> 1U;
    for (std::size_t i = 0; i < 2; ++i, stored += yaws * LoadedPart::quantities) {
      for (std::size_t m = 0; m < lanes; ++m) {
        Lanes values;
        widen(stored + Lanes::count * m, values);
        sum[PartSums::value][m] += (ft[t] * fu[u] * fr[i]) * values;
        if constexpr (slopes) {
          sum[PartSums::by_lateral][m] += (t_rate[t] * fu[u] * fr[i]) * values;
          sum[PartSums::by_level][m] += (ft[t] * u_rate[u] * fr[i]) * values;
          sum[PartSums::by_roll_node][m] += (ft[t] * fu[u] * r_rate[i]) * values;
        }
      }
    }
  }
  for (std::size_t kind = 0; kind < kinds; ++kind) {
    Pack node[2][PartSums::packs];
    std::memcpy(node, sum[kind], sizeof node);
    for (std::size_t q = 0; q < PartSums::packs; ++q) {
      sums.sum[kind][q] = (1.0 - s.part) * node[0][q] + s.part * node[1][q];
      if constexpr (slopes) {
        if (kind == PartSums::value) sums.sum[PartSums::by_yaw_node][q] = s.rate * (node[1][q] - node[0][q]);
      }
    }
  }
  return sums.sum[PartSums::value][0][0] > 0.0;
}

namespace {

double& element(Eigen::Vector4d& of, std::size_t j) { return of[static_cast<Eigen::Index>(j)]; }
template <class V>
V& element(std::array<V, 4>& of, std::size_t j) {
  return of[j];
}
double& element(Eigen::Matrix4d& of, std::size_t i, std::size_t j) {
  return of(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
}
template <class V>
V& element(std::array<std::array<V, 4>, 4>& of, std::size_t i, std::size_t j) {
  return of[i][j];
}

void set_zero(Eigen::Matrix4d& of) { of.setZero(); }
template <class V>
void set_zero(std::array<std::array<V, 4>, 4>& of) {
  of = {};
}

}  // namespace

template <class V>
V LoadedTable::margin_share(const V& roll, const V& yaw) const noexcept {
  const double margin = border * (data_.roll.back() - data_.roll.front());
  const V share = smooth_step(at_most(roll - data_.roll.front(), data_.roll.back() - roll) * (1.0 / margin));
  const double largest = data_.yaw_squared.back();
  const V squared = yaw * yaw;
  if (data_.yaw_squared.size() == 1) return select(squared > broadcast<V>(largest), V{}, share);
  return share * smooth_step((largest - squared) * (1.0 / (border * largest)));
}

/// A look-up in its steps: lateral cell, level, energy and forces, stiffness, parts.
template <bool slopes, class V>
class LoadedTable::LookUp {
 public:
  LookUp(const LoadedTable& table, const LoadedPoseOf<V>& pose, LoadedLookupOf<V>& result,
         LoadedSlopesOf<V>* derivatives) noexcept
      : table_(table),
        data_(table.data_),
        pose_(pose),
        result_(result),
        derivatives_(derivatives),
        weights_(table, pose.roll, pose.yaw) {}

  /// @param inside share of the table by roll and yaw
  void run(const V& inside) noexcept {
    inside_ = inside;
    find_laterals();
    find_levels();
    if (!any(found_ > 0.5)) {
      result_.table_share = inside_;
      return;
    }
    find_energy();
    if (!any(found_ > 0.5)) return;
    if constexpr (slopes) set_stiffness();
    set_parts();
  }

 private:
  static constexpr int places = lanes_of<V>;
  static constexpr double root = 1e-8;  ///< of rounding: Newton's next correction is less than its square
  using Four = std::array<V, 4>;

  /// What the corners leave at the places across: along w the height of the wheelset and its derivatives, value and
  /// slope at the lower level, then at the upper one.
  enum Line : std::size_t {
    height,
    over_y0,
    over_roll,
    over_yaw,
    over_y0_y0,
    over_roll_roll,
    over_roll_yaw,
    over_yaw_yaw,
    over_y0_roll,
    over_y0_yaw,
    lines
  };
  static constexpr std::size_t lines_used = slopes ? lines : over_yaw + 1;

  static void each(auto&& visit) {
    for (int i = 0; i < places; ++i) visit(i, static_cast<std::size_t>(i));
  }
  static V sum(const Four& basis, const Four& of) { return HermiteBasisOf<V>::sum(basis, of); }
  static std::array<double, 4> at(const Four& of, int i) {
    return {lane(of[0], i), lane(of[1], i), lane(of[2], i), lane(of[3], i)};
  }
  /// Four numbers of every pose.
  using OfPoses = std::array<Pack, places>;
  /// y and its derivatives, and z, at the places found.
  [[nodiscard]] V Y(const Four& basis, Direction d) const { return sum(basis, y_[d]); }
  [[nodiscard]] V Z(const Four& basis, std::size_t line) const { return sum(basis, z_[line]); }

  // The lateral node below, and the place t between it and the next: y(y0) is nearly linear.
  void find_laterals() {
    const V zero{}, one = broadcast<V>(1.0);
    OfPoses ends;
    ends.fill(Pack{0.0, 1.0, 1.0, 1.0});
    V from{};
    width_ = one;
    each([&](int i, std::size_t k) {
      if (!(lane(inside_, i) > 0.0)) return;
      sums_[k].set(weights_, i);
      lateral_[k] = table_.guess_cell(lane(pose_.y, i), sums_[k]);
      table_.fetch_ends(lateral_[k], sums_[k].first, sums_[k].rolls * sums_[k].yaws);
    });
    each([&](int i, std::size_t k) {
      if (!(lane(inside_, i) > 0.0)) return;
      if (!table_.find_cell(lane(pose_.y, i), sums_[k], lateral_[k], ends_[k])) return;
      lane(found_, i) = 1.0;
      std::memcpy(&ends[k], &ends_[k][here], sizeof ends[k]);
      lane(from, i) = data_.lateral[lateral_[k]];
      lane(width_, i) = data_.lateral[lateral_[k] + 1] - data_.lateral[lateral_[k]];
      table_.fetch_rise(lateral_[k]);
    });
    Four corner;
    set_side_by_side(ends, corner.data());
    using std::abs;
    t_ = (pose_.y - corner[0]) / (corner[2] - corner[0]);
    for (int iteration = 0; iteration < 20; ++iteration) {  // two suffice
      const HermiteBasisOf<V> basis(t_, width_);
      const V change = (sum(basis.value, corner) - pose_.y) / (sum(basis.first, corner) * width_);
      t_ = t_ - change;
      if (all((abs(change) < broadcast<V>(root)) | (found_ < 0.5))) break;
    }
    t_ = select(t_ > zero, at_most(t_, one), zero);
    across_ = HermiteBasisOf<V>(t_, width_);
    const V y0 = from + t_ * width_;
    const double range = data_.lateral.back() - data_.lateral.front();
    inside_ = inside_ *
              smooth_step(at_most(y0 - data_.lateral.front(), data_.lateral.back() - y0) * (1.0 / (border * range)));
    inside_ = select(found_ > 0.5, inside_, zero);
  }

  // The level below, and what the corners of the cell leave across. All levels are guessed first: the memory then has
  // the corners of all poses to bring.
  void find_levels() {
    found_ = V{};
    each([&](int i, std::size_t k) {
      if (!(lane(inside_, i) > 0.0)) return;
      const double t = lane(t_, i), touch = (1.0 - t) * ends_[k][here][4] + t * ends_[k][here][5];
      level_[k] = table_.guess_level(lane(pose_.z, i) - touch, lateral_[k], t);
      lane(found_, i) = 1.0;  // unless z is above first touch, which the corners say
      table_.fetch_corners(lateral_[k], level_[k], sums_[k].first, sums_[k].rolls * sums_[k].yaws);
    });
    each([&](int i, std::size_t k) {
      if (lane(found_, i) == 0.0) return set_no_lines(k);
      const std::array<double, 4> value = at(across_.value, i);
      const double z = lane(pose_.z, i), yaw = lane(pose_.yaw, i);
      Corners corners;
      Pack& line = line_[height][k];
      for (int moved = 0;;) {
        table_.add_corners(lateral_[k], level_[k], sums_[k], ends_[k], corners);
        corners.across(value, here, line);
        if (z <= line[0] && level_[k] == 0) {
          lane(found_, i) = 0.0;
          return set_no_lines(k);
        }
        if (z < line[0] && moved <= 0) {
          moved = -1;
          --level_[k];
        } else if (z >= line[2] && moved >= 0) {
          if (level_[k] == data_.levels - 2) {
            lane(inside_, i) = lane(found_, i) = 0.0;
            return set_no_lines(k);
          }
          moved = 1;
          ++level_[k];
        } else {
          break;
        }
      }
      PartPlace& place = part_place_[k];
      place.node = PartPlace::nodes(lateral_[k], level_[k], data_.levels);
      place.t = lane(t_, i);
      place.width = lane(width_, i);
      place.r = PartPlace::Linear(data_.roll, lane(pose_.roll, i));
      place.s = PartPlace::Linear(data_.yaw_squared, yaw * yaw);
      table_.fetch_parts(place);
      lane(touches_, i) = 1.0;
      lane(level_number_, i) = level_[k];
      const std::array<double, 4> first = at(across_.first, i);
      corners.across(first, here, line_[over_y0][k]);
      corners.across(value, by_roll, line_[over_roll][k]);
      corners.across(value, by_yaw, line_[over_yaw][k]);
      if constexpr (slopes) {
        corners.across(at(across_.second, i), here, line_[over_y0_y0][k]);
        corners.across(value, by_roll_roll, line_[over_roll_roll][k]);
        corners.across(value, by_roll_yaw, line_[over_roll_yaw][k]);
        corners.across(value, by_yaw_yaw, line_[over_yaw_yaw][k]);
        corners.across(first, by_roll, line_[over_y0_roll][k]);
        corners.across(first, by_yaw, line_[over_y0_yaw][k]);
      }
    });
    for (std::size_t which = 0; which < lines_used; ++which) set_side_by_side(line_[which], z_[which].data());
    for (std::size_t d = 0; d < NodeSums<slopes>::wanted; ++d) {
      OfPoses y{};
      each([&](int i, std::size_t k) {
        if (lane(found_, i) > 0.0) std::memcpy(&y[k], &ends_[k][d], sizeof y[k]);
      });
      set_side_by_side(y, y_[d].data());
    }
  }

  void set_no_lines(std::size_t k) {
    for (OfPoses& line : line_) line[k] = Pack{};
  }

  // The place u between the levels: the root of a cubic that grows from z or less to z or more.
  void find_place() {
    using std::abs, std::sqrt;
    const Four& line = z_[height];
    const V zero{};
    V low{}, high = broadcast<V>(1.0);
    u_ = (pose_.z - line[0]) / (line[2] - line[0]);
    u_ = select(level_number_ < 0.5, sqrt(select(u_ > zero, u_, zero)), u_);
    constexpr double rounding = 1e-13;  // of a place
    for (int iteration = 0; iteration < 60; ++iteration) {
      const HermiteBasisOf<V> basis(u_, broadcast<V>(table_.level_step_));
      const V excess = sum(basis.value, line) - pose_.z, slope = sum(basis.first, line) * table_.level_step_;
      high = select(excess > zero, u_, high);
      low = select(excess > zero, low, u_);
      V next = u_ - excess / slope;
      const auto within = (next >= low) & (next <= high);
      next = select(within, next, 0.5 * (low + high));
      const V change = abs(next - u_);
      u_ = next;
      if (all((change < broadcast<V>(rounding)) | (within & (change < root * u_)) | (found_ < 0.5))) break;
    }
  }

  // y0(y, roll, yaw), then w(y, z, roll, yaw) from Z(w, y0(y, roll, yaw), roll, yaw) = z.
  void find_energy() {
    find_place();
    const V zero{}, w = (level_number_ + u_) * table_.level_step_;
    const double last = data_.levels - 1;
    const V below_last = smooth_step((last - (level_number_ + u_)) * (1.0 / (border * last)));
    inside_ = inside_ * select(found_ > 0.5, below_last, broadcast<V>(1.0));
    along_ = HermiteBasisOf<V>(u_, broadcast<V>(table_.level_step_));
    const V Z_w = Z(along_.first, height), Z_y = Z(along_.value, over_y0);
    found_ = select(Z_w > zero, found_, zero);
    by_Y_ = 1.0 / Y(across_.first, here);
    by_Z_ = 1.0 / Z_w;
    place_.w = w;
    place_.y0_1 = {by_Y_, zero, -(Y(across_.value, by_roll) * by_Y_), -(Y(across_.value, by_yaw) * by_Y_)};
    const Four Z_1{Z_y * place_.y0_1[0], broadcast<V>(-1.0), Z(along_.value, over_roll) + Z_y * place_.y0_1[2],
                   Z(along_.value, over_yaw) + Z_y * place_.y0_1[3]};
    const V w4 = w * w * w * w;
    for (std::size_t j = 0; j < 4; ++j) {
      place_.w_1[j] = -(Z_1[j] * by_Z_);
      element(result_.force, j) = select(found_ > 0.5, 5.0 * w4 * place_.w_1[j], zero);
    }
    // Without contact the share counts, and nothing else.
    result_.table_share = select((found_ > 0.5) | (touches_ < 0.5), inside_, zero);
    result_.energy = select(found_ > 0.5, w4 * w, zero);
  }

  void set_stiffness() {
    const V zero{}, &w = place_.w, w3 = w * w * w;
    const Four &w_1 = place_.w_1, &y0_1 = place_.y0_1;
    const V Y_yy = Y(across_.second, here), Z_yy = Z(along_.value, over_y0_y0), Z_y = Z(along_.value, over_y0);
    const V Z_wy = Z(along_.first, over_y0), Z_ww = Z(along_.second, height);
    const Four Y_y1{zero, zero, Y(across_.first, by_roll), Y(across_.first, by_yaw)};
    const Four Z_y1{zero, zero, Z(along_.value, over_y0_roll), Z(along_.value, over_y0_yaw)};
    const Four Z_w1{Z_wy * y0_1[0], zero, Z(along_.first, over_roll) + Z_wy * y0_1[2],
                    Z(along_.first, over_yaw) + Z_wy * y0_1[3]};
    for (std::size_t j = 0; j < 4; ++j) {
      for (std::size_t m = 0; m <= j; ++m) {
        V Y_2 = Y_y1[j] * y0_1[m] + y0_1[j] * Y_y1[m] + Y_yy * y0_1[j] * y0_1[m];
        V Z_2 = Z_y1[j] * y0_1[m] + y0_1[j] * Z_y1[m] + Z_yy * y0_1[j] * y0_1[m];
        if (m >= 2) {
          const std::size_t both = j + m - 4;  // 0: roll twice, 1: roll and yaw, 2: yaw twice
          Y_2 = Y_2 + Y(across_.value, static_cast<Direction>(by_roll_roll + both));
          Z_2 = Z_2 + Z(along_.value, over_roll_roll + both);
        }
        Z_2 = Z_2 - Z_y * Y_2 * by_Y_;
        const V w_2 = -((Z_2 + Z_w1[j] * w_1[m] + w_1[j] * Z_w1[m] + Z_ww * w_1[j] * w_1[m]) * by_Z_);
        element(derivatives_->stiffness, j, m) = element(derivatives_->stiffness, m, j) =
            5.0 * w3 * (4.0 * w_1[j] * w_1[m] + w * w_2);
      }
    }
  }

  // The parts of every pose, in their order; then those of equal number side by side.
  void set_parts() {
    std::array<std::array<PartSums, LoadedLookup::capacity>, places> sums;
    std::array<std::size_t, places> count{};
    each([&](int i, std::size_t k) {
      if (lane(found_, i) == 0.0) return;
      PartPlace& at = part_place_[k];
      at.u = lane(u_, i);
      std::uint32_t loaded = 0;
      for (const std::size_t node : at.node) loaded |= data_.pressed[node];
      for (; loaded != 0; loaded &= loaded - 1) {
        const auto part = static_cast<std::size_t>(std::countr_zero(loaded));
        if (table_.sum_part<slopes>(at, part, sums[k][count[k]])) ++count[k];
      }
      result_.parts = std::max(result_.parts, count[k]);
    });
    if (result_.parts > 1) {
      give_parts<LoadedPart::quantities>(sums, count);
    } else {
      give_parts<LoadedPart::of_one>(sums, count);
    }
  }

  // @param sloped quantities whose slopes are set
  template <std::size_t sloped>
  void give_parts(const std::array<std::array<PartSums, LoadedLookup::capacity>, places>& sums,
                  const std::array<std::size_t, places>& count) noexcept {
    constexpr std::size_t kinds = slopes ? std::size_t{PartSums::count} : 1;
    for (std::size_t p = 0; p < result_.parts; ++p) {
      std::array<V, PartSums::count * LoadedPart::quantities> numbers;
      V has{};
      each([&](int i, std::size_t k) { lane(has, i) = p < count[k] ? 1.0 : 0.0; });
      for (std::size_t kind = 0; kind < kinds; ++kind) {
        for (std::size_t q = 0; q < PartSums::packs; ++q) {
          if (kind != PartSums::value && 4 * q >= sloped) break;
          OfPoses of;
          of.fill(kind == PartSums::value ? 1.0 - Pack{} : Pack{});
          each([&](int, std::size_t k) {
            if (p < count[k]) of[k] = sums[k][p].sum[kind][q];
          });
          set_side_by_side(of, &numbers[kind * LoadedPart::quantities + 4 * q]);
        }
      }
      set_part<sloped>(numbers, p);
      result_.part[p].share = select(has > 0.5, result_.part[p].share, V{});
    }
  }

  // A part from its sums: from reduced quantities to lengths, densities and pressure.
  template <std::size_t sloped>
  void set_part(const std::array<V, PartSums::count * LoadedPart::quantities>& sums, std::size_t p) noexcept {
    constexpr std::size_t count = LoadedPart::quantities;
    enum Scale : std::size_t { none, of_yaw, of_w, of_ww };
    constexpr std::array<Scale, count> scale_of{none, of_yaw, none,  none, none, of_w,
                                                of_w, of_ww,  of_ww, none, none, of_w};
    const V one = broadcast<V>(1.0), &w = place_.w, zero{};
    const std::array<V, 4> scale{one, pose_.yaw, w, w * w};
    const V share = sums[0], inverse = 1.0 / share;
    std::array<V, count> mean;
    for (std::size_t q = 1; q < count; ++q) mean[q] = inverse * sums[q];
    mean[0] = share;
    using std::sqrt;
    // At yaw 0 squares are extrapolated by a millionth: the sum of very small ones may be below zero.
    const V square = sums[PartSums::pressure], least = broadcast<V>(1e-30);
    mean[PartSums::pressure] = sqrt(select(square > least, square, least));
    LoadedPartOf<V>& part = result_.part[p];
    for (std::size_t q = 0; q < count; ++q) part[q] = scale[scale_of[q]] * mean[q] + table_.reference_[q];
    if constexpr (slopes) {
      const std::array<V, 4> scale_w{zero, zero, one, 2.0 * w};
      const auto along = [&](PartSums::Along d, std::size_t q) {
        const V& of_share = sums[d * count];
        if (q == PartSums::pressure) return 0.5 / mean[q] * sums[d * count + q];
        return q == 0 ? of_share : inverse * (sums[d * count + q] - of_share * mean[q]);
      };
      LoadedPartOf<std::array<V, 4>>& part_1 = derivatives_->part[p];
      for (std::size_t q = 0; q < sloped; ++q) {
        const V &by_scale = scale[scale_of[q]], &by_scale_w = scale_w[scale_of[q]];
        const V by_y0 = by_scale * along(PartSums::by_lateral, q),
                by_w = by_scale * along(PartSums::by_level, q) + by_scale_w * mean[q];
        std::array<V, 4>& slope = part_1[q];
        for (std::size_t j = 0; j < 4; ++j) slope[j] = by_y0 * place_.y0_1[j] + by_w * place_.w_1[j];
        slope[2] = slope[2] + by_scale * along(PartSums::by_roll_node, q);
        slope[3] = slope[3] + 2.0 * pose_.yaw * by_scale * along(PartSums::by_yaw_node, q);
      }
      part_1.arm_x[3] = part_1.arm_x[3] + mean[1];
    }
  }

  /// The place along the energy and how it and y0 follow the pose (y, z, roll, yaw).
  struct {
    V w;
    Four w_1, y0_1;
  } place_;

  const LoadedTable& table_;
  const LoadedTableData& data_;
  const LoadedPoseOf<V>& pose_;
  LoadedLookupOf<V>& result_;
  LoadedSlopesOf<V>* derivatives_;
  Weights<V> weights_;
  std::array<NodeSums<slopes>, places> sums_;
  std::array<CellEnds<slopes>, places> ends_;
  std::array<PartPlace, places> part_place_;
  V inside_;
  V found_{}, touches_{};  ///< 1 where the search goes on; where there is contact
  std::array<std::size_t, places> lateral_{};
  std::array<int, places> level_{};
  V level_number_{}, width_, t_, u_;
  HermiteBasisOf<V> across_{V{}, broadcast<V>(1.0)}, along_{V{}, broadcast<V>(1.0)};
  std::array<OfPoses, lines_used> line_;  ///< find_levels() sets those of every pose
  std::array<Four, lines_used> z_;
  std::array<Four, NodeSums<slopes>::wanted> y_;  ///< y(y0): value and slope at the lower node, then at the upper one
  V by_Y_, by_Z_;                                 ///< 1/Y_y0, 1/Z_w
};

namespace {

/// From derivatives with respect to (y, z, r, yaw), r = roll + climb·y, to those with respect to (y, z, roll, yaw).
template <class V>
void add_climb(double climb, LoadedLookupOf<V>& result, LoadedSlopesOf<V>* derivatives) noexcept {
  element(result.force, 0) = element(result.force, 0) + climb * element(result.force, 2);
  if (derivatives == nullptr) return;
  const auto at = [derivatives](std::size_t i, std::size_t j) -> V& { return element(derivatives->stiffness, i, j); };
  for (std::size_t j = 0; j < 4; ++j) at(0, j) = at(0, j) + climb * at(2, j);
  for (std::size_t i = 0; i < 4; ++i) at(i, 0) = at(i, 0) + climb * at(i, 2);
  const std::size_t sloped = result.parts > 1 ? LoadedPart::quantities : LoadedPart::of_one;
  for (std::size_t p = 0; p < result.parts; ++p) {
    for (std::size_t q = 0; q < sloped; ++q) {
      std::array<V, 4>& slope = derivatives->part[p][q];
      slope[0] = slope[0] + climb * slope[2];
    }
  }
}

}  // namespace

template <bool slopes, class V>
void LoadedTable::find(const LoadedPoseOf<V>& pose, LoadedLookupOf<V>& result,
                       LoadedSlopesOf<V>* derivatives) const noexcept {
  result.table_share = result.energy = V{};
  for (std::size_t j = 0; j < 4; ++j) element(result.force, j) = V{};
  result.parts = 0;
  if constexpr (slopes) set_zero(derivatives->stiffness);
  LoadedPoseOf<V> reduced = pose;
  reduced.roll = pose.roll + data_.climb * pose.y;
  const V inside = margin_share(reduced.roll, pose.yaw);
  if (!any(inside > V{})) return;
  LookUp<slopes, V>(*this, reduced, result, derivatives).run(inside);
  if (data_.climb != 0.0) add_climb(data_.climb, result, slopes ? derivatives : nullptr);
}

template void LoadedTable::find<false, double>(const LoadedPoseOf<double>&, LoadedLookup&,
                                               LoadedSlopes*) const noexcept;
template void LoadedTable::find<true, double>(const LoadedPoseOf<double>&, LoadedLookup&, LoadedSlopes*) const noexcept;
template void LoadedTable::find<false, WheelLanes>(const LoadedPoseOf<WheelLanes>&, LoadedLookupOf<WheelLanes>&,
                                                   LoadedSlopesOf<WheelLanes>*) const noexcept;
template void LoadedTable::find<true, WheelLanes>(const LoadedPoseOf<WheelLanes>&, LoadedLookupOf<WheelLanes>&,
                                                  LoadedSlopesOf<WheelLanes>*) const noexcept;

}  // namespace railtab
