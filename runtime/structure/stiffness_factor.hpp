#pragma once

#include "railtab/runtime/algebra/sparse_ldlt.hpp"

namespace railtab {

/// Factor of a structure's stiffness.
/// @throws ComputationError where K is not positive definite
[[nodiscard]] inline SparseLdlt stiffness_factor(const Eigen::SparseMatrix<double>& K) {
  return SparseLdlt(K, "the structure's stiffness is not positive definite: check supports and stiffnesses");
}

}  // namespace railtab
