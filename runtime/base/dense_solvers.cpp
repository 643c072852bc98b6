#include "railtab/runtime/base/dense_solvers.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <limits>

namespace railtab {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

namespace {

constexpr double not_found = std::numeric_limits<double>::quiet_NaN();

/// Q B of the decomposition A P = Q R, Q square.
Matrix orthogonal_factor(const Matrix& A, const Matrix& B) {
  return A.completeOrthogonalDecomposition().householderQ() * B;
}

}  // namespace

SymmetricSpectrum symmetric_spectrum(const Matrix& A) {
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(A);
  if (eigen.info() == Eigen::Success) return {eigen.eigenvalues(), eigen.eigenvectors()};
  return {Vector::Constant(A.rows(), not_found), Matrix::Constant(A.rows(), A.rows(), not_found)};
}

Vector generalised_eigenvalues(const Matrix& K, const Matrix& M) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> eigen(K, M, Eigen::EigenvaluesOnly);
  return eigen.info() == Eigen::Success ? eigen.eigenvalues() : Vector(Vector::Constant(K.rows(), not_found));
}

GeneralSpectrum general_spectrum(const Matrix& A) {
  const Eigen::EigenSolver<Matrix> eigen(A);
  if (eigen.info() == Eigen::Success) return {eigen.eigenvalues(), eigen.eigenvectors()};
  return {Eigen::VectorXcd::Constant(A.rows(), not_found), Eigen::MatrixXcd::Constant(A.rows(), A.rows(), not_found)};
}

Eigen::VectorXcd general_eigenvalues(const Matrix& A) {
  const Eigen::EigenSolver<Matrix> eigen(A, false);
  return eigen.info() == Eigen::Success ? eigen.eigenvalues()
                                        : Eigen::VectorXcd(Eigen::VectorXcd::Constant(A.rows(), not_found));
}

Matrix dense_inverse(const Matrix& A) { return A.partialPivLu().inverse(); }

Matrix dense_solution(const Matrix& A, const Matrix& B) { return A.partialPivLu().solve(B); }

Matrix symmetric_solution(const Matrix& A, const Matrix& B) { return A.ldlt().solve(B); }

Matrix least_squares_solution(const Matrix& A, const Matrix& B) { return A.completeOrthogonalDecomposition().solve(B); }

Matrix orthonormal_basis(const Matrix& A) { return orthogonal_factor(A, Matrix::Identity(A.rows(), A.cols())); }

Matrix orthogonal_complement(const Matrix& A) {
  if (A.rows() == A.cols()) return {A.rows(), 0};
  Matrix last = Matrix::Zero(A.rows(), A.rows() - A.cols());
  last.bottomRows(last.cols()).setIdentity();
  return orthogonal_factor(A, last);
}

void LuFactor::factor(const Matrix& A) { lu_.compute(A); }

void LuFactor::solve(const Vector& b, Vector& x) const { x = lu_.solve(b); }

CholeskyFactor::CholeskyFactor(const Matrix& M) : L_(M.llt().matrixLLT()) {}

Matrix CholeskyFactor::solve_L(const Matrix& B) const { return L_.triangularView<Eigen::Lower>().solve(B); }
Vector CholeskyFactor::solve_LT(const Vector& b) const { return L_.adjoint().triangularView<Eigen::Upper>().solve(b); }
Matrix CholeskyFactor::multiply_LT(const Matrix& B) const { return L_.adjoint().triangularView<Eigen::Upper>() * B; }

}  // namespace railtab
