// Every decomposition by what defines its result.
#include "railtab/runtime/base/dense_solvers.hpp"

#include <gtest/gtest.h>

#include <complex>
#include <random>

#include "railtab/runtime/algebra/inverse_side_by_side.hpp"

namespace railtab {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double rounding = 1e-12;

const MatrixXd A{{4.0, 1.0, -0.5}, {0.3, 3.0, 0.2}, {-1.0, 0.4, 5.0}};
const MatrixXd K{{4.0, 1.0, -0.5}, {1.0, 3.0, 0.2}, {-0.5, 0.2, 5.0}};
const MatrixXd M{{2.0, 0.1, 0.0}, {0.1, 1.0, 0.3}, {0.0, 0.3, 4.0}};
const MatrixXd tall{{1.0, 2.0}, {0.0, 1.0}, {-1.0, 0.5}};
const VectorXd b{{1.0, -2.0, 3.0}};

TEST(DenseSolvers, SymmetricSpectrum) {
  const SymmetricSpectrum s = symmetric_spectrum(K);
  EXPECT_LT((K * s.vectors - s.vectors * s.values.asDiagonal()).norm(), rounding);
  EXPECT_LT((s.vectors.transpose() * s.vectors - MatrixXd::Identity(3, 3)).norm(), rounding);
  EXPECT_LT(s.values[0], s.values[1]);
  EXPECT_LT(s.values[1], s.values[2]);
}

TEST(DenseSolvers, GeneralSpectrum) {
  const MatrixXd turning{{0.0, 2.0, 0.0}, {-2.0, 0.0, 0.0}, {1.0, 0.0, -3.0}};  // ±2i and −3
  const GeneralSpectrum s = general_spectrum(turning);
  EXPECT_LT((turning.cast<std::complex<double>>() * s.vectors - s.vectors * s.values.asDiagonal()).norm(), rounding);
  EXPECT_LT(std::abs(s.values.sum() + 3.0), rounding);
  EXPECT_NEAR(s.values.imag().cwiseAbs().maxCoeff(), 2.0, rounding);
}

TEST(DenseSolvers, GeneralisedEigenvaluesMakeThePencilSingular) {
  const VectorXd lambda = generalised_eigenvalues(K, M);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(symmetric_spectrum(K - lambda[k] * M).values.cwiseAbs().minCoeff(), 0.0, rounding) << k;
  }
}

TEST(DenseSolvers, InverseAndSolutions) {
  EXPECT_LT((dense_inverse(A) * A - MatrixXd::Identity(3, 3)).norm(), rounding);
  EXPECT_LT((K * symmetric_solution(K, A) - A).norm(), rounding);
  EXPECT_LT((A * dense_solution(A, K) - K).norm(), rounding);
  const MatrixXd x = least_squares_solution(tall, b);
  EXPECT_LT((tall.transpose() * (tall * x - b)).norm(), rounding);
}

TEST(DenseSolvers, LeastSquaresSolutionOfASingularMatrixIsTheShortest) {
  MatrixXd singular = tall * tall.transpose();
  const VectorXd x = least_squares_solution(singular, b);
  const VectorXd residual = singular * x - b;
  EXPECT_LT((singular.transpose() * residual).norm(), rounding);
  const VectorXd null = symmetric_spectrum(singular).vectors.col(0);
  EXPECT_NEAR(x.dot(null), 0.0, rounding);
}

TEST(DenseSolvers, OrthonormalBasisSpansTheColumns) {
  const MatrixXd Q = orthonormal_basis(tall);
  ASSERT_EQ(Q.cols(), 2);
  EXPECT_LT((Q.transpose() * Q - MatrixXd::Identity(2, 2)).norm(), rounding);
  EXPECT_LT((Q * (Q.transpose() * tall) - tall).norm(), rounding);
}

TEST(DenseSolvers, OrthogonalComplement) {
  const MatrixXd Q = orthogonal_complement(tall);
  ASSERT_EQ(Q.cols(), 1);
  EXPECT_NEAR(Q.norm(), 1.0, rounding);
  EXPECT_LT((Q.transpose() * tall).norm(), rounding);
  EXPECT_EQ(orthogonal_complement(A).cols(), 0);
}

TEST(DenseSolvers, CholeskyFactor) {
  const CholeskyFactor factor(M);
  const MatrixXd LT = factor.multiply_LT(MatrixXd::Identity(3, 3));
  EXPECT_LT((LT.transpose() * LT - M).norm(), rounding);
  EXPECT_LT((LT.transpose() * factor.solve_L(A) - A).norm(), rounding);
  EXPECT_LT((LT * factor.solve_LT(b) - b).norm(), rounding);
}

constexpr int size = 5;
using Square = Eigen::Matrix<double, size, size>;
using SquaresSideBySide = MatricesSideBySide<size>;

// Seven matrices near to identity, and one that has zeros on its diagonal: a cyclic exchange of rows, times two.
std::array<Square, 8> squares() {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(-0.3, 0.3);
  std::array<Square, 8> result;
  for (Square& matrix : result) matrix = Square::Identity() + Square::NullaryExpr([&] { return number(random); });
  result[3] = 2.0 * Square::NullaryExpr([](Eigen::Index i, Eigen::Index j) { return (i + 1) % size == j ? 1.0 : 0.0; });
  return result;
}

SquaresSideBySide side_by_side(const std::array<Square, 8>& matrices) {
  SquaresSideBySide result;
  for (int s = 0; s < 8; ++s) {
    for (int i = 0; i < size; ++i) {
      for (int j = 0; j < size; ++j) result.at(i, j)[s] = matrices[static_cast<std::size_t>(s)](i, j);
    }
  }
  return result;
}

Square one_of(const SquaresSideBySide& matrices, int s) {
  return Square::NullaryExpr(
      [&](Eigen::Index i, Eigen::Index j) { return matrices.at(static_cast<int>(i), static_cast<int>(j))[s]; });
}

TEST(InverseSideBySide, OfEveryMatrixAlsoWithoutPivotsOnTheDiagonal) {
  const std::array<Square, 8> matrices = squares();
  SquaresSideBySide inverses = side_by_side(matrices);
  invert_side_by_side(inverses);
  for (int s = 0; s < 8; ++s) {
    const Square product = one_of(inverses, s) * matrices[static_cast<std::size_t>(s)];
    EXPECT_LT((product - Square::Identity()).norm(), rounding) << s;
  }
}

TEST(InverseSideBySide, DoesNotDependOnTheMatricesBeside) {
  const std::array<Square, 8> matrices = squares();
  SquaresSideBySide together = side_by_side(matrices);
  invert_side_by_side(together);
  for (int s = 0; s < 8; ++s) {
    std::array<Square, 8> alone;
    alone.fill(matrices[static_cast<std::size_t>(s)]);
    SquaresSideBySide inverses = side_by_side(alone);
    invert_side_by_side(inverses);
    EXPECT_EQ(one_of(inverses, 0), one_of(together, s)) << s;
  }
}

TEST(InverseSideBySide, OfASingularMatrixIsNotFinite) {
  std::array<Square, 8> matrices = squares();
  matrices[5].row(1) = 3.0 * matrices[5].row(0);
  SquaresSideBySide inverses = side_by_side(matrices);
  invert_side_by_side(inverses);
  EXPECT_FALSE(one_of(inverses, 5).allFinite() && one_of(inverses, 5).norm() < 1e12);
  EXPECT_LT((one_of(inverses, 4) * matrices[4] - Square::Identity()).norm(), rounding);
}

}  // namespace
}  // namespace railtab
