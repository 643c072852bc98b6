#include "railtab/tables/loaded_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "railtab/runtime/base/input_error.hpp"
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
struct Lagrange {
  std::array<double, LoadedTable::most_nodes> value, first, second;

  /// @param inverse 1/(node i − node j), j fastest
  Lagrange(const std::vector<double>& node, const std::vector<double>& inverse, double x) noexcept {
    for (std::size_t i = 0; i < node.size(); ++i) {
      double p = 1.0, dp = 0.0, ddp = 0.0;
      for (std::size_t j = 0; j < node.size(); ++j) {
        if (j == i) continue;
        const double slope = inverse[i * node.size() + j], factor = (x - node[j]) * slope;
        ddp = ddp * factor + 2.0 * dp * slope;
        dp = dp * factor + p * slope;
        p *= factor;
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

// Derivatives along the pose and its reductions.
enum Direction : std::size_t { here, by_roll, by_yaw, by_roll_roll, by_roll_yaw, by_yaw_yaw, directions };

}  // namespace

/// Weights of the columns (roll, yaw²) in the value and in derivatives with respect to roll and yaw.
struct LoadedTable::Weights {
  static constexpr std::size_t most = most_nodes * most_nodes;
  std::size_t columns;
  std::array<std::array<Pack, 2>, most> column;  ///< over Direction, of which the last two are idle
  std::array<double, 2 * most> twice;            ///< of the values, each for a quantity and its slope

  Weights(const LoadedTable& table, double roll, double yaw) noexcept : columns(table.data_.columns()) {
    const LoadedTableData& data = table.data_;
    const Lagrange r(data.roll, table.inverse_roll_, roll), s(data.yaw_squared, table.inverse_yaw_, yaw * yaw);
    std::size_t k = 0;
    for (std::size_t i = 0; i < data.roll.size(); ++i) {
      for (std::size_t j = 0; j < data.yaw_squared.size(); ++j, ++k) {
        const double yaw_1 = 2.0 * yaw * s.first[j], yaw_2 = 2.0 * s.first[j] + 4.0 * yaw * yaw * s.second[j];
        column[k][0] =
            Pack{r.value[i] * s.value[j], r.first[i] * s.value[j], r.value[i] * yaw_1, r.second[i] * s.value[j]};
        column[k][1] = Pack{r.first[i] * yaw_1, r.value[i] * yaw_2, 0.0, 0.0};
        twice[2 * k] = twice[2 * k + 1] = column[k][0][here];
      }
    }
  }
  [[nodiscard]] double value(std::size_t k) const noexcept { return column[k][0][here]; }
};

/// Where a pose lies.
struct LoadedTable::Cell {
  std::size_t lateral = 0;  ///< the lower node
  double width = 0.0;       ///< [m]
  double t = 0.0;           ///< 0..1
  HermiteBasis across{0.0, 1.0};
  std::array<double, 2> touch{};  ///< height of first touch at both lateral nodes, in this roll and yaw [m]
  int level = 0;                  ///< the lower node
  double u = 0.0;
};

void require_consistent(const LoadedTableData& table, const std::string& source) {
  constexpr std::size_t many = 100000;
  const auto place = [&](const char* name) { return fmt::format("{}: {}", source, name); };
  require_increasing(place("lateral"), table.lateral, 2, many);
  require_increasing(place("roll"), table.roll, 2, LoadedTable::most_nodes);
  require_increasing(place("yaw_squared"), table.yaw_squared, 1, LoadedTable::most_nodes);
  if (table.levels < 3 || table.levels > 10000 || !(table.largest_level > 0.0)) {
    throw input_error(place("levels"), fmt::format("{} up to {}", table.levels, table.largest_level),
                      "3..10000, up to more than 0");
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
  inverse_roll_ = inverse_distances(data_.roll);
  inverse_yaw_ = inverse_distances(data_.yaw_squared);
  level_step_ = data_.largest_level / (data_.levels - 1);
  for (std::size_t i = 0, node = 0; i < buckets; ++i) {
    const double y0 = data_.lateral.front() + (data_.lateral.back() - data_.lateral.front()) * static_cast<double>(i) /
                                                  static_cast<double>(buckets);
    while (node + 2 < data_.lateral.size() && data_.lateral[node + 1] <= y0) ++node;
    bucket_.push_back(static_cast<std::uint32_t>(node));
  }
  const std::size_t middle = data_.roll.size() / 2 * data_.yaw_squared.size();
  for (std::size_t i = 0; i < nodes; ++i) rise_.push_back(data_.height[4 * (i * columns + middle)]);
}

std::size_t LoadedTable::bytes() const noexcept {
  return sizeof(double) * (data_.shift.size() + data_.touch.size() + data_.lateral.size()) +
         sizeof(float) * (data_.height.size() + data_.pressed.size() + data_.part.size() + rise_.size()) +
         sizeof(std::size_t) * part_at_.size();
}

bool LoadedTable::find_lateral(double y, const Weights& weights, Cell& cell) const noexcept {
  // y and its derivative at a node.
  const auto place = [&](std::size_t node, double& derivative) {
    const double* const shift = &data_.shift[2 * node * weights.columns];
    Pack even{}, odd{}, a, b;
    std::size_t k = 0;
    for (; k + 4 <= weights.columns; k += 4) {
      const double *const from = shift + 2 * k, *const weight = &weights.twice[2 * k];
      std::memcpy(&a, from, sizeof a);
      std::memcpy(&b, weight, sizeof b);
      even += a * b;
      std::memcpy(&a, from + 4, sizeof a);
      std::memcpy(&b, weight + 4, sizeof b);
      odd += a * b;
    }
    even += odd;
    double at = even[0] + even[2], slope = even[1] + even[3];
    for (; k < weights.columns; ++k) {
      at += weights.value(k) * shift[2 * k];
      slope += weights.value(k) * shift[2 * k + 1];
    }
    derivative = slope;
    return at;
  };
  const std::size_t last = data_.lateral.size() - 1;
  const double first_y0 = data_.lateral.front(), range = data_.lateral.back() - first_y0;
  const auto node_of = [&](double y0) {
    const double at = std::clamp((y0 - first_y0) / range, 0.0, 1.0) * static_cast<double>(buckets);
    return static_cast<std::size_t>(bucket_[std::min(static_cast<std::size_t>(at), buckets - 1)]);
  };
  // The displacement changes little along y0: from the node at y to that at y less its displacement, and on from there.
  double slope = 0.0;
  const std::size_t near = node_of(y);
  std::size_t low = node_of(y - (place(near, slope) - data_.lateral[near]));
  std::array<double, 4> corner{};
  corner[0] = place(low, corner[1]);
  while (low > 0 && corner[0] > y) corner[0] = place(--low, corner[1]);
  corner[2] = place(low + 1, corner[3]);
  while (low + 1 < last && corner[2] <= y) {
    corner[0] = corner[2];
    corner[1] = corner[3];
    corner[2] = place(++low + 1, corner[3]);
  }
  const std::size_t high = low + 1;
  cell.lateral = low;
  cell.width = data_.lateral[high] - data_.lateral[low];
  if (!(y >= corner[0] && y <= corner[2])) return false;
  double t = (y - corner[0]) / (corner[2] - corner[0]);
  constexpr double root = 1e-8;  // of rounding: Newton's next correction is less than its square
  for (int iteration = 0; iteration < 20; ++iteration) {  // nearly linear: two suffice
    const HermiteBasis basis(t, cell.width);
    const double change =
        (HermiteBasis::sum(basis.value, corner) - y) / (HermiteBasis::sum(basis.first, corner) * cell.width);
    t -= change;
    if (std::abs(change) < root) break;
  }
  cell.t = std::clamp(t, 0.0, 1.0);
  cell.across = HermiteBasis(cell.t, cell.width);
  for (std::size_t i = 0; i < 2; ++i) {
    const double* const touch = &data_.touch[(low + i) * weights.columns];
    for (std::size_t k = 0; k < weights.columns; ++k) cell.touch[i] += weights.value(k) * touch[k];
  }
  return true;
}

double LoadedTable::touch_height(const Cell& cell, const Weights& weights) const noexcept {
  const std::size_t columns = weights.columns, levels = static_cast<std::size_t>(data_.levels);
  const float* const low = &data_.height[4 * cell.lateral * levels * columns];
  const float* const high = low + 4 * levels * columns;
  Pack at_low{}, at_high{};  // value and slope across are the first and the third
  for (std::size_t k = 0; k < columns; ++k) {
    Pack node;
    widen(low + 4 * k, node);
    at_low += weights.value(k) * node;
    widen(high + 4 * k, node);
    at_high += weights.value(k) * node;
  }
  const std::array<double, 4>& basis = cell.across.value;
  return basis[0] * (cell.touch[0] + at_low[0]) + basis[1] * at_low[2] + basis[2] * (cell.touch[1] + at_high[0]) +
         basis[3] * at_high[2];
}

void LoadedTable::find_level(double z, const Weights& weights, Cell& cell) const noexcept {
  const double touch = touch_height(cell, weights);
  cell.level = -1;
  if (z <= touch) return;
  // By the rise of the middle column; found() goes on from there.
  const double above = z - touch;
  const auto levels = static_cast<std::size_t>(data_.levels);
  const float *const low = &rise_[cell.lateral * levels], *const high = low + levels;
  const auto rise = [&](int level) {
    const auto k = static_cast<std::size_t>(level);
    return (1.0 - cell.t) * static_cast<double>(low[k]) + cell.t * static_cast<double>(high[k]);
  };
  const double share = std::sqrt(above / rise(data_.levels - 1));
  int level = std::clamp(static_cast<int>(std::min(share, 1.0) * (data_.levels - 1)), 0, data_.levels - 2);
  while (level > 0 && rise(level) > above) --level;
  while (level < data_.levels - 2 && rise(level + 1) <= above) ++level;
  cell.level = level;
}

/// The place along the energy and how it and y0 follow the pose (y, z, roll, yaw).
struct LoadedTable::LevelPlace {
  double w;
  Eigen::Vector4d w_1, y0_1;
};

namespace {

// Linear interpolation between the two nodes around a place: the lower one, the place between them, and its rate.
struct Linear {
  std::size_t low = 0, high = 0;
  double part = 0.0, rate = 0.0;

  Linear(const std::vector<double>& node, double x) noexcept {
    if (node.size() == 1) return;
    const auto above = std::upper_bound(node.begin() + 1, node.end() - 1, x);
    high = static_cast<std::size_t>(above - node.begin());
    low = high - 1;
    rate = 1.0 / (node[high] - node[low]);
    part = (x - node[low]) * rate;
  }
};

}  // namespace

void LoadedTable::fetch_parts(const Cell& cell, double roll, double yaw) const noexcept {
  const Linear r(data_.roll, roll), s(data_.yaw_squared, yaw * yaw);
  const std::size_t levels = static_cast<std::size_t>(data_.levels), yaws = data_.yaw_squared.size();
  const std::size_t first = cell.lateral * levels + static_cast<std::size_t>(cell.level);
  for (const std::size_t node : {first, first + levels, first + 1, first + levels + 1}) {
    if (data_.pressed[node] == 0) continue;
    for (const std::size_t i : {r.low, r.high}) {
      const float* const stored = &data_.part[part_at_[node] + (i * yaws + s.low) * LoadedPart::quantities];
      __builtin_prefetch(stored);
      __builtin_prefetch(stored + LoadedPart::quantities);
    }
  }
}

template <bool slopes>
void LoadedTable::add_parts(const Cell& cell, const LevelPlace& place, double roll, double yaw, LoadedLookup& result,
                            LoadedSlopes* derivatives) const noexcept {
  // Every quantity but the share weighted with it; the sums and their derivatives along the four coordinates.
  constexpr std::size_t packs = LoadedPart::quantities / 4;
  enum Along : std::size_t { value, by_lateral, by_level, by_roll_node, by_yaw_node, count };
  const std::size_t columns = data_.columns(), levels = static_cast<std::size_t>(data_.levels);
  const std::size_t yaws = data_.yaw_squared.size();
  const Linear r(data_.roll, roll), s(data_.yaw_squared, yaw * yaw);
  const std::array<double, 2> ft{1.0 - cell.t, cell.t}, fu{1.0 - cell.u, cell.u};
  const std::array<double, 2> fr{1.0 - r.part, r.part}, fs{1.0 - s.part, s.part};
  const std::array<double, 2> t_rate{-1.0 / cell.width, 1.0 / cell.width},
      u_rate{-1.0 / level_step_, 1.0 / level_step_};
  const std::array<double, 2> r_rate{-r.rate, r.rate}, s_rate{-s.rate, s.rate};
  const std::size_t first = cell.lateral * levels + static_cast<std::size_t>(cell.level);
  const std::array<std::size_t, 4> node{first, first + levels, first + 1, first + levels + 1};
  unsigned loaded = 0;
  for (const std::size_t n : node) loaded |= data_.pressed[n];
  const double w = place.w;
  for (std::size_t p = 0; p < data_.parts(); ++p) {
    if ((loaded >> p & 1U) == 0) continue;
    Pack sum[count][packs]{};
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const std::uint32_t pressed = data_.pressed[node[corner]];
      if ((pressed >> p & 1U) == 0) continue;
      const auto before = static_cast<std::size_t>(std::popcount(pressed & ((1U << p) - 1U)));
      const float* const stored = &data_.part[part_at_[node[corner]] + before * columns * LoadedPart::quantities];
      Pack here_[packs]{}, along_roll[packs]{}, along_yaw[packs]{};
      for (std::size_t i = 0; i <= r.high - r.low; ++i) {
        for (std::size_t j = 0; j <= s.high - s.low; ++j) {
          const float* const v = stored + ((r.low + i) * yaws + s.low + j) * LoadedPart::quantities;
          const double share = static_cast<double>(v[0]);
          for (std::size_t q = 0; q < packs; ++q) {
            Pack values;
            widen(v + 4 * q, values);
            values *= q == 0 ? Pack{1.0, share, share, share} : Pack{share, share, share, share};
            here_[q] += fr[i] * fs[j] * values;
            if constexpr (slopes) {
              along_roll[q] += r_rate[i] * fs[j] * values;
              along_yaw[q] += fr[i] * s_rate[j] * values;
            }
          }
        }
      }
      const std::size_t t = corner & 1U, u = corner >> 1U;
      for (std::size_t q = 0; q < packs; ++q) {
        sum[value][q] += ft[t] * fu[u] * here_[q];
        if constexpr (slopes) {
          sum[by_lateral][q] += t_rate[t] * fu[u] * here_[q];
          sum[by_level][q] += ft[t] * u_rate[u] * here_[q];
          sum[by_roll_node][q] += ft[t] * fu[u] * along_roll[q];
          sum[by_yaw_node][q] += ft[t] * fu[u] * along_yaw[q];
        }
      }
    }
    const double share = sum[value][0][0], inverse = 1.0 / share;
    if (!(share > 0.0)) continue;
    // From reduced quantities to lengths, densities and pressure.
    const Pack scale[packs]{{1.0, yaw, 1.0, 1.0}, {1.0, w, w, w * w}, {w * w, 1.0, 1.0, w}};
    const Pack means{0.0, 1.0, 1.0, 1.0};  // all but the share
    Pack mean[packs];
    for (std::size_t q = 0; q < packs; ++q) mean[q] = inverse * sum[value][q];
    mean[0][0] = share;
    const auto store = [](const Pack(&from)[packs], LoadedPart& to) { std::memcpy(&to, from, sizeof to); };
    Pack scaled[packs];
    for (std::size_t q = 0; q < packs; ++q) scaled[q] = scale[q] * mean[q];
    store(scaled, result.part[result.parts]);
    if constexpr (slopes) {
      for (std::size_t d = by_lateral; d < count; ++d) {
        const double slope = sum[d][0][0];
        for (std::size_t q = 0; q < packs; ++q) sum[d][q] = inverse * (sum[d][q] - slope * mean[q]);
        sum[d][0] = means * sum[d][0] + (1.0 - means) * slope;
      }
      const Pack scale_w[packs]{{0.0, 0.0, 0.0, 0.0}, {0.0, 1.0, 1.0, 2.0 * w}, {2.0 * w, 0.0, 0.0, 1.0}};
      Pack slope[4][packs];
      for (std::size_t j = 0; j < 4; ++j) {
        const auto k = static_cast<Eigen::Index>(j);
        for (std::size_t q = 0; q < packs; ++q) {
          slope[j][q] = scale[q] * (sum[by_lateral][q] * place.y0_1[k] + sum[by_level][q] * place.w_1[k]) +
                        scale_w[q] * mean[q] * place.w_1[k];
          if (j == 2) slope[j][q] += scale[q] * sum[by_roll_node][q];
          if (j == 3) slope[j][q] += 2.0 * yaw * scale[q] * sum[by_yaw_node][q];
        }
        if (j == 3) slope[j][0][1] += mean[0][1];
      }
      Pack along[LoadedPart::quantities];
      for (std::size_t q = 0; q < packs; ++q) {
        transpose(slope[0][q], slope[1][q], slope[2][q], slope[3][q], &along[4 * q]);
      }
      std::memcpy(&derivatives->part[result.parts], along, sizeof along);
    }
    ++result.parts;
  }
}

double LoadedTable::margin_share(double roll, double yaw) const noexcept {
  const double margin = border * (data_.roll.back() - data_.roll.front());
  const double share = smooth_step(std::min(roll - data_.roll.front(), data_.roll.back() - roll) / margin);
  const double largest = data_.yaw_squared.back();
  if (data_.yaw_squared.size() == 1) return yaw * yaw <= largest ? share : 0.0;
  return share * smooth_step((largest - yaw * yaw) / (border * largest));
}

/// The corners' values, slopes along w and y0 and mixed derivatives, by Direction: of the lower lateral node at both
/// levels, then of the upper one.
struct LoadedTable::Corners {
  Pack of[4][directions];
};

/// The corners in the directions that are wanted.
template <bool slopes>
void LoadedTable::add_corners(const Cell& cell, const Weights& weights, Corners& corners) const noexcept {
  constexpr std::size_t wanted = slopes ? directions : by_yaw + 1, packs = slopes ? 2 : 1;
  const std::size_t columns = weights.columns, levels = static_cast<std::size_t>(data_.levels);
  for (std::size_t lateral = 0; lateral < 2; ++lateral) {
    const std::size_t node = cell.lateral + lateral;
    const float* const height = &data_.height[4 * (node * levels + static_cast<std::size_t>(cell.level)) * columns];
    const double* const touch = &data_.touch[node * columns];
    Pack touches[2]{}, at_low[wanted]{}, at_high[wanted]{};
    for (std::size_t k = 0; k < columns; ++k) {
      const auto& weight = weights.column[k];
      Pack below, above;
      widen(height + 4 * k, below);
      widen(height + 4 * (columns + k), above);
      for (std::size_t d = 0; d < wanted; ++d) {
        at_low[d] += weight[d / 4][d % 4] * below;
        at_high[d] += weight[d / 4][d % 4] * above;
      }
      for (std::size_t q = 0; q < packs; ++q) touches[q] += touch[k] * weight[q];
    }
    for (std::size_t d = 0; d < wanted; ++d) {
      at_low[d][0] += touches[d / 4][d % 4];
      at_high[d][0] += touches[d / 4][d % 4];
      corners.of[2 * lateral][d] = at_low[d];
      corners.of[2 * lateral + 1][d] = at_high[d];
    }
  }
}

namespace {

/// Along w, of one direction's corners contracted across: value and slope at the lower level, then at the upper one.
std::array<double, 4> across_at(const Pack (*corner)[directions], const std::array<double, 4>& basis,
                                Direction d) noexcept {
  const Pack below{basis[0], basis[0], basis[1], basis[1]}, above{basis[2], basis[2], basis[3], basis[3]};
  const Pack low = below * corner[0][d] + above * corner[2][d], high = below * corner[1][d] + above * corner[3][d];
  return {low[0] + low[2], low[1] + low[3], high[0] + high[2], high[1] + high[3]};
}

}  // namespace

template <bool slopes>
LoadedLookup LoadedTable::found(double y, double z, double roll, double yaw, LoadedSlopes* derivatives) const noexcept {
  LoadedLookup result;
  double inside = margin_share(roll, yaw);
  if (!(inside > 0.0)) return result;
  const Weights weights(*this, roll, yaw);
  Cell cell;
  if (!find_lateral(y, weights, cell)) return result;
  const double y0 = data_.lateral[cell.lateral] + cell.t * cell.width;
  const double lateral_range = data_.lateral.back() - data_.lateral.front();
  inside *= smooth_step(std::min(y0 - data_.lateral.front(), data_.lateral.back() - y0) / (border * lateral_range));
  if (!(inside > 0.0)) return result;
  find_level(z, weights, cell);
  if (cell.level < 0) {
    result.table_share = inside;
    return result;
  }

  const HermiteBasis& t = cell.across;
  Corners corners;
  const auto& corner = corners.of;
  std::array<double, 4> line;
  for (int moved = 0;;) {
    add_corners<slopes>(cell, weights, corners);
    line = across_at(corner, t.value, here);
    if (z < line[0] && cell.level > 0 && moved <= 0) {
      moved = -1;
      --cell.level;
    } else if (z >= line[2] && moved >= 0) {
      if (cell.level == data_.levels - 2) return result;
      moved = 1;
      ++cell.level;
    } else {
      break;
    }
  }
  fetch_parts(cell, roll, yaw);
  constexpr std::size_t packs = slopes ? 2 : 1;
  Pack shift[4][2]{};  // over the directions: y and ∂y/∂y0 of the lower lateral node, then of the upper one
  for (std::size_t lateral = 0; lateral < 2; ++lateral) {
    const double* const place = &data_.shift[2 * (cell.lateral + lateral) * weights.columns];
    for (std::size_t k = 0; k < weights.columns; ++k) {
      for (std::size_t q = 0; q < packs; ++q) {
        shift[2 * lateral][q] += place[2 * k] * weights.column[k][q];
        shift[2 * lateral + 1][q] += place[2 * k + 1] * weights.column[k][q];
      }
    }
  }
  const auto& sum = HermiteBasis::sum;
  // The level: the root of a cubic that grows from z or less to z or more.
  double low = 0.0, high = 1.0, u = (z - line[0]) / (line[2] - line[0]);
  if (cell.level == 0) u = std::sqrt(std::max(0.0, u));
  constexpr double rounding = 1e-13, root = 1e-8;  // of a place; Newton's next correction is less than its square
  for (int iteration = 0; iteration < 60; ++iteration) {
    const HermiteBasis basis(u, level_step_);
    const double excess = sum(basis.value, line) - z, slope = sum(basis.first, line) * level_step_;
    (excess > 0.0 ? high : low) = u;
    double next = u - excess / slope;
    const bool within = next >= low && next <= high;
    if (!within) next = 0.5 * (low + high);
    const double change = std::abs(next - u);
    u = next;
    if (change < rounding || (within && change < root * u)) break;
  }
  cell.u = u;
  const double w = (cell.level + u) * level_step_;
  inside *= smooth_step((data_.levels - 1 - (cell.level + u)) / (border * (data_.levels - 1)));
  const HermiteBasis level(u, level_step_);

  // y0(y, roll, yaw), then w(y, z, roll, yaw) from Z(w, y0(y, roll, yaw), roll, yaw) = z.
  const auto along = [&](const std::array<double, 4>& basis, Direction d) {
    return sum(basis, {shift[0][d / 4][d % 4], shift[1][d / 4][d % 4], shift[2][d / 4][d % 4], shift[3][d / 4][d % 4]});
  };
  const double Y_y0 = along(t.first, here), Z_w = sum(level.first, line);
  if (!(Z_w > 0.0)) return result;
  const std::array<double, 4> line_y = across_at(corner, t.first, here);
  const std::array<double, 4> line_r = across_at(corner, t.value, by_roll), line_s = across_at(corner, t.value, by_yaw);
  const double Z_y = sum(level.value, line_y);
  const Eigen::Vector4d y0_1(1.0 / Y_y0, 0.0, -along(t.value, by_roll) / Y_y0, -along(t.value, by_yaw) / Y_y0);
  const Eigen::Vector4d Z_1 =
      Eigen::Vector4d(0.0, -1.0, sum(level.value, line_r), sum(level.value, line_s)) + Z_y * y0_1;
  const Eigen::Vector4d w_1 = -Z_1 / Z_w;
  const double w3 = w * w * w;
  result.table_share = inside;
  result.energy = w3 * w * w;
  result.force = 5.0 * w3 * w * w_1;
  if constexpr (slopes) {
    const auto Z = [&](const std::array<double, 4>& at_w, const std::array<double, 4>& at_y, Direction d) {
      return sum(at_w, across_at(corner, at_y, d));
    };
    const auto symmetric = [](const Eigen::Vector4d& a, const Eigen::Vector4d& b) {
      return Eigen::Matrix4d(a * b.transpose() + b * a.transpose());
    };
    Eigen::Matrix4d Y_2 = Eigen::Matrix4d::Zero(), Z_2 = Eigen::Matrix4d::Zero();
    Y_2.bottomRightCorner<2, 2>() << along(t.value, by_roll_roll), along(t.value, by_roll_yaw),
        along(t.value, by_roll_yaw), along(t.value, by_yaw_yaw);
    const Eigen::Vector4d Y_y1(0.0, 0.0, along(t.first, by_roll), along(t.first, by_yaw));
    const Eigen::Matrix4d y0_2 =
        -(Y_2 + symmetric(Y_y1, y0_1) + along(t.second, here) * y0_1 * y0_1.transpose()) / Y_y0;
    Z_2(2, 2) = Z(level.value, t.value, by_roll_roll);
    Z_2(2, 3) = Z_2(3, 2) = Z(level.value, t.value, by_roll_yaw);
    Z_2(3, 3) = Z(level.value, t.value, by_yaw_yaw);
    const Eigen::Vector4d Z_y1(0.0, 0.0, Z(level.value, t.first, by_roll), Z(level.value, t.first, by_yaw));
    Z_2 += symmetric(Z_y1, y0_1) + Z(level.value, t.second, here) * y0_1 * y0_1.transpose() + Z_y * y0_2;
    const Eigen::Vector4d Z_w1 =
        Eigen::Vector4d(0.0, 0.0, sum(level.first, line_r), sum(level.first, line_s)) + sum(level.first, line_y) * y0_1;
    const Eigen::Matrix4d w_2 = -(Z_2 + symmetric(Z_w1, w_1) + sum(level.second, line) * w_1 * w_1.transpose()) / Z_w;
    derivatives->stiffness = 5.0 * w3 * (4.0 * w_1 * w_1.transpose() + w * w_2);
  }
  add_parts<slopes>(cell, {w, w_1, y0_1}, roll, yaw, result, derivatives);
  return result;
}

template LoadedLookup LoadedTable::found<false>(double, double, double, double, LoadedSlopes*) const noexcept;
template LoadedLookup LoadedTable::found<true>(double, double, double, double, LoadedSlopes*) const noexcept;

}  // namespace railtab
