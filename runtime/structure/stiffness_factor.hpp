#pragma once

#include <Eigen/SparseCore>
#include <memory>

namespace railtab {

/// LDLᵀ decomposition of a symmetric sparse matrix, for set-up code (runs use SparseLdlt).
class StiffnessFactor {
 public:
  explicit StiffnessFactor(const Eigen::SparseMatrix<double>& K);
  StiffnessFactor(StiffnessFactor&&) noexcept;
  StiffnessFactor& operator=(StiffnessFactor&&) noexcept;
  StiffnessFactor(const StiffnessFactor&) = delete;
  StiffnessFactor& operator=(const StiffnessFactor&) = delete;
  ~StiffnessFactor();

  [[nodiscard]] bool positive_definite() const;
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& load) const;
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& loads) const;

 private:
  struct Decomposition;
  std::unique_ptr<Decomposition> decomposition_;
};

/// @throws ComputationError where K is not positive definite
[[nodiscard]] StiffnessFactor positive_definite_factor(const Eigen::SparseMatrix<double>& K);

}  // namespace railtab
