#pragma once

#include <Eigen/SparseCore>
#include <span>
#include <vector>

#include "railtab/runtime/base/dof_range.hpp"

namespace railtab {

/// In which order a factor of a symmetric sparse matrix eliminates its unknowns.
enum class EliminationOrder {
  minimum_degree,     ///< quickly found [AmestoyEtAl1996]: for a factor that is used once, or of a narrow system
  nested_dissection,  ///< METIS [KarypisKumar1998]: short paths in the elimination tree, fewest entries of wide systems
};

/// @param matrix with its whole pattern, not one triangle only  @param range of unknowns; all others are left out
/// @param node of every unknown of the matrix, numbers from 0; nested dissection then orders nodes, which takes a tenth
///        of the time where a node has six unknowns. Empty: every unknown is a node
/// @return the unknown that is eliminated k-th, counted from range.begin, for each k
[[nodiscard]] std::vector<int> elimination_order(const Eigen::SparseMatrix<double>& matrix, const DofRange& range,
                                                 EliminationOrder order, std::span<const int> node = {});

}  // namespace railtab
