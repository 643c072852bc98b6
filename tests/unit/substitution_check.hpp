#pragma once

#include <gtest/gtest.h>

#include <Eigen/SparseCore>
#include <cmath>
#include <limits>
#include <vector>

#include "railtab/runtime/algebra/divided_substitution.hpp"
#include "railtab/runtime/algebra/sparse_ldlt.hpp"
#include "railtab/runtime/structure/structure_model.hpp"

namespace railtab {

/// As a time step has it.
inline Eigen::SparseMatrix<double> effective_matrix(const StructureModel& s) {
  return 1.6e7 * s.mass + 4e3 * s.damping + s.stiffness;
}

inline double difference(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

/// A load that changes on few unknowns, by the factor's parts, against whole solutions by the reference.
inline void expect_divided_as_whole(const SubstitutionFactor& factor, const SparseLdlt& reference,
                                    const std::vector<std::vector<int>>& loaded, double tolerance) {
  const Eigen::Index n = reference.size();
  DividedSubstitution solution;
  for (const std::vector<int>& few : loaded) {
    const Eigen::VectorXd known = Eigen::VectorXd::Random(n);
    solution.begin(factor, known, {few, {}});
    Eigen::VectorXd extra = Eigen::VectorXd::Zero(n), answer = Eigen::VectorXd::Zero(n), whole;
    for (const double size : {0.0, 1.0, -7.0}) {
      for (int unknown : few) extra[unknown] = size * (1.0 + 0.1 * unknown);
      solution.respond(factor, 0.95, extra, answer);
      const Eigen::VectorXd expected = reference.solve(known + 0.95 * extra);
      for (int unknown : few) {
        EXPECT_NEAR(answer[unknown], expected[unknown], tolerance * expected.cwiseAbs().maxCoeff());
      }
    }
    solution.finish(factor, whole);
    EXPECT_LT(difference(whole, reference.solve(known + 0.95 * extra)), tolerance);
  }
}

/// Known loads on few unknowns alone, and unknowns that are named before they are loaded, change nothing.
inline void expect_few_as_all(const SubstitutionFactor& factor, Eigen::Index n, const std::vector<int>& now,
                              const std::vector<int>& soon) {
  Eigen::VectorXd known = Eigen::VectorXd::Zero(n), of_all, of_few;
  for (int unknown : now) known[unknown] = 1.0 + 0.1 * unknown;
  factor.into(Eigen::VectorXd(-0.7 * known), of_all);
  factor.into(now, -0.7, known, of_few);
  EXPECT_LT(difference(of_few, of_all), 1e-15);

  const auto answers = [&](DividedSubstitution& solution, const LoadedUnknowns& few) {
    Eigen::VectorXd extra = Eigen::VectorXd::Zero(n), answer = Eigen::VectorXd::Zero(n), whole;
    for (int unknown : few.now) extra[unknown] = 2.0 + 0.3 * unknown;
    solution.begin(factor, known, few);
    solution.respond(factor, 1.1, extra, answer);
    solution.finish(factor, whole);
    for (int unknown : few.now) EXPECT_EQ(answer[unknown], whole[unknown]);
    return whole;
  };
  DividedSubstitution kept, fresh;
  EXPECT_EQ(answers(kept, {now, soon}), answers(fresh, {now, {}}));
  EXPECT_EQ(answers(kept, {soon, {}}), answers(fresh, {soon, {}}));  // on the path that is there
  EXPECT_EQ(answers(kept, {now, {}}), answers(fresh, {now, {}}));
}

/// A load that is not a number makes a solution that is none, however small the loads beside it.
inline void expect_nan_is_kept(const SubstitutionFactor& factor, Eigen::Index n, int unknown) {
  const std::vector<int> few{unknown};
  DividedSubstitution solution;
  solution.begin(factor, Eigen::VectorXd::Zero(n), {few, {}});
  Eigen::VectorXd extra = Eigen::VectorXd::Zero(n), answer = Eigen::VectorXd::Zero(n);
  extra[unknown] = std::numeric_limits<double>::quiet_NaN();
  solution.respond(factor, 1.0, extra, answer);
  EXPECT_TRUE(std::isnan(answer[unknown]));
}

}  // namespace railtab
