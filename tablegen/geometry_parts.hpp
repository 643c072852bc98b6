#pragma once

#include <string>

#include "railtab/tablegen/geometry_sweep.hpp"
#include "railtab/tablegen/leaf_branches.hpp"

namespace railtab {

/// A table with all that it will say of the pair, its axes and its options, and no cells yet.
[[nodiscard]] GeometryTableData geometry_heading(const ContactSearch& search, const GeometrySweepOptions& options);

/// The box of a root cell, root_cells() of them.
[[nodiscard]] CellBox root_box(const GeometryTableData& table, std::int64_t root);

/// The pose at fractions -1..1 of a box, z not set. @param radius nominal [m]
[[nodiscard]] WheelsetPose pose_in(const CellBox& box, const std::array<double, 3>& local, double radius) noexcept;

/// A leaf that has branches.
struct TableLeaf {
  CellBox box;
  std::uint32_t number;  ///< in GeometryTableData::leaf_branch
};
/// Those below a root cell.
[[nodiscard]] std::vector<TableLeaf> leaves_below(const GeometryTableData& table, std::int64_t root);

[[nodiscard]] bool same_profile(const ProfileKnots& p, const ProfileKnots& q);

/// What of pair, dimensions, axes and tolerance differs between two tables, in words; empty: nothing.
[[nodiscard]] std::string difference_of_tables(const GeometryTableData& p, const GeometryTableData& q);

/// Why two parts cannot be of one table; empty where they can.
[[nodiscard]] std::string difference_of_parts(const GeometryTableData& p, const GeometryTableData& q);

}  // namespace railtab
