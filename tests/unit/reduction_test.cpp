#include "railtab/runtime/structure/lowest_modes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "railtab/runtime/algebra/sparse_ldlt.hpp"
#include "railtab/runtime/structure/simple_beam.hpp"
#include "railtab/runtime/structure/track_bridge.hpp"

namespace railtab {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

StructureModel two_spans() {
  TrackParameters track;
  track.length_before = track.length_after = 9.0;
  BridgeParameters span;
  span.length = 12.0;
  span.elements = 12;
  return build_track_bridge(track, {span, span});
}

TEST(LowestModes, OfABeamHaveItsFrequencies) {
  const SimpleBeamParameters beam;
  const StructureModel structure = build_simple_beam(beam);
  const ModalBasis modes = lowest_modes(structure.stiffness, structure.mass, 5);
  ASSERT_EQ(modes.omega2.size(), 5);
  for (int n = 1; n <= 5; ++n) {
    const double omega = std::pow(n * std::numbers::pi / beam.length, 2) * std::sqrt(beam.E * beam.I / beam.mass);
    EXPECT_NEAR(std::sqrt(modes.omega2[n - 1]) / omega, 1.0, 1e-5 * std::pow(n, 4) / 5.0) << n;
  }
}

// Two spans that do not know of each other have every frequency twice, which one vector alone would not find.
TEST(LowestModes, FindsEqualFrequenciesAndOrthonormalShapes) {
  const StructureModel one = build_simple_beam({});
  std::vector<Eigen::Triplet<double>> K, M;
  const int n = one.dofs();
  for (int copy = 0; copy < 2; ++copy) {
    for (int j = 0; j < n; ++j) {
      for (Sparse::InnerIterator e(one.stiffness, j); e; ++e)
        K.emplace_back(copy * n + static_cast<int>(e.row()), copy * n + j, e.value());
      for (Sparse::InnerIterator e(one.mass, j); e; ++e)
        M.emplace_back(copy * n + static_cast<int>(e.row()), copy * n + j, e.value());
    }
  }
  Sparse stiffness(2 * n, 2 * n), mass(2 * n, 2 * n);
  stiffness.setFromTriplets(K.begin(), K.end());
  mass.setFromTriplets(M.begin(), M.end());
  const ModalBasis modes = lowest_modes(stiffness, mass, 12);
  ASSERT_EQ(modes.omega2.size(), 12);
  for (int k = 0; k < 12; k += 2) EXPECT_NEAR(modes.omega2[k + 1] / modes.omega2[k], 1.0, 1e-9);
  const Eigen::MatrixXd identity = modes.shape.transpose() * (mass * modes.shape);
  EXPECT_LT((identity - Eigen::MatrixXd::Identity(12, 12)).cwiseAbs().maxCoeff(), 1e-10);
  const Eigen::MatrixXd residual = stiffness * modes.shape - mass * modes.shape * modes.omega2.asDiagonal();
  EXPECT_LT(residual.cwiseAbs().maxCoeff(), 1e-6 * (stiffness * modes.shape).cwiseAbs().maxCoeff());
}

// A factor of a range holds everything else.
TEST(SparseLdlt, OfARangeHoldsTheRest) {
  const StructureModel structure = two_spans();
  const DofRange range{200, 400};
  const SparseLdlt factor(structure.stiffness, range);
  const Eigen::VectorXd load = Eigen::VectorXd::LinSpaced(structure.dofs(), 1.0, 2.0);
  const Eigen::VectorXd x = factor.solve(load);
  EXPECT_EQ(x.head(200).cwiseAbs().maxCoeff(), 0.0);
  EXPECT_EQ(x.tail(structure.dofs() - 600).cwiseAbs().maxCoeff(), 0.0);
  EXPECT_LT((structure.stiffness * x - load).segment(200, 400).cwiseAbs().maxCoeff(), 1e-8);
}

}  // namespace
}  // namespace railtab
