#include "railtab/runtime/structure/stiffness_factor.hpp"

#include <Eigen/SparseCholesky>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

struct StiffnessFactor::Decomposition {
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> ldlt;
};

StiffnessFactor::StiffnessFactor(const Eigen::SparseMatrix<double>& K)
    : decomposition_(std::make_unique<Decomposition>()) {
  decomposition_->ldlt.compute(K);
}
StiffnessFactor::StiffnessFactor(StiffnessFactor&&) noexcept = default;
StiffnessFactor& StiffnessFactor::operator=(StiffnessFactor&&) noexcept = default;
StiffnessFactor::~StiffnessFactor() = default;

bool StiffnessFactor::positive_definite() const {
  const auto& ldlt = decomposition_->ldlt;
  return ldlt.info() == Eigen::Success && ldlt.vectorD().minCoeff() > 0.0;
}
Eigen::VectorXd StiffnessFactor::solve(const Eigen::VectorXd& load) const { return decomposition_->ldlt.solve(load); }
Eigen::MatrixXd StiffnessFactor::solve(const Eigen::MatrixXd& loads) const { return decomposition_->ldlt.solve(loads); }

StiffnessFactor positive_definite_factor(const Eigen::SparseMatrix<double>& K) {
  StiffnessFactor factor(K);
  if (factor.positive_definite()) return factor;
  throw ComputationError("the structure's stiffness is not positive definite: check supports and stiffnesses");
}

}  // namespace railtab
