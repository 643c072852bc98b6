#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <type_traits>
#include <vector>

#include "railtab/runtime/base/lane_numbers.hpp"
#include "railtab/runtime/base/pack.hpp"
#include "railtab/tables/loaded_table.hpp"

/// What a look-up in a loaded table sums up over the table's nodes.
namespace railtab {

/// Derivatives along roll and yaw.
enum LoadedTable::Direction : std::size_t { here, by_roll, by_yaw, by_roll_roll, by_roll_yaw, by_yaw_yaw, directions };

/// The polynomials of Lagrange with value 1 at one node, with two derivatives.
template <class V>
struct LoadedTable::Lagrange {
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

/// Of one part the share, every other quantity but the pressure weighted with it, and the pressure's square; the sums
/// and their derivatives along the coordinates. The square is nearly linear also where a part begins: there the
/// pressure grows with the cube root of its force, on a strip between others with the square root or faster.
struct LoadedTable::PartSums {
  enum Along : std::size_t { value, by_lateral, by_level, by_roll_node, by_yaw_node, count };
  static constexpr std::size_t packs = LoadedPart::quantities / 4, pressure = LoadedPart::quantities - 1;
  static constexpr std::size_t arm_y = 2, arm_z = 3;
  Pack sum[count][packs];
};

}  // namespace railtab
