#pragma once

#include "railtab/runtime/structure/structure_model.hpp"

namespace railtab {

class SparseLdlt;

/// The same structure in displacements relative to what its supports carry along at rest [CloughPenzien1993, ch. 26],
///
///     u = ι s + w,   ι = −K⁻¹ K_s:   M w″ + C w′ + K w = F − (M ι + M_s) s″ − (C ι + C_s) s′,
///
/// so that a few modes of w do not have to make up for the supports' own translation. Its supports have these two
/// matrices, no stiffness, and ι of the rails and the nodes of interest. Entries of ι below 1e-12 of a column's largest
/// are left out. @pre supports are known and K is positive definite @throws ComputationError where it is not
[[nodiscard]] StructureModel relative_to_supports(StructureModel structure);

/// ι = −K⁻¹ K_s, dofs × 2 per support. @throws ComputationError where K is not positive definite
[[nodiscard]] Eigen::SparseMatrix<double> carried_by_supports(const SparseLdlt& factor,
                                                              const StructureSupports::Columns& of_supports);
[[nodiscard]] Eigen::SparseMatrix<double> carried_by_supports(const Eigen::SparseMatrix<double>& stiffness,
                                                              const StructureSupports::Columns& of_supports);

/// Supports that move by `shares` (columns × 2 per place) of the motion of places x [m].
[[nodiscard]] StructureSupports gathered(const StructureSupports& supports, const Eigen::SparseMatrix<double>& shares,
                                         std::vector<double> x);

}  // namespace railtab
