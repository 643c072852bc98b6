#pragma once

#include <vector>

#include "railtab/tablegen/branch_tracking.hpp"

namespace railtab {

/// GeometryTableData::trusted_lowering from the branches alone [m]: one value per cell, lateral fastest, infinity where
/// every branch is complete and smooth.
///
/// A branch that ends in a cell matters in that cell from the height of its end on. It also matters beyond: the pair of
/// a wheel lowered by d along the contact normal is that of a wheel touching at y - d·n_y, so the end is felt along the
/// normal through it, and the cells on that side are limited to the height at which the normal reaches them.
[[nodiscard]] std::vector<double> trusted_lowering(const GeometryGrid& grid,
                                                   const std::vector<GeometryBranch>& branches);

}  // namespace railtab
