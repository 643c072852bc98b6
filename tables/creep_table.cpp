#include "railtab/tables/creep_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tables/creep_coordinates.hpp"
#include "railtab/tables/creep_spline.hpp"
#include "railtab/tables/grid_axis.hpp"

namespace railtab {

namespace {

constexpr std::array<std::string_view, 4> smooth_axes{"ratio", "t", "alpha", "beta"};
constexpr std::array<std::string_view, 4> paper_axes{"ratio", "x", "y", "spin"};

/// @throws InputError where the nodes are not n uniform steps from `first` to `last`, in the variable `of` the node.
template <typename Of>
void require_uniform(std::string_view axis, const std::vector<double>& nodes, double first, double last, const Of& of) {
  const double step = (last - first) / static_cast<double>(nodes.size() - 1);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double expected = first + step * static_cast<double>(i);
    if (!(std::abs(of(nodes[i]) - expected) < 1e-9 * step)) {
      throw input_error(fmt::format("creep table: axis {}, node {}", axis, i), fmt::format("{}", nodes[i]),
                        "nodes of equal steps in the axis' variable");
    }
  }
}

void require_smooth_layout(const CreepTableData& data) {
  using std::numbers::pi;
  for (std::size_t i = 0; i < 4; ++i) {
    if (data.nodes[i].size() < 5) {
      throw input_error(fmt::format("creep table: axis {}", smooth_axes[i]),
                        fmt::format("{} nodes", data.nodes[i].size()), "at least 5");
    }
  }
  if (!(data.ratio_stretch > 0.0 && std::isfinite(data.ratio_stretch) && data.radius_unit > 0.0 &&
        std::isfinite(data.radius_unit) && data.nodes[0].front() > 0.0)) {
    throw input_error("creep table: ratio_stretch, radius_unit and a/b",
                      fmt::format("{}, {}, {}", data.ratio_stretch, data.radius_unit, data.nodes[0].front()),
                      "positive numbers");
  }
  if (!(data.nodes[0].front() >= CreepSpline::least_ratio && data.nodes[0].back() < CreepSpline::ratio_end)) {
    throw input_error("creep table: axis ratio", fmt::format("{} to {}", data.nodes[0].front(), data.nodes[0].back()),
                      fmt::format("a/b from {} to below {}", CreepSpline::least_ratio, CreepSpline::ratio_end));
  }
  const auto same = [](double v) { return v; };
  const auto squeezed = [&](double v) { return squeezed_ratio(v, data.ratio_stretch); };
  require_uniform(smooth_axes[0], data.nodes[0], squeezed(data.nodes[0].front()), squeezed(data.nodes[0].back()),
                  squeezed);
  require_uniform(smooth_axes[1], data.nodes[1], 0.0, 1.0, same);
  require_uniform(smooth_axes[2], data.nodes[2], 0.0, 0.5 * pi, same);
  const double beta_nodes = static_cast<double>(data.nodes[3].size());
  require_uniform(smooth_axes[3], data.nodes[3], 0.0, pi * (beta_nodes - 1.0) / beta_nodes, same);
}

/// Multilinear interpolation between the 16 corners of a cell; υx and υy folded into their positive halves.
CreepLookup linear_lookup(const std::vector<GridAxis>& axes, const std::vector<double>& values, double ratio,
                          const std::array<double, 3>& creepage) noexcept {
  CreepLookup result;
  // υx -> -υx turns F_x; (υy, φ) -> -(υy, φ) turns F_y and M_z.
  const double sign_x = creepage[0] < 0.0 ? -1.0 : 1.0, sign_y = creepage[1] < 0.0 ? -1.0 : 1.0;
  const std::array<double, 4> query{ratio, sign_x * creepage[0], sign_y * creepage[1], sign_y * creepage[2]};
  std::array<GridAxis::Cell, 4> cell;
  for (std::size_t i = 0; i < 4; ++i) {
    cell[i] = axes[i].locate(query[i]);
    if (!cell[i].inside) return result;
  }
  const std::array<double, 3> sign{sign_x, sign_y, sign_y};
  for (std::size_t corner = 0; corner < 16; ++corner) {
    std::array<double, 4> weight, slope;
    std::size_t node = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t upper = corner >> i & 1U;
      node = node * static_cast<std::size_t>(axes[i].size()) + static_cast<std::size_t>(cell[i].index) + upper;
      weight[i] = upper ? cell[i].fraction : 1.0 - cell[i].fraction;
      slope[i] = (upper ? 1.0 : -1.0) / cell[i].width;
    }
    const std::array<double, 4> product{
        weight[0] * weight[1] * weight[2] * weight[3], weight[0] * slope[1] * weight[2] * weight[3],
        weight[0] * weight[1] * slope[2] * weight[3], weight[0] * weight[1] * weight[2] * slope[3]};
    const double along_ratio = slope[0] * weight[1] * weight[2] * weight[3];
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = sign[c] * values[3 * node + c];
      result.force[c] += product[0] * value;
      result.by_ratio[c] += along_ratio * value;
      for (std::size_t j = 0; j < 3; ++j) result.derivative[c][j] += sign[j] * product[j + 1] * value;
    }
  }
  result.inside = true;
  return result;
}

}  // namespace

std::string_view creep_table_layout_name(CreepTableLayout layout) noexcept {
  return layout == CreepTableLayout::smooth ? "default" : "paper";
}

CreepTableLayout creep_table_layout(std::string_view name) {
  if (name == "default") return CreepTableLayout::smooth;
  if (name == "paper") return CreepTableLayout::paper;
  throw input_error("creep table layout", fmt::format("\"{}\"", name), "default or paper");
}

CreepTable::CreepTable(CreepTableData data) : data_(std::move(data)) {
  const bool smooth = data_.layout == CreepTableLayout::smooth;
  std::size_t nodes = 1;
  for (std::size_t i = 0; i < 4; ++i) {
    axes_.emplace_back(fmt::format("{}", (smooth ? smooth_axes : paper_axes)[i]), data_.nodes[i]);
    nodes *= data_.nodes[i].size();
  }
  if (data_.values.size() != 3 * nodes) {
    throw input_error("creep table: values", fmt::format("{}", data_.values.size()), fmt::format("{}", 3 * nodes));
  }
  if (!std::all_of(data_.values.begin(), data_.values.end(), [](double v) { return std::isfinite(v); })) {
    throw input_error("creep table: values", "one that is not finite", "finite numbers");
  }
  if (!smooth) {
    for (std::size_t i = 0; i < 4; ++i) {
      if (data_.nodes[i].size() >= 2) continue;
      throw input_error(fmt::format("creep table: axis {}", paper_axes[i]), "a single node", "at least 2");
    }
    return;
  }
  require_smooth_layout(data_);
  spline_ = std::make_unique<const CreepSpline>(data_);
  data_.values = std::vector<double>();  // `= {}` would keep the memory
  axes_.clear();
}

CreepTable::~CreepTable() = default;
CreepTable::CreepTable(CreepTable&&) noexcept = default;
CreepTable& CreepTable::operator=(CreepTable&&) noexcept = default;

CreepLookup CreepTable::lookup(double ratio, const std::array<double, 3>& creepage) const noexcept {
  return spline_ ? spline_->lookup(ratio, creepage) : linear_lookup(axes_, data_.values, ratio, creepage);
}

CreepLookup CreepTable::jet(double ratio, const std::array<double, 3>& creepage) const noexcept {
  return spline_ ? spline_->jet(ratio, creepage) : linear_lookup(axes_, data_.values, ratio, creepage);
}

std::array<double, 3> CreepTable::force(double ratio, const std::array<double, 3>& creepage) const noexcept {
  return spline_ ? spline_->force(ratio, creepage) : lookup(ratio, creepage).force;
}

std::array<WheelLanes, 3> CreepTable::force(const WheelLanes& ratio,
                                            const std::array<WheelLanes, 3>& creepage) const noexcept {
  return spline_ ? spline_->force(ratio, creepage) : jet(ratio, creepage).force;
}

CreepLookupOf<WheelLanes> CreepTable::jet(const WheelLanes& ratio,
                                          const std::array<WheelLanes, 3>& creepage) const noexcept {
  if (spline_) return spline_->jet(ratio, creepage);
  CreepLookupOf<WheelLanes> result;
  result.inside = true;
  for (int i = 0; i < WheelLanes::count; ++i) {
    const CreepLookup found = jet(ratio[i], {creepage[0][i], creepage[1][i], creepage[2][i]});
    for (std::size_t k = 0; k < 3; ++k) {
      result.force[k][i] = found.force[k];
      result.by_ratio[k][i] = found.by_ratio[k];
      for (std::size_t j = 0; j < 3; ++j) result.derivative[k][j][i] = found.derivative[k][j];
    }
  }
  return result;
}

std::size_t CreepTable::bytes() const noexcept {
  return spline_ ? spline_->bytes() : data_.values.size() * sizeof(double);
}

}  // namespace railtab
