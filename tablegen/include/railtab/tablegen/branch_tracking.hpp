#pragma once

#include <array>
#include <span>
#include <vector>

#include "railtab/tables/geometry_table.hpp"

namespace railtab {

/// One local minimum of the wheel-rail distance at one grid node; derivatives along the lateral axis.
struct BranchPoint {
  double z_touch, z_touch_dy;  ///< height at which this minimum touches [m], [-]
  double s_wheel, s_wheel_dy;  ///< [m], [-]
  double s_rail, s_rail_dy;    ///< [m], [-]
};

/// Axes of a table, as in GeometryTableData; node number = (roll · n_yaw + yaw) · n_lateral + lateral.
struct GeometryGrid {
  std::vector<double> lateral, yaw_squared, roll;

  [[nodiscard]] std::array<int, 3> nodes() const noexcept {
    return {static_cast<int>(lateral.size()), static_cast<int>(yaw_squared.size()), static_cast<int>(roll.size())};
  }
  /// Cells along each axis; an axis of one node counts as one cell.
  [[nodiscard]] std::array<int, 3> cells() const noexcept {
    const std::array<int, 3> n = nodes();
    return {n[0] > 1 ? n[0] - 1 : 1, n[1] > 1 ? n[1] - 1 : 1, n[2] > 1 ? n[2] - 1 : 1};
  }
  [[nodiscard]] std::size_t node(int i, int j, int k) const noexcept {
    return (static_cast<std::size_t>(k) * yaw_squared.size() + static_cast<std::size_t>(j)) * lateral.size() +
           static_cast<std::size_t>(i);
  }
};

/// Whether two points at lateral neighbours a distance h apart [m] can lie on one smooth branch: the arc lengths that
/// both predict half-way agree as far as a slope jump at a profile joint allows, and the rise of z_touch lies between
/// what the two slopes say.
[[nodiscard]] bool lateral_neighbours_agree(const BranchPoint& left, const BranchPoint& right, double h) noexcept;

/// Follows each local minimum over the grid: links between neighbouring nodes, the best match first, gathered into
/// branches by union-find; a link that would give a branch two points at one node is refused.
/// @param nodes the minima at each node of the grid, in any order
/// @return branches in the order of their first node; boxes filled with NaN where a branch does not exist.
[[nodiscard]] std::vector<GeometryBranch> track_branches(const GeometryGrid& grid,
                                                         std::span<const std::vector<BranchPoint>> nodes);

}  // namespace railtab
