#include "railtab/tables/geometry_table.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "railtab/tables/input_error.hpp"

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
        (!axis.fixed() || axis.cells == 1))) {
    throw input_error(fmt::format("axis {}", name), fmt::format("{}..{} in {} cells", axis.low, axis.high, axis.cells),
                      "low..high in cells");
  }
}

/// Every node below a root is the child of one node, and comes after it; every leaf is named once, in order.
void check_tree(const GeometryTableData& data, std::size_t roots) {
  std::size_t next_child = roots;
  std::size_t leaves = 0;
  std::vector<bool> named(data.node.size(), false);
  for (std::size_t n = 0; n < data.node.size(); ++n) {
    const std::uint32_t code = data.node[n];
    const std::size_t index = CellNode::index(code);
    if (CellNode::is_leaf(code)) {
      leaves = std::max(leaves, index + 1);
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
    return Axis{a.low, a.fixed() ? 0.0 : a.cells / (a.high - a.low), static_cast<double>(a.cells)};
  };
  axis_ = {axis(data_.lateral), axis(data_.yaw_squared), axis(data_.roll)};
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
}

namespace {

using Row = Eigen::Array4f;  // z_touch, s_wheel, s_rail, n_y n_z

/// The polynomials of a branch at one (b, c), by powers of a.
struct AlongLateral {
  Row r0, r1, r2, r3;
  /// Not Horner's order: two products side by side.
  [[nodiscard]] Row at(float a) const noexcept { return (r0 + a * r1) + (a * a) * (r2 + a * r3); }
};

template <int terms>
AlongLateral along_lateral(const float* coefficient, float b, float c) noexcept {
  const auto row = [&](int n) { return Eigen::Map<const Row, Eigen::Aligned16>(coefficient + branch_quantities * n); };
  if constexpr (terms == 4) return {row(0), row(1), row(2), row(3)};
  AlongLateral p{row(0) + b * (row(1) + b * row(2)), row(3) + b * row(4), row(5) + b * row(6), row(7)};
  if constexpr (terms == 12) {
    p.r0 += c * (row(8) + c * row(9) + b * row(10));
    p.r1 += c * row(11);
  }
  return p;
}

template <int terms>
void evaluate_branches(const float* coefficient, int count, const LocalPoint& p, double inverse_half_width, double z,
                       GeometryTable::Lookup& result) noexcept {
  result.count = count;
  const auto height = static_cast<float>(z);
  const auto per_metre = static_cast<float>(inverse_half_width);
  float first = std::numeric_limits<float>::infinity();
  for (int n = 0; n < count; ++n) {
    const AlongLateral branch = along_lateral<terms>(coefficient + n * terms * branch_quantities, p.b, p.c);
    const Row touch = branch.at(p.a);
    const float shift = std::max(height - touch[0], 0.0F) * (touch[3] * per_metre);
    const Row pair = branch.at(p.a - shift);
    result.branch[static_cast<std::size_t>(n)] = {static_cast<double>(touch[0]), static_cast<double>(pair[1]),
                                                  static_cast<double>(pair[2])};
    first = std::min(first, touch[0]);
  }
  result.first_touch = static_cast<double>(first);
}

}  // namespace

void GeometryTable::evaluate(const float* coefficient, int count, bool yaw_axis, bool roll_axis,
                             const LocalPoint& point, double inverse_half_width, double z, Lookup& result) noexcept {
  const LocalPoint p = yaw_axis ? point : LocalPoint{point.a, point.c, 0.0F};
  switch (branch_terms(yaw_axis, roll_axis)) {
    case 4:
      return evaluate_branches<4>(coefficient, count, p, inverse_half_width, z, result);
    case 8:
      return evaluate_branches<8>(coefficient, count, p, inverse_half_width, z, result);
    default:
      return evaluate_branches<12>(coefficient, count, p, inverse_half_width, z, result);
  }
}

/// The leaf below a halved root cell. @param fraction of the root cell's width along each axis, 0..1
GeometryTable::Leaf GeometryTable::descend(Node node, const std::array<double, 3>& fraction) const noexcept {
  std::array<std::uint32_t, 3> rest{};  // in units of 2^-32 of the cell's width
  for (std::size_t a = 0; a < 3; ++a) rest[a] = static_cast<std::uint32_t>(std::min(fraction[a] * 0x1p32, 0x1p32 - 1));
  double inverse_half_width = 2.0 * axis_[0].inverse_width;
  while (!CellNode::is_leaf(node.code)) {
    const std::uint32_t axis = CellNode::axis(node.code);
    const std::uint32_t upper = rest[axis] >> 31;
    rest[axis] <<= 1;
    if (axis == 0) inverse_half_width *= 2.0;
    node = node_[CellNode::index(node.code) + upper];
  }
  const auto local = [](std::uint32_t f) { return static_cast<float>(static_cast<double>(f) * 0x1p-31 - 1.0); };
  return {node, {local(rest[0]), local(rest[1]), local(rest[2])}, inverse_half_width};
}

/// Most leaves are whole root cells: the way to them has no loop, and nothing is computed for an axis that is fixed.
template <bool yaw_axis, bool roll_axis>
void GeometryTable::lookup(double y, double z, double yaw, double roll, Lookup& result) const noexcept {
  const double lateral = (y - data_.nominal_radius * roll - axis_[0].low) * axis_[0].inverse_width;
  const double squared = (yaw * yaw - axis_[1].low) * axis_[1].inverse_width;
  const double rolled = (roll - axis_[2].low) * axis_[2].inverse_width;
  // On a fixed axis it is the yaw, not its square, that has to agree. NaN is outside.
  const bool inside = lateral >= 0 && lateral <= axis_[0].cells &&
                      (yaw_axis ? squared >= 0 && squared <= axis_[1].cells
                                : std::abs(std::abs(yaw) - std::sqrt(axis_[1].low)) <= 1e-12) &&
                      (roll_axis ? rolled >= 0 && rolled <= axis_[2].cells : std::abs(roll - axis_[2].low) <= 1e-12);
  if (!inside) return;
  result.status = Status::inside;
  const auto whole = [&](std::size_t axis, double at) { return std::min(std::floor(at), axis_[axis].cells - 1); };
  const double cell_0 = whole(0, lateral);
  const double cell_1 = yaw_axis ? whole(1, squared) : 0.0;
  const double cell_2 = roll_axis ? whole(2, rolled) : 0.0;
  const auto root =
      static_cast<std::size_t>(static_cast<std::int64_t>((cell_2 * axis_[1].cells + cell_1) * axis_[0].cells + cell_0));
  const std::array<double, 3> fraction{lateral - cell_0, squared - cell_1, rolled - cell_2};
  const auto local = [](double f) { return static_cast<float>(2.0 * f - 1.0); };
  Leaf leaf{node_[root], {local(fraction[0]), local(fraction[1]), local(fraction[2])}, 2.0 * axis_[0].inverse_width};
  if (!CellNode::is_leaf(leaf.node.code)) leaf = descend(leaf.node, fraction);
  result.trusted_lowering = static_cast<double>(leaf.node.trusted_lowering);
  constexpr int terms = branch_terms(yaw_axis, roll_axis);
  const std::uint32_t packed = CellNode::index(leaf.node.code);
  const float* coefficient = line_[static_cast<std::size_t>(packed >> 4) * (terms / 4)].value.data();
  if constexpr (!yaw_axis) leaf.point.b = leaf.point.c;
  evaluate_branches<terms>(coefficient, static_cast<int>(packed & 15U), leaf.point, leaf.inverse_half_width, z, result);
}

GeometryTable::Lookup GeometryTable::lookup(double y, double z, double yaw, double roll) const noexcept {
  Lookup result;
  const bool yaw_axis = !data_.yaw_squared.fixed();
  const bool roll_axis = !data_.roll.fixed();
  if (yaw_axis && !roll_axis) {
    lookup<true, false>(y, z, yaw, roll, result);
  } else if (yaw_axis) {
    lookup<true, true>(y, z, yaw, roll, result);
  } else if (roll_axis) {
    lookup<false, true>(y, z, yaw, roll, result);
  } else {
    lookup<false, false>(y, z, yaw, roll, result);
  }
  return result;
}

std::size_t GeometryTable::bytes() const noexcept { return node_.size() * sizeof(Node) + line_.size() * sizeof(Line); }

}  // namespace railtab
