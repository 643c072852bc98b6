#pragma once

#include <string>

#include "railtab/tablegen/geometry_sweep.hpp"

namespace railtab {

/// A table with all that it will say of the pair, its axes and its options, and no cells yet.
[[nodiscard]] GeometryTableData geometry_heading(const ContactSearch& search, const GeometrySweepOptions& options);

/// Why two parts cannot be of one table; empty where they can.
[[nodiscard]] std::string difference_of_parts(const GeometryTableData& p, const GeometryTableData& q);

}  // namespace railtab
