#include "railtab/runtime/base/dense_solvers.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

namespace railtab {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

SymmetricSpectrum symmetric_spectrum(const Matrix& A) {
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(A);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

Vector generalised_eigenvalues(const Matrix& K, const Matrix& M) {
  return Eigen::GeneralizedSelfAdjointEigenSolver<Matrix>(K, M, Eigen::EigenvaluesOnly).eigenvalues();
}

GeneralSpectrum general_spectrum(const Matrix& A) {
  const Eigen::EigenSolver<Matrix> eigen(A);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

Matrix dense_inverse(const Matrix& A) { return A.partialPivLu().inverse(); }

Matrix symmetric_solution(const Matrix& A, const Matrix& B) { return A.ldlt().solve(B); }

Matrix least_norm_solution(const Matrix& A, const Matrix& B) { return A.completeOrthogonalDecomposition().solve(B); }

Matrix least_squares_solution(const Matrix& A, const Matrix& B) { return A.householderQr().solve(B); }

Matrix orthonormal_basis(const Matrix& A) {
  return A.colPivHouseholderQr().householderQ() * Matrix::Identity(A.rows(), A.cols());
}

CholeskyFactor::CholeskyFactor(const Matrix& M) : L_(M.llt().matrixLLT()) {}

Matrix CholeskyFactor::solve_L(const Matrix& B) const { return L_.triangularView<Eigen::Lower>().solve(B); }
Vector CholeskyFactor::solve_LT(const Vector& b) const { return L_.adjoint().triangularView<Eigen::Upper>().solve(b); }
Matrix CholeskyFactor::multiply_LT(const Matrix& B) const { return L_.adjoint().triangularView<Eigen::Upper>() * B; }

}  // namespace railtab
