#include "railtab/runtime/algebra/sparse_ldlt.hpp"

#include <gtest/gtest.h>

#include <Eigen/SparseLU>

#include "railtab/runtime/algebra/divided_substitution.hpp"
#include "railtab/runtime/structure/track_bridge.hpp"

namespace railtab {
namespace {

// Effective matrix of a short track with a bridge, as a time step has it.
Eigen::SparseMatrix<double> effective_matrix() {
  TrackParameters track;
  track.length_before = track.length_after = 12.0;
  const StructureModel s = build_track_bridge(track, {BridgeParameters{}, BridgeParameters{}});
  return 1.6e7 * s.mass + 4e3 * s.damping + s.stiffness;
}

double difference(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

TEST(SparseLdlt, SolvesAsAFactorisationWithoutSymmetryDoes) {
  const Eigen::SparseMatrix<double> matrix = effective_matrix();
  const SparseLdlt factor(matrix);
  const Eigen::VectorXd load = Eigen::VectorXd::Random(matrix.rows());
  const Eigen::SparseLU<Eigen::SparseMatrix<double>> lu(matrix);
  EXPECT_LT(difference(factor.solve(load), lu.solve(load)), 1e-10);
}

TEST(SparseLdlt, UnconnectedUnknownsAreBlocksOfTheirOwn) {
  Eigen::SparseMatrix<double> diagonal(3, 3);
  for (int i = 0; i < 3; ++i) diagonal.insert(i, i) = i + 1.0;
  const SparseLdlt factor(diagonal);
  EXPECT_TRUE(factor.solve(Eigen::Vector3d(1.0, 2.0, 3.0)).isApprox(Eigen::Vector3d::Ones(), 1e-15));
}

TEST(DividedSubstitution, AnswersAChangingLoadAndGivesTheWholeSolution) {
  const Eigen::SparseMatrix<double> matrix = effective_matrix();
  const SparseLdlt factor(matrix);
  const Eigen::Index n = matrix.rows();
  DividedSubstitution solution;
  for (const std::vector<int>& few : {std::vector<int>{700, 3, 3, 704, 12}, std::vector<int>{5}, std::vector<int>{}}) {
    const Eigen::VectorXd known = Eigen::VectorXd::Random(n);
    solution.begin(factor, known, few);
    Eigen::VectorXd extra = Eigen::VectorXd::Zero(n), answer = Eigen::VectorXd::Zero(n), whole;
    for (const double size : {0.0, 1.0, -7.0}) {
      for (int unknown : few) extra[unknown] = size * (1.0 + 0.1 * unknown);
      solution.respond(factor, 0.95, extra, answer);
      const Eigen::VectorXd expected = factor.solve(known + 0.95 * extra);
      for (int unknown : few) EXPECT_NEAR(answer[unknown], expected[unknown], 1e-12 * expected.cwiseAbs().maxCoeff());
    }
    solution.finish(factor, whole);
    EXPECT_LT(difference(whole, factor.solve(known + 0.95 * extra)), 1e-12);
  }
}

}  // namespace
}  // namespace railtab
