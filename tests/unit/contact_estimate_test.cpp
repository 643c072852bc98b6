// Contact forces with which a time step begins its iteration.

#include "railtab/runtime/vsi/contact_estimate.hpp"

#include <gtest/gtest.h>

#include <cstdio>

#include "railtab/runtime/vsi/hht.hpp"
#include "wheelset_chain.hpp"

namespace railtab {
namespace {

using Vector12 = Eigen::Matrix<double, wheelset_unknowns, 1>;

/// A wheelset at the end of a step of 1 ms, with the tangents there.
struct EndOfStep : Chain {
  NewtonWorkspace workspace;
  ForceEstimate estimate;

  explicit EndOfStep(const Vector6& q) {
    const HhtScheme hht{.alpha = -0.05, .time_step = 1e-3};
    problem.velocity_rate = Vector6::Constant(hht.velocity_rate());
    problem.rail_velocity_rate = hht.velocity_rate();
    problem.free = Eigen::VectorXd::Zero(wheelset_unknowns);
    problem.vehicle_compliance = Eigen::MatrixXd::Zero(6, 6);
    problem.predicted.head<6>() = q;
    problem.predicted_velocity[1] = 0.02;
    start.displacement = problem.predicted;
    static_cast<void>(solve_contact(model, problem, {.tolerance = 1e-15, .max_iterations = 0}, start, workspace));
    start.displacement = problem.predicted;  // which that has corrected
    evaluate_contact(model, problem, start);
    estimate.add_to(model, problem, start, workspace, true, end);
    estimate.learn(model, problem, workspace, start);
  }

  /// The estimate after a motion at constant velocities, from the forces at the start.
  Eigen::VectorXd after(const Vector12& motion) {
    problem.predicted = start.displacement + motion;
    ContactSolution estimated = start;
    estimated.displacement = problem.predicted;
    estimate.add_to(model, problem, start, workspace, true, estimated);
    return estimated.force;
  }
};

// How far wheels press into rails and how they slip across them makes up more than nine tenths of the change. The rest
// is what a shift along the profiles changes of stiffness and creep.
TEST(ForceEstimate, FollowsWhatAWheelsetDoesBetweenSteps) {
  const auto along = [](std::initializer_list<std::pair<int, double>> entries) {
    Vector12 motion = Vector12::Zero();
    for (const auto& [dof, value] : entries) motion[dof] = value;
    return motion;
  };
  const std::pair<const char*, Vector12> motions[] = {{"wheels descend", along({{2, 1e-6}})},
                                                      {"a rail bends", along({{7, 1e-6}})},
                                                      {"wheelset rolls", along({{3, 1e-6}})},
                                                      {"wheelset yaws", along({{5, 1e-5}})},
                                                      {"all", along({{2, 1e-6}, {3, 1e-6}, {5, 1e-5}, {7, 1e-6}})}};
  for (const Vector6& q : {pose(0.0, 0.3e-3, 1e-3), pose(1e-3, 0.3e-3, -1e-3)}) {
    for (const auto& [name, motion] : motions) {
      EndOfStep step(q);
      const Eigen::VectorXd estimated = step.after(motion);
      const Eigen::VectorXd found = step.force_after(step.problem.predicted);
      const double change = (found - step.start.force).cwiseAbs().maxCoeff();
      const double error = (estimated - found).cwiseAbs().maxCoeff();
      std::printf("%-15s changes forces by %4.0f N, %3.0f of which are not followed\n", name, change, error);
      EXPECT_GT(change, 200.0) << name;
      EXPECT_LT(error, 0.1 * change) << name;
    }
  }
}

TEST(ForceEstimate, GoesOnWithItsError) {
  const Vector12 error = Vector12::Constant(10.0);
  // of three steps, and what the fourth expects, as parts of `error`
  const struct { double of[3], expected; } cases[] = {{{1, 1, 1}, 1}, {{1, 2, 3}, 4}, {{1, -1, 1}, 0}, {{0, 0, 0}, 0}};
  for (const auto& c : cases) {
    EndOfStep step(pose(0.0, 0.3e-3, 1e-3));
    for (const double part : c.of) {
      static_cast<void>(step.after(Vector12::Zero()));
      ContactSolution solution = step.start;
      solution.force += part * error;
      step.estimate.learn(step.model, step.problem, step.workspace, solution);
    }
    EXPECT_LT((step.after(Vector12::Zero()) - step.start.force - c.expected * error).cwiseAbs().maxCoeff(), 1e-6)
        << c.of[0] << ' ' << c.of[1] << ' ' << c.of[2];
    step.problem.rail_velocity_rate *= 2.0;  // a shorter step errs less
    EXPECT_LT((step.after(Vector12::Zero()) - step.start.force).cwiseAbs().maxCoeff(), 1e-6);
  }
}

// Rails that start to move sideways, as irregularities have them do: the wheels slip across them.
TEST(ForceEstimate, FollowsTheSlipAcrossEitherRail) {
  for (const std::size_t side : {0U, 1U}) {
    EndOfStep step(pose(0.0, 0.3e-3, 1e-3));
    step.problem.deviation[0][side].velocity[0] += 2e-4;
    const Eigen::VectorXd estimated = step.after(Vector12::Zero());
    const Eigen::VectorXd found = step.force_after(step.problem.predicted);
    const double change = (found - step.start.force).cwiseAbs().maxCoeff();
    EXPECT_GT(change, 50.0);
    EXPECT_LT((estimated - found).cwiseAbs().maxCoeff(), 0.15 * change) << side;
  }
}

TEST(ForceEstimate, ForgottenIsTheForceOfTheStepBefore) {
  EndOfStep step(pose(0.0, 0.3e-3, 1e-3));
  for (int i = 0; i < 4; ++i) {
    static_cast<void>(step.after(Vector12::Zero()));
    ContactSolution solution = step.start;
    solution.force += Vector12::Constant(10.0);
    step.estimate.learn(step.model, step.problem, step.workspace, solution);
  }
  step.estimate.forget();
  EXPECT_EQ(step.after(Vector12::Constant(1e-6)), step.start.force);
}

}  // namespace
}  // namespace railtab
