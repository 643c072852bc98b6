#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

namespace railtab {

// Eigen's dense decompositions as functions. Each takes seconds to compile; here each is compiled once. For set-up
// code: matrices are copied and results allocated. Where the search for eigenvalues does not converge, as with a matrix
// that has NaN, the result is NaN.

/// Eigenvalues in increasing order; eigenvectors of unit length, one per column.
struct SymmetricSpectrum {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
/// @param A symmetric; its lower triangle is read
[[nodiscard]] SymmetricSpectrum symmetric_spectrum(const Eigen::MatrixXd& A);

/// λ of K v = λ M v in increasing order, K symmetric, M symmetric and positive definite.
[[nodiscard]] Eigen::VectorXd generalised_eigenvalues(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M);

/// Eigenvalues and eigenvectors of a square matrix, complex ones in pairs, in no order.
struct GeneralSpectrum {
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors;  ///< of unit length, one per column
};
[[nodiscard]] GeneralSpectrum general_spectrum(const Eigen::MatrixXd& A);
/// Its eigenvalues alone, in less time.
[[nodiscard]] Eigen::VectorXcd general_eigenvalues(const Eigen::MatrixXd& A);

/// Inverse by LU decomposition with partial pivoting, of a regular matrix.
[[nodiscard]] Eigen::MatrixXd dense_inverse(const Eigen::MatrixXd& A);

/// X with A X = B by LU decomposition with partial pivoting, A regular.
[[nodiscard]] Eigen::MatrixXd dense_solution(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

/// X with A X = B, A symmetric and semidefinite (LDLᵀ).
[[nodiscard]] Eigen::MatrixXd symmetric_solution(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

/// The X of shortest columns that minimises |A X - B|, whatever the rank of A (complete orthogonal decomposition).
[[nodiscard]] Eigen::MatrixXd least_squares_solution(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

/// An orthonormal basis of the space of the columns of A, which are independent; as many columns.
[[nodiscard]] Eigen::MatrixXd orthonormal_basis(const Eigen::MatrixXd& A);

/// An orthonormal basis of what is orthogonal to the columns of A, which are independent.
[[nodiscard]] Eigen::MatrixXd orthogonal_complement(const Eigen::MatrixXd& A);

/// LU decomposition with partial pivoting of a regular matrix, for many right-hand sides. Nothing is allocated where
/// the size stays.
class LuFactor {
 public:
  void factor(const Eigen::MatrixXd& A);
  /// x <- A⁻¹ b; they may not be one vector.
  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const;

 private:
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
};

/// M = L Lᵀ, M symmetric and positive definite.
class CholeskyFactor {
 public:
  explicit CholeskyFactor(const Eigen::MatrixXd& M);

  [[nodiscard]] Eigen::MatrixXd solve_L(const Eigen::MatrixXd& B) const;      ///< L⁻¹ B
  [[nodiscard]] Eigen::VectorXd solve_LT(const Eigen::VectorXd& b) const;     ///< L⁻ᵀ b
  [[nodiscard]] Eigen::MatrixXd multiply_LT(const Eigen::MatrixXd& B) const;  ///< Lᵀ B

 private:
  Eigen::MatrixXd L_;  // lower triangle
};

}  // namespace railtab
