#include "railtab/tables/loaded_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/pack.hpp"
#include "railtab/tables/loaded_table_sums.hpp"

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

std::vector<double> inverse_distances(const std::vector<double>& node) {
  std::vector<double> inverse;
  for (const double a : node)
    for (const double b : node) inverse.push_back(a == b ? 0.0 : 1.0 / (a - b));
  return inverse;
}

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

}  // namespace railtab
