#pragma once

#include "railtab/tables/geometry_table.hpp"

namespace railtab {

/// Gives every cell whose trusted_lowering is below `searched_lowering` [m] its search windows: the stretches of the
/// wheel profile in which the branches that begin, end or fold in or beside the cell have their minima, up to that
/// height above the first touch that the table knows. In parallel.
///
/// Stretches come from the branches' nodes around the cell, continued to their ends; each cell is then held against the
/// online search at points off the nodes and at several heights, and a pair that neither a branch's start nor a window
/// leads to widens the windows. A cell without a whole branch gets none.
void set_search_windows(double searched_lowering, GeometryTableData& table);

}  // namespace railtab
