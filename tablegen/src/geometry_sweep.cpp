#include "railtab/tablegen/geometry_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "railtab/tablegen/branch_tracking.hpp"
#include "railtab/tablegen/cell_check.hpp"
#include "railtab/tablegen/cell_trust.hpp"
#include "railtab/tablegen/search_windows.hpp"
#include "railtab/tables/input_error.hpp"

namespace railtab {

namespace {

void check_range(const char* name, double value, double low, double high) {
  if (!(value >= low && value <= high)) {
    throw input_error(fmt::format("geometry sweep: {}", name), fmt::format("{}", value),
                      fmt::format("a number in {}..{}", low, high));
  }
}

void check_interval(const char* name, const Interval& interval, double limit) {
  check_range(name, interval.low, -limit, limit);
  check_range(name, interval.high, -limit, limit);
  if (interval.low > interval.high) {
    throw input_error(fmt::format("geometry sweep: {}", name), fmt::format("{}:{}", interval.low, interval.high),
                      "low:high with low not above high");
  }
}

std::vector<double> uniform_nodes(double low, double high, int cells) {
  std::vector<double> nodes;
  for (int i = 0; i <= cells; ++i) nodes.push_back(i == cells ? high : low + (high - low) * i / cells);
  return nodes;
}

int cells_for(double length, double step) { return std::max(1, static_cast<int>(std::ceil(length / step - 1e-9))); }

/// The lateral axis is y - R0·roll: it reaches further than y by what the largest roll shears.
GeometryGrid make_grid(const GeometrySweepOptions& o, double nominal_radius) {
  GeometryGrid grid;
  const double low = o.lateral.low - nominal_radius * o.roll.high;
  const double high = o.lateral.high - nominal_radius * o.roll.low;
  grid.lateral = uniform_nodes(low, high, cells_for(high - low, o.lateral_step));
  const bool through_zero = o.yaw.low <= 0 && o.yaw.high >= 0;
  const double yaw_low = through_zero ? 0.0 : std::min(std::abs(o.yaw.low), std::abs(o.yaw.high));
  const double yaw_high = std::max(std::abs(o.yaw.low), std::abs(o.yaw.high));
  grid.yaw_squared = yaw_high > yaw_low ? uniform_nodes(yaw_low * yaw_low, yaw_high * yaw_high, o.yaw_nodes - 1)
                                        : std::vector<double>{yaw_low * yaw_low};
  grid.roll = o.roll.high > o.roll.low
                  ? uniform_nodes(o.roll.low, o.roll.high, cells_for(o.roll.high - o.roll.low, o.roll_step))
                  : std::vector<double>{o.roll.low};
  return grid;
}

/// All minima at all nodes.
std::vector<std::vector<BranchPoint>> search_nodes(const ContactSearch& search, const GeometryGrid& grid,
                                                   const GeometrySweepOptions& options, const Progress& progress) {
  const std::array<int, 3> n = grid.nodes();
  const int total = n[0] * n[1] * n[2];
  const double radius = search.pair().nominal_radius();
  std::vector<std::vector<BranchPoint>> nodes(static_cast<std::size_t>(total));
  std::atomic<int> done = 0;
#pragma omp parallel for schedule(dynamic, 64)
  for (int m = 0; m < total; ++m) {
    const double roll = grid.roll[static_cast<std::size_t>(m / (n[0] * n[1]))];
    const double yaw = std::sqrt(grid.yaw_squared[static_cast<std::size_t>(m / n[0] % n[1])]);
    const double y = grid.lateral[static_cast<std::size_t>(m % n[0])] + radius * roll;
    for (const TouchPoint& t : search.touches(y, roll, yaw, options.branch_height)) {
      nodes[static_cast<std::size_t>(m)].push_back(
          {t.z_touch, t.z_touch_dy, t.s_wheel, t.s_wheel_dy, t.s_rail, t.s_rail_dy});
    }
    const int count = ++done;
    if (progress && count % 64 == 0) {
#pragma omp critical(sweep_progress)
      progress(static_cast<double>(count) / total);
    }
  }
  return nodes;
}

}  // namespace

void GeometrySweepOptions::validate() const {
  check_interval("lateral [m]", lateral, 0.1);
  check_interval("yaw [rad]", yaw, 0.2);
  check_interval("roll [rad]", roll, 0.1);
  if (!(lateral.low < lateral.high)) {
    throw input_error("geometry sweep: lateral [m]", fmt::format("{}:{}", lateral.low, lateral.high),
                      "low:high with low below high");
  }
  check_range("lateral step [m]", lateral_step, 1e-6, 1e-3);
  check_range("yaw nodes", yaw_nodes, 2, 1000);
  check_range("roll step [rad]", roll_step, 1e-5, 0.05);
  check_range("branch height [m]", branch_height, 1e-6, 0.1);
  check_range("searched lowering [m]", searched_lowering, 1e-6, branch_height);
  check_range("tolerance [m]", tolerance, 1e-12, 1e-3);
}

GeometryTableData sweep_geometry(const ContactSearch& search, const GeometrySweepOptions& options,
                                 const Progress& progress) {
  options.validate();
  const GeometryGrid grid = make_grid(options, search.pair().nominal_radius());
  const std::vector<std::vector<BranchPoint>> nodes = search_nodes(search, grid, options, progress);

  const WheelRailPair& pair = search.pair();
  GeometryTableData table;
  table.wheel = pair.wheel().knots();
  table.rail = pair.rail().knots();
  table.track_gauge = pair.dimensions().track_gauge;
  table.gauge_height = pair.dimensions().gauge_height;
  table.flange_back = pair.dimensions().flange_back;
  table.nominal_radius = pair.nominal_radius();
  table.lateral = grid.lateral;
  table.yaw_squared = grid.yaw_squared;
  table.roll = grid.roll;
  table.tolerance = options.tolerance;
  table.branches = track_branches(grid, nodes);
  if (table.branches.empty()) {
    throw ComputationError("geometry sweep: the wheel does not meet the rail anywhere in the range");
  }
  table.trusted_lowering = trusted_lowering(grid, table.branches);
  limit_wrong_cells(search, options.branch_height, table);
  set_search_windows(options.searched_lowering, table);
  table.statistics = {{"option.lateral_low", options.lateral.low},
                      {"option.lateral_high", options.lateral.high},
                      {"option.yaw_low", options.yaw.low},
                      {"option.yaw_high", options.yaw.high},
                      {"option.roll_low", options.roll.low},
                      {"option.roll_high", options.roll.high},
                      {"option.lateral_step", options.lateral_step},
                      {"option.yaw_nodes", static_cast<double>(options.yaw_nodes)},
                      {"option.roll_step", options.roll_step},
                      {"option.branch_height", options.branch_height},
                      {"option.searched_lowering", options.searched_lowering}};
  return table;
}

}  // namespace railtab
