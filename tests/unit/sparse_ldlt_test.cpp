#include "railtab/runtime/algebra/sparse_ldlt.hpp"

#include <gtest/gtest.h>

#include <Eigen/SparseLU>

#include "railtab/runtime/structure/track_bridge.hpp"
#include "substitution_check.hpp"

namespace railtab {
namespace {

Eigen::SparseMatrix<double> short_track() {
  TrackParameters track;
  track.length_before = track.length_after = 12.0;
  return effective_matrix(build_track_bridge(track, {BridgeParameters{}, BridgeParameters{}}));
}

TEST(SparseLdlt, SolvesAsAFactorisationWithoutSymmetryDoes) {
  const Eigen::SparseMatrix<double> matrix = short_track();
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

TEST(SparseLdlt, KeepsALoadThatIsNotANumber) {
  const Eigen::SparseMatrix<double> matrix = short_track();
  expect_nan_is_kept(SparseLdlt(matrix), matrix.rows(), 700);
}

TEST(DividedSubstitution, AnswersAChangingLoadAndGivesTheWholeSolution) {
  const Eigen::SparseMatrix<double> matrix = short_track();
  const SparseLdlt factor(matrix);
  expect_divided_as_whole(factor, factor, {{700, 3, 3, 704, 12}, {5}, {}}, 1e-12);
}

}  // namespace
}  // namespace railtab
