#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <functional>

#include "railtab/runtime/algebra/elimination_tree.hpp"

namespace railtab {

/// Columns of one block of L D Lᵀ: the inverse T⁻¹ of the block's unit lower triangle, B T⁻¹ of the rows B below it,
/// which make substitution a product in which no column waits for another, and D.
struct EliminatedBlock {
  Eigen::MatrixXd inverse;  ///< T⁻¹, zero above the diagonal
  Eigen::MatrixXd below;    ///< B T⁻¹
  Eigen::VectorXd D;
};

/// Factor L D Lᵀ of a symmetric positive definite matrix by the multifrontal method [DuffReid1983]: every block is
/// eliminated in a dense matrix of its columns and rows, the front; what that changes in the rows below waits until
/// their block's front is assembled.
/// @param matrix its entries (i, j) and (j, i) are equal @param tree of this matrix
/// @param store called for every block once, in the order of the tree
/// @return false where the matrix is not positive definite
[[nodiscard]] bool factorise(const Eigen::SparseMatrix<double>& matrix, const EliminationTree& tree,
                             const std::function<void(int block, const EliminatedBlock&)>& store);

}  // namespace railtab
