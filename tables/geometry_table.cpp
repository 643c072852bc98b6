#include "railtab/tables/geometry_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

std::pair<std::int64_t, std::int64_t> root_range(const TableShard& shard, std::int64_t roots) noexcept {
  return {roots * (shard.index - 1) / shard.count, roots * shard.index / shard.count};
}

std::int64_t root_cells(const GeometryTableData& data) noexcept {
  return static_cast<std::int64_t>(data.lateral.cells) * data.yaw_squared.cells * data.roll.cells;
}

std::array<double, most_branch_terms> branch_monomials(bool yaw_axis, bool roll_axis, double a, double b,
                                                       double c) noexcept {
  if (!yaw_axis && !roll_axis) return {1, a, a * a, a * a * a};
  if (!yaw_axis) b = c;
  return {1, b, b * b, a, a * b, a * a, a * a * b, a * a * a, c, c * c, b * c, a * c};
}

namespace {

void check_axis(const TableAxis& axis, std::string_view name) {
  if (!(std::isfinite(axis.low) && std::isfinite(axis.high) && axis.low <= axis.high && axis.cells >= 1 &&
        axis.cells <= most_axis_cells && (!axis.fixed() || axis.cells == 1))) {
    throw input_error(fmt::format("axis {}", name), fmt::format("{}..{} in {} cells", axis.low, axis.high, axis.cells),
                      "low..high in cells");
  }
}

/// Every node below a root is the child of one node, and comes after it; every leaf is named once.
void check_tree(const GeometryTableData& data, std::size_t roots) {
  std::size_t next_child = roots;
  std::size_t leaves = 0;
  std::vector<bool> named(data.node.size(), false), leaf_named(data.leaf_branch.size(), false);
  for (std::size_t n = 0; n < data.node.size(); ++n) {
    const std::uint32_t code = data.node[n];
    const std::size_t index = CellNode::index(code);
    if (CellNode::is_leaf(code)) {
      if (index >= leaf_named.size() || leaf_named[index]) {
        throw input_error(fmt::format("node {}", n), fmt::format("leaf {}", index),
                          fmt::format("one of {} leaves that belongs to no other node", leaf_named.size()));
      }
      leaf_named[index] = true;
      ++leaves;
      continue;
    }
    if (index <= n || index < roots || index + 1 >= data.node.size() || named[index]) {
      throw input_error(fmt::format("node {}", n), fmt::format("halves at node {}", index),
                        "two nodes behind it that belong to no other");
    }
    named[index] = named[index + 1] = true;
    next_child += 2;
  }
  if (next_child != data.node.size() || leaves != data.leaf_branch.size()) {
    throw input_error("nodes", fmt::format("{} nodes and {} leaves", data.node.size(), leaves),
                      fmt::format("{} and {}", next_child, data.leaf_branch.size()));
  }
}

void check(const GeometryTableData& data) {
  check_axis(data.lateral, "lateral");
  check_axis(data.yaw_squared, "yaw squared");
  check_axis(data.roll, "roll");
  if (data.lateral.fixed()) throw input_error("axis lateral", "one value", "low below high");
  if (data.yaw_squared.low < 0) throw input_error("axis yaw squared", "a negative value", "squares");
  if (!data.shard.whole()) {
    throw input_error("geometry table", fmt::format("part {} of {}", data.shard.index, data.shard.count),
                      "a whole table: merge the parts first");
  }
  const auto roots = static_cast<std::size_t>(root_cells(data));
  if (data.node.size() < roots) {
    throw input_error("nodes", fmt::format("{}", data.node.size()), fmt::format("at least {}, one per cell", roots));
  }
  check_tree(data, roots);
  const int terms = branch_terms(!data.yaw_squared.fixed(), !data.roll.fixed());
  std::size_t branches = 0;
  for (std::size_t n = 0; n < data.leaf_branch.size(); ++n) {
    if (data.leaf_branch[n] > GeometryTable::max_branches) {
      throw input_error(fmt::format("leaf {}", n), fmt::format("{} branches", data.leaf_branch[n]),
                        fmt::format("at most {}", GeometryTable::max_branches));
    }
    branches += data.leaf_branch[n];
  }
  if (data.trusted_lowering.size() != data.leaf_branch.size()) {
    throw input_error("trusted_lowering", fmt::format("{} values", data.trusted_lowering.size()),
                      fmt::format("{}, one per leaf", data.leaf_branch.size()));
  }
  for (std::size_t n = 0; n < data.trusted_lowering.size(); ++n) {
    if (!(data.trusted_lowering[n] >= 0)) {
      throw input_error(fmt::format("trusted_lowering, leaf {}", n), fmt::format("{}", data.trusted_lowering[n]),
                        "a height");
    }
  }
  const std::size_t expected = branches * static_cast<std::size_t>(terms * branch_quantities);
  if (data.coefficient.size() != expected || branches >= (1U << 26)) {
    throw input_error("coefficients", fmt::format("{}", data.coefficient.size()),
                      fmt::format("{} of {} branches", expected, branches));
  }
  for (std::size_t n = 0; n < data.coefficient.size(); ++n) {
    if (!std::isfinite(data.coefficient[n])) {
      throw input_error(fmt::format("coefficient {}", n), fmt::format("{}", data.coefficient[n]), "a finite number");
    }
  }
}

}  // namespace

GeometryTable::GeometryTable(GeometryTableData data) : data_(std::move(data)) {
  check(data_);
  terms_ = branch_terms(!data_.yaw_squared.fixed(), !data_.roll.fixed());
  const auto axis = [](const TableAxis& a) {
    return Axis{a.low, a.fixed() ? 0.0 : a.cells / (a.high - a.low), a.cells, a.fixed()};
  };
  axis_ = {axis(data_.lateral), axis(data_.yaw_squared), axis(data_.roll)};
  fixed_yaw_ = std::sqrt(data_.yaw_squared.low);
  pack();
}

void GeometryTable::pack() {
  std::vector<std::uint32_t> first(data_.leaf_branch.size());
  std::uint32_t next = 0;
  for (std::size_t n = 0; n < first.size(); ++n) {
    first[n] = next;
    next += data_.leaf_branch[n];
  }
  node_.reserve(data_.node.size());
  for (const std::uint32_t code : data_.node) {
    if (!CellNode::is_leaf(code)) {
      node_.push_back({code, 0.0F});
      continue;
    }
    const std::uint32_t leaf = CellNode::index(code);
    node_.push_back({CellNode::leaf(first[leaf] << 4 | data_.leaf_branch[leaf]), data_.trusted_lowering[leaf]});
  }
  line_.resize(data_.coefficient.size() / 16);
  for (std::size_t n = 0; n < data_.coefficient.size(); ++n) line_[n / 16].value[n % 16] = data_.coefficient[n];
  data_.coefficient = std::vector<float>();  // `= {}` would keep the memory
}

/// The leaf below a halved root cell.
/// @param lateral, squared, rolled place in the root cell, 0..1 of its width
GeometryTable::Place GeometryTable::descend(Node root, double lateral, double squared, double rolled) const noexcept {
  // In units of 2^-32 of the cell's width.
  const auto bits = [](double part) { return static_cast<std::uint32_t>(std::min(part * 0x1p32, 0x1p32 - 1)); };
  std::array<std::uint32_t, 3> rest{bits(lateral), bits(squared), bits(rolled)};
  Place place{root, {}, static_cast<float>(2.0 * axis_[0].inverse_width)};
  while (!CellNode::is_leaf(place.node.code)) {
    const std::uint32_t axis = CellNode::axis(place.node.code);
    const std::uint32_t upper = rest[axis] >> 31;
    rest[axis] <<= 1;
    if (axis == 0) place.per_metre *= 2.0F;
    place.node = node_[CellNode::index(place.node.code) + upper];
  }
  const auto local = [](std::uint32_t f) { return static_cast<float>(static_cast<double>(f) * 0x1p-31 - 1.0); };
  place.point = {local(rest[0]), local(rest[1]), local(rest[2])};
  return place;
}

GeometryTable::Lookup GeometryTable::lookup(double y, double z, double yaw, double roll) const noexcept {
  const GeometryLeaf leaf = this->leaf(y, yaw, roll);
  Lookup result;
  if (!leaf.inside) return result;
  result.status = Status::inside;
  result.count = leaf.count;
  result.trusted_lowering = static_cast<double>(leaf.trusted_lowering);
  result.first_touch = std::numeric_limits<double>::infinity();
  for (int n = 0; n < leaf.count; ++n) {
    const BranchStart start = leaf.start(n, z);
    result.branch[static_cast<std::size_t>(n)] = start;
    result.first_touch = std::min(result.first_touch, start.z_touch);
  }
  return result;
}

std::span<const float> GeometryTable::coefficients() const noexcept {
  static_assert(sizeof(Line) == sizeof(Line::value), "lines stand without gaps");
  return {reinterpret_cast<const float*>(line_.data()), 16 * line_.size()};
}

std::size_t GeometryTable::bytes() const noexcept { return node_.size() * sizeof(Node) + line_.size() * sizeof(Line); }

std::size_t GeometryTable::bytes_of(const GeometryTableData& data) noexcept {
  const std::size_t branches = std::accumulate(data.leaf_branch.begin(), data.leaf_branch.end(), std::size_t{0});
  const int numbers = branch_terms(!data.yaw_squared.fixed(), !data.roll.fixed()) * branch_quantities;
  return data.node.size() * sizeof(Node) + branches * static_cast<std::size_t>(numbers) * sizeof(float);
}

}  // namespace railtab
