#pragma once

#include "railtab/runtime/contact/contact_search.hpp"
#include "railtab/tables/geometry_table.hpp"

namespace railtab {

/// Holds each cell of a table against the online search at points off the nodes (the centre and four points of a fixed
/// low-discrepancy sequence), in parallel. Where a touching minimum has no start in the table that leads to it, or a
/// branch of the table leads nowhere, the cell's trusted_lowering is reduced to just below that minimum's height.
/// @param branch_height height above first touch up to which minima are compared [m]
/// @return number of cells reduced
int limit_wrong_cells(const ContactSearch& search, double branch_height, GeometryTableData& table);

}  // namespace railtab
