// Modes that were not found are never returned.

#include <gtest/gtest.h>

#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <vector>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/structure/lowest_modes.hpp"

namespace railtab {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

// A chain of n springs [N/m] with one end held, and masses [kg].
Sparse chain(int n, double k) {
  Sparse K(n, n);
  for (int i = 0; i < n; ++i) {
    K.insert(i, i) = i + 1 < n ? 2.0 * k : k;
    if (i > 0) K.insert(i, i - 1) = K.insert(i - 1, i) = -k;
  }
  return K;
}

Sparse diagonal(const Eigen::VectorXd& values) {
  Sparse M(values.size(), values.size());
  for (Eigen::Index i = 0; i < values.size(); ++i) M.insert(i, i) = values[i];
  return M;
}

TEST(LowestModes, OfAChainAreThoseOfItsFormula) {
  constexpr int n = 60, modes = 5;
  const ModalBasis basis = lowest_modes(chain(n, 1e6), diagonal(Eigen::VectorXd::Constant(n, 4.0)), modes);
  ASSERT_EQ(basis.omega2.size(), modes);
  for (int k = 0; k < modes; ++k) {
    const double omega = 2.0 * std::sqrt(1e6 / 4.0) * std::sin(0.5 * M_PI * (2 * k + 1) / (2 * n + 1));
    EXPECT_NEAR(std::sqrt(basis.omega2[k]), omega, 1e-8 * omega);
  }
}

// A force of 1 N at mass j moves mass i by (min(i, j) + 1)/k.
TEST(LowestModes, AndResidualShapesDeflectAsTheWholeStructure) {
  constexpr int n = 60;
  constexpr double k = 1e6;
  const ModalBasis basis = lowest_modes(chain(n, k), diagonal(Eigen::VectorXd::Constant(n, 4.0)), 5);
  const std::vector<int> places{9, 30, 59};
  Eigen::MatrixXd forces = Eigen::MatrixXd::Zero(n, 3);
  for (std::size_t f = 0; f < places.size(); ++f) forces(places[f], static_cast<Eigen::Index>(f)) = 1.0;
  const Eigen::MatrixXd shapes = residual_shapes(chain(n, k), basis, forces);
  ASSERT_EQ(shapes.cols(), 3);
  const Eigen::MatrixXd by_modes = basis.shape * basis.omega2.cwiseInverse().asDiagonal() * basis.shape.transpose();
  const Eigen::MatrixXd moved = (by_modes + shapes * shapes.transpose() / basis.omega2[4]) * forces;
  for (int i = 0; i < n; ++i) {
    for (std::size_t f = 0; f < places.size(); ++f) {
      EXPECT_NEAR(moved(i, static_cast<Eigen::Index>(f)), (std::min(i, places[f]) + 1) / k, 1e-6 * n / k) << i;
    }
  }
  // nothing is left beyond all modes
  const ModalBasis all = lowest_modes(chain(6, k), diagonal(Eigen::VectorXd::Constant(6, 4.0)), 6);
  EXPECT_EQ(residual_shapes(chain(6, k), all, Eigen::MatrixXd::Identity(6, 6)).cols(), 0);
}

// Fewer masses than modes asked for: those that there are, every one converged.
TEST(LowestModes, AreAsManyAsMasses) {
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(40);
  mass[10] = mass[30] = 2.0;
  const ModalBasis basis = lowest_modes(chain(40, 1e6), diagonal(mass), 12);
  ASSERT_EQ(basis.omega2.size(), basis.shape.cols());
  ASSERT_GE(basis.omega2.size(), 2);
  for (Eigen::Index k = 0; k < 2; ++k) EXPECT_TRUE(basis.omega2[k] > 0.0 && std::isfinite(basis.omega2[k]));
}

TEST(LowestModes, ThatAreNotFoundAreAnError) {
  constexpr int n = 60;
  EXPECT_THROW(static_cast<void>(lowest_modes(chain(n, 1e6), diagonal(Eigen::VectorXd::Zero(n)), 3)), ComputationError);
  for (const double absurd : {1e150, 1e300}) {
    Eigen::VectorXd mass = Eigen::VectorXd::Constant(n, 4.0);
    mass[7] = absurd;
    try {  // found all the same, or an error
      const ModalBasis basis = lowest_modes(chain(n, 1e6), diagonal(mass), 3);
      ASSERT_GE(basis.omega2.size(), 1);
      EXPECT_TRUE(basis.omega2.allFinite() && basis.shape.allFinite());
    } catch (const ComputationError&) {
    }
  }
  Sparse indefinite = diagonal(Eigen::VectorXd::Constant(n, 4.0));
  indefinite.coeffRef(3, 4) = indefinite.coeffRef(4, 3) = 1e9;
  EXPECT_THROW(static_cast<void>(lowest_modes(chain(n, 1e6), indefinite, 10)), ComputationError);
}

}  // namespace
}  // namespace railtab
