#include "railtab/runtime/algebra/sectioned_ldlt.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "railtab/runtime/algebra/sectioned_product.hpp"
#include "railtab/runtime/base/dof_indices.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/structure/track_bridge.hpp"
#include "substitution_check.hpp"

namespace railtab {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

MirrorPairs both_rails(const StructureModel& s) {
  MirrorPairs pairs;
  for (std::size_t i = 0; i < s.rail[0].dof.size(); ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      if (s.rail[0].dof[i][k] != held) pairs.push_back({s.rail[0].dof[i][k], s.rail[1].dof[i][k]});
    }
    if (s.rail[0].twist_rate[i] != held) pairs.push_back({s.rail[0].twist_rate[i], s.rail[1].twist_rate[i]});
  }
  return pairs;
}

/// A structure in sections beside the same as a whole.
struct Sectioned {
  StructureModel structure;
  MirrorPairs pairs;
  Sparse effective;
  std::shared_ptr<const SectionLayout> layout;

  Sectioned(StructureModel model, const DofRange& range, bool paired = true)
      : structure(std::move(model)), effective(effective_matrix(structure)) {
    if (paired) pairs = both_rails(structure);
    const auto found =
        divide(by_sums_and_differences(effective, pairs), {structure.dof_x, structure.dof_line}, pairs, range);
    if (found) layout = std::make_shared<const SectionLayout>(*found);
  }
  [[nodiscard]] SectionedLdlt factor() const {
    return {by_sums_and_differences(effective, pairs), layout, "not positive definite"};
  }
};

StructureModel track_with(const std::vector<double>& spans, double before = 30.0, double after = 20.0) {
  TrackParameters track;
  track.length_before = before;
  track.length_after = after;
  std::vector<BridgeParameters> bridges;
  for (double length : spans) {
    bridges.emplace_back();
    bridges.back().length = length;
  }
  return build_track_bridge(track, bridges);
}

constexpr double of_floats = 1e-7;  // what rounding L's entries to floats changes a solution by

DofRange whole(const StructureModel& s) { return {0, s.dofs()}; }

TEST(SectionedLdlt, SolvesAsTheWholeFactorDoes) {
  for (const std::vector<double>& spans :
       {std::vector<double>{}, {32.0}, {20.0, 24.0, 31.5}, {32, 32, 32, 32, 32, 32}}) {
    for (const bool paired : {true, false}) {
      const StructureModel s = track_with(spans);
      const Sectioned sectioned(s, whole(s), paired);
      ASSERT_TRUE(sectioned.layout) << spans.size();
      const Eigen::VectorXd load = Eigen::VectorXd::Random(s.dofs());
      EXPECT_LT(difference(sectioned.factor().solve(load), SparseLdlt(sectioned.effective).solve(load)), of_floats)
          << spans.size() << " spans, " << (paired ? "sums and differences" : "rails");
    }
  }
}

// Entries of L are rounded before they change others: the matrix that the factor solves with has the given diagonal,
// and off it differs by roundings of floats.
TEST(SectionedLdlt, KeepsTheDiagonal) {
  const StructureModel s = track_with({});
  const Sectioned sectioned(s, whole(s), false);
  ASSERT_TRUE(sectioned.layout);
  const SectionedLdlt factor = sectioned.factor();
  const int n = s.dofs();
  const Eigen::MatrixXd given = sectioned.effective;
  const Eigen::VectorXd root = given.diagonal().cwiseSqrt();
  Eigen::MatrixXd inverse(n, n);  // with a diagonal of one, for the rounding of its own inverse
  for (int j = 0; j < n; ++j) {
    const Eigen::VectorXd load = root[j] * Eigen::VectorXd::Unit(n, j);
    inverse.col(j) = root.cwiseProduct(factor.solve(load));
  }
  const Eigen::MatrixXd scaled = root.cwiseInverse().asDiagonal() * given * root.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd change = (inverse.inverse() - scaled).cwiseAbs();
  const double on_diagonal = change.diagonal().maxCoeff(), largest = change.maxCoeff();
  EXPECT_LT(on_diagonal, 1e-11);
  EXPECT_GT(largest, 1e-9) << "entries are floats";
  EXPECT_LT(largest, 6e-8);
}

TEST(SectionedLdlt, OfARangeHoldsTheRest) {
  const StructureModel s = track_with({32.0, 32.0}, 100.0, 100.0);
  const auto begin = std::lower_bound(s.dof_x.begin(), s.dof_x.end(), -40.0) - s.dof_x.begin();
  const auto end = std::upper_bound(s.dof_x.begin(), s.dof_x.end(), 32.0) - s.dof_x.begin();
  const DofRange range{begin, end - begin};
  const Sectioned sectioned(s, range);
  ASSERT_TRUE(sectioned.layout);
  const Eigen::VectorXd load = Eigen::VectorXd::Random(s.dofs());
  EXPECT_LT(difference(sectioned.factor().solve(load), SparseLdlt(sectioned.effective, range).solve(load)), of_floats);
}

TEST(SectionedLdlt, AnswersAChangingLoadAndGivesTheWholeSolution) {
  const StructureModel s = track_with({32.0, 32.0});
  const Sectioned sectioned(s, whole(s));
  ASSERT_TRUE(sectioned.layout);
  const int rail = s.rail[0].dof[40][2];
  expect_divided_as_whole(sectioned.factor(), SparseLdlt(sectioned.effective),
                          {{700, 3, 3, 704, 12}, {rail}, {}, {s.dofs() - 1}}, of_floats);
  const auto node_dofs = [&](std::size_t node) {
    const DofIndices& dofs = s.rail[1].dof[node];
    return std::vector<int>{dofs[1], dofs[2], dofs[3]};
  };
  expect_few_as_all(sectioned.factor(), s.dofs(), node_dofs(40), node_dofs(41));
}

// Loads on the same unknowns keep their path, with the factor that found it.
TEST(SectionedLdlt, FindsAPathAgainForAnotherFactor) {
  const StructureModel s = track_with({32.0, 32.0});
  Sectioned sectioned(s, whole(s));
  ASSERT_TRUE(sectioned.layout);
  const SectionedLdlt in_sections = sectioned.factor();
  const SparseLdlt as_a_whole(sectioned.effective);
  const std::vector<int> few{s.rail[0].dof[40][2], s.rail[1].dof[41][2]};
  const Eigen::VectorXd load = Eigen::VectorXd::Random(s.dofs());
  const Eigen::VectorXd expected = as_a_whole.solve(load);
  DividedSubstitution divided;
  const auto solved = [&](const SubstitutionFactor& factor) {
    Eigen::VectorXd at_few = Eigen::VectorXd::Zero(s.dofs()), solution = at_few;
    divided.begin(factor, load, {few, {}});
    divided.respond(factor, at_few);
    divided.finish(factor, solution);
    for (int unknown : few) EXPECT_EQ(at_few[unknown], solution[unknown]);
    return solution;
  };
  for (int turn = 0; turn < 2; ++turn) {
    for (int again = 0; again < 2; ++again) EXPECT_LT(difference(solved(in_sections), expected), of_floats);
    for (int again = 0; again < 2; ++again) EXPECT_LT(difference(solved(as_a_whole), expected), 1e-13);
  }
}

TEST(SectionedLdlt, KeepsALoadThatIsNotANumber) {
  const StructureModel s = track_with({32.0, 32.0});
  const Sectioned sectioned(s, whole(s));
  ASSERT_TRUE(sectioned.layout);
  expect_nan_is_kept(sectioned.factor(), s.dofs(), s.rail[0].dof[40][2]);
}

TEST(SectionedLdlt, RejectsAMatrixThatIsNotPositiveDefinite) {
  const StructureModel s = track_with({32.0});
  Sectioned sectioned(s, whole(s));
  ASSERT_TRUE(sectioned.layout);
  sectioned.effective *= -1.0;
  EXPECT_THROW(static_cast<void>(sectioned.factor()), ComputationError);
}

TEST(SectionedProduct, IsThatOfTheMatrices) {
  const StructureModel s = track_with({20.0, 24.0});
  const Sectioned sectioned(s, whole(s));
  ASSERT_TRUE(sectioned.layout);
  const SectionedLdlt factor = sectioned.factor();
  const SectionedProduct product(by_sums_and_differences(s.stiffness, sectioned.pairs),
                                 by_sums_and_differences(s.damping, sectioned.pairs), sectioned.layout);
  const Eigen::VectorXd u = Eigen::VectorXd::Random(s.dofs()), v = Eigen::VectorXd::Random(s.dofs());
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(sectioned.layout->size());
  SectionedProduct::Motion motion{none, none};
  sectioned.layout->into(u, motion.u);
  sectioned.layout->into(v, motion.v);
  Eigen::VectorXd ordered = Eigen::VectorXd::Zero(factor.room());
  product.subtract(motion, ordered);
  sectioned.layout->fold_borders(ordered);
  Eigen::VectorXd result = Eigen::VectorXd::Zero(s.dofs());
  factor.out_of(ordered, result);
  EXPECT_LT(difference(-result, s.stiffness * u + s.damping * v), 1e-12);
}

TEST(SectionLayout, DividesNoStructureThatIsShortOrUnlike) {
  const StructureModel s = track_with({32.0}, 1.2, 1.2);
  EXPECT_TRUE(Sectioned(s, whole(s)).layout);
  EXPECT_FALSE(Sectioned(s, {0, 400}).layout) << "four bays";
  StructureModel unlike = track_with({32.0});
  unlike.dof_line[7] = -1;
  EXPECT_FALSE(Sectioned(unlike, whole(unlike)).layout);
}

// A track without offset falls apart into a vertical and a lateral system, and the sections' columns are as short as
// those of the halves.
TEST(SectionLayout, SumsAndDifferencesOfTheRailsShortenTheColumns) {
  const StructureModel s = track_with({32.0, 32.0, 32.0});
  const double paired = static_cast<double>(Sectioned(s, whole(s)).factor().bytes());
  EXPECT_LT(paired, 0.75 * static_cast<double>(Sectioned(s, whole(s), false).factor().bytes()));
}

}  // namespace
}  // namespace railtab
