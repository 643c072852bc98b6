#include "railtab/tablegen/geometry_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tablegen/cell_refinement.hpp"
#include "railtab/tablegen/geometry_parts.hpp"
#include "railtab/tablegen/parallel_failure.hpp"

namespace railtab {

namespace {

void check_range(const char* name, double value, double low, double high) {
  if (!(value >= low && value <= high)) {
    throw input_error(name, fmt::format("{}", value), fmt::format("a number in {}..{}", low, high));
  }
}

void check_interval(const char* name, const Interval& interval, double limit) {
  check_range(name, interval.low, -limit, limit);
  check_range(name, interval.high, -limit, limit);
  if (interval.low > interval.high) {
    throw input_error(name, fmt::format("{}:{}", interval.low, interval.high), "LO:HI with LO not above HI");
  }
}

int cells_for(double length, double step) { return std::max(1, static_cast<int>(std::ceil(length / step - 1e-9))); }

void set_axes(const GeometrySweepOptions& o, GeometryTableData& table) {
  // The lateral axis is y - R0·roll: it reaches further than y by what the largest roll shears.
  table.lateral.low = o.lateral.low - table.nominal_radius * o.roll.high;
  table.lateral.high = o.lateral.high - table.nominal_radius * o.roll.low;
  table.lateral.cells = cells_for(table.lateral.high - table.lateral.low, o.lateral_root);
  const Interval yaw = o.yaw_amounts();
  table.yaw_squared = {yaw.low * yaw.low, yaw.high * yaw.high, yaw.low < yaw.high ? o.yaw_roots : 1};
  table.roll = {o.roll.low, o.roll.high,
                o.roll.low < o.roll.high ? cells_for(o.roll.high - o.roll.low, o.roll_root) : 1};
}

std::vector<CellTree> make_trees(const ContactSearch& search, const GeometrySweepOptions& options,
                                 const GeometryTableData& table, const Progress& progress) {
  // Not a structured binding: OpenMP's threads cannot share one (clang 14 rejects it).
  const auto roots = root_range(options.shard, root_cells(table));
  const CellRefinement refinement(search, options);
  std::vector<CellTree> trees(static_cast<std::size_t>(roots.second - roots.first));
  std::size_t done = 0;
  ParallelFailure failure;
  std::mutex one_at_a_time;
#pragma omp parallel for schedule(dynamic, 4)
  for (std::size_t n = 0; n < trees.size(); ++n) {
    failure.guard([&] {
      trees[n] = refinement.tree(root_box(table, roots.first + static_cast<std::int64_t>(n)));
      const std::scoped_lock lock(one_at_a_time);
      if (++done % 4 == 0 && progress) progress(static_cast<double>(done) / static_cast<double>(trees.size()));
    });
  }
  failure.rethrow();
  return trees;
}

/// Root nodes first, then each tree's other nodes together.
void append_trees(const std::vector<CellTree>& trees, GeometryTableData& table) {
  table.node.resize(trees.size());
  for (std::size_t n = 0; n < trees.size(); ++n) {
    const CellTree& tree = trees[n];
    const std::size_t behind = table.node.size();
    const std::size_t leaves = table.leaf_branch.size();
    // The tree's root node 0 goes to place n, its node k > 0 to place behind + k - 1.
    const auto moved = [&](std::uint32_t code) {
      if (CellNode::is_leaf(code)) return CellNode::leaf(static_cast<std::uint32_t>(leaves) + CellNode::index(code));
      return CellNode::halved(CellNode::axis(code), static_cast<std::uint32_t>(behind) + CellNode::index(code) - 1);
    };
    if (behind + tree.node.size() > CellNode::most) throw ComputationError("geometry sweep: more than 2^30 cells");
    table.node[n] = moved(tree.node[0]);
    for (std::size_t k = 1; k < tree.node.size(); ++k) table.node.push_back(moved(tree.node[k]));
    const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    append(table.leaf_branch, tree.leaf_branch);
    append(table.trusted_lowering, tree.trusted_lowering);
    append(table.coefficient, tree.coefficient);
  }
}

}  // namespace

Interval GeometrySweepOptions::yaw_amounts() const noexcept {
  const auto [least, most] = std::minmax({std::abs(yaw.low), std::abs(yaw.high)});
  return {yaw.low <= 0.0 && yaw.high >= 0.0 ? 0.0 : least, most};
}

void GeometrySweepOptions::validate() const {
  check_interval("--lateral [m]", lateral, 0.1);
  check_interval("--yaw [rad]", yaw, 0.2);
  check_interval("--roll [rad]", roll, 0.1);
  if (!(lateral.low < lateral.high)) {
    throw input_error("--lateral [m]", fmt::format("{}:{}", lateral.low, lateral.high), "LO:HI with LO below HI");
  }
  check_range("geometry sweep: lateral root [m]", lateral_root, 1e-6, 1e-2);
  check_range("geometry sweep: yaw roots", yaw_roots, 1, 1000);
  check_range("geometry sweep: roll root [rad]", roll_root, 1e-5, 0.05);
  check_range("geometry sweep: searched lowering [m]", searched_lowering, 1e-6, 0.01);
  check_range("geometry sweep: start error [m]", start_error, 1e-9, 1e-3);
  check_range("geometry sweep: iterated cell", iterated_cell, 1e-12, 1);
  check_range("geometry sweep: fallback cell", fallback_cell, 1e-12, 1);
  check_range("--tolerance [m]", tolerance, 1e-12, 1e-3);
  if (!shard.valid()) {
    throw input_error("--shard", fmt::format("{}/{}", shard.index, shard.count),
                      fmt::format("I/N with I in 1..N, N at most {}", TableShard::most));
  }
}

CellBox root_box(const GeometryTableData& table, std::int64_t root) {
  CellBox box;
  const std::array<const TableAxis*, 3> axes{&table.lateral, &table.yaw_squared, &table.roll};
  for (std::size_t a = 0; a < 3; ++a) {
    const TableAxis& axis = *axes[a];
    const std::int64_t cell = root % axis.cells;
    root /= axis.cells;
    const double width = (axis.high - axis.low) / axis.cells;
    box.low[a] = axis.low + width * static_cast<double>(cell);
    box.high[a] = cell + 1 == axis.cells ? axis.high : axis.low + width * static_cast<double>(cell + 1);
  }
  return box;
}

WheelsetPose pose_in(const CellBox& box, const std::array<double, 3>& local, double radius) noexcept {
  WheelsetPose pose;
  pose.roll = box.at(2, local[2]);
  pose.yaw = std::sqrt(box.at(1, local[1]));
  pose.y = box.at(0, local[0]) + radius * pose.roll;
  return pose;
}

std::vector<TableLeaf> leaves_below(const GeometryTableData& table, std::int64_t root) {
  std::vector<TableLeaf> leaves;
  std::vector<std::pair<std::uint32_t, CellBox>> open{{static_cast<std::uint32_t>(root), root_box(table, root)}};
  while (!open.empty()) {
    const auto [node, box] = open.back();
    open.pop_back();
    const std::uint32_t code = table.node[node];
    if (CellNode::is_leaf(code)) {
      if (table.leaf_branch[CellNode::index(code)] > 0) leaves.push_back({box, CellNode::index(code)});
      continue;
    }
    const std::uint32_t axis = CellNode::axis(code), lower = CellNode::index(code);
    CellBox half = box;
    half.high[axis] = box.at(axis, 0.0);
    open.emplace_back(lower, half);
    half = box;
    half.low[axis] = box.at(axis, 0.0);
    open.emplace_back(lower + 1, half);
  }
  return leaves;
}

GeometryTableData geometry_heading(const ContactSearch& search, const GeometrySweepOptions& options) {
  options.validate();
  const WheelRailPair& pair = search.pair();
  GeometryTableData table;
  table.wheel = pair.wheel().knots();
  table.rail = pair.rail().knots();
  table.track_gauge = pair.dimensions().track_gauge;
  table.gauge_height = pair.dimensions().gauge_height;
  table.flange_back = pair.dimensions().flange_back;
  table.nominal_radius = pair.nominal_radius();
  table.tolerance = options.tolerance;
  table.shard = options.shard;
  set_axes(options, table);
  table.statistics = {{"option.lateral_low", options.lateral.low},
                      {"option.lateral_high", options.lateral.high},
                      {"option.yaw_low", options.yaw.low},
                      {"option.yaw_high", options.yaw.high},
                      {"option.roll_low", options.roll.low},
                      {"option.roll_high", options.roll.high},
                      {"option.searched_lowering", options.searched_lowering},
                      {"option.start_error", options.start_error},
                      {"option.iterated_cell", options.iterated_cell},
                      {"option.fallback_cell", options.fallback_cell}};
  return table;
}

GeometryTableData sweep_geometry(const ContactSearch& search, const GeometrySweepOptions& options,
                                 const Progress& progress) {
  GeometryTableData table = geometry_heading(search, options);
  if (root_cells(table) < options.shard.count) {
    throw input_error("--shard", fmt::format("{} parts", options.shard.count),
                      fmt::format("at most {}, one per root cell", root_cells(table)));
  }
  append_trees(make_trees(search, options, table, progress), table);
  if (options.shard.whole()) require_contact(table);
  return table;
}

void require_contact(const GeometryTableData& table) {
  if (!table.coefficient.empty()) return;
  throw InputError(
      "geometry table: the wheel does not meet the rail anywhere in the range; check the profile files (origin, side, "
      "units), --gauge, --flange-back and --lateral");
}

}  // namespace railtab
