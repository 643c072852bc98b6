// Shooting and continuation on a motion whose limit cycles are known in closed form: the normal form of a subcritical
// bifurcation whose cycles come back [Strogatz2018, section 8.2],
//     ṙ = r (μ + r² − r⁴),   θ̇ = 2 + r²,   ż = −z + x,      x = r cos θ, y = r sin θ,  μ = λ − 1
// has cycles of radius r at μ = r⁴ − r², a fold at r² = ½, μ = −¼, periods 2π/(2 + r²) and the multipliers
// exp(T (2r² − 4r⁴)) and exp(−T).

#include "railtab/runtime/stability/cycle_branch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../validation/runge_kutta.hpp"

namespace railtab {
namespace {

using State = std::array<double, 3>;

class NormalForm : public Flow {
 public:
  [[nodiscard]] std::optional<Eigen::VectorXd> end(const Eigen::VectorXd& start, const SteppedTime& time,
                                                   double parameter) const override {
    State s{start[0], start[1], start[2]};
    const auto rate = [&](const State& at) {
      const double r2 = at[0] * at[0] + at[1] * at[1], grows = parameter - 1.0 + r2 - r2 * r2, turns = 2.0 + r2;
      return State{grows * at[0] - turns * at[1], grows * at[1] + turns * at[0], at[0] - at[2]};
    };
    for (int i = 0; i < time.steps; ++i) runge_kutta_step(rate, time.duration / time.steps, s);
    return Eigen::Vector3d(s[0], s[1], s[2]);
  }
  [[nodiscard]] std::optional<FlowEnd> end_with_derivatives(const Eigen::VectorXd& start, const SteppedTime& time,
                                                            double parameter) const override {
    constexpr double h = 1e-6;
    FlowEnd result;
    result.state = *end(start, time, parameter);
    result.by_state.resize(3, 3);
    for (int k = 0; k < 3; ++k) {
      const Eigen::VectorXd step = h * Eigen::VectorXd::Unit(3, k);
      result.by_state.col(k) = (*end(start + step, time, parameter) - *end(start - step, time, parameter)) / (2.0 * h);
    }
    const auto later = end(start, {time.duration + h, time.steps}, parameter);
    const auto earlier = end(start, {time.duration - h, time.steps}, parameter);
    result.by_time = (*later - *earlier) / (2.0 * h);
    result.by_parameter = (*end(start, time, parameter + h) - *end(start, time, parameter - h)) / (2.0 * h);
    return result;
  }
  [[nodiscard]] const Eigen::VectorXd& unit() const override { return unit_; }

 private:
  Eigen::VectorXd unit_ = Eigen::VectorXd::Ones(3);
};

// Cycles begin at y = 0, where x is the radius.
constexpr CycleSection section{0, 1};

double radius_squared(const PeriodicMotion& motion) { return motion.start[0] * motion.start[0]; }

CycleBranch branch_of(const NormalForm& flow, const BranchSearch& search) {
  const double r = 0.1;
  const PeriodicMotion guess{Eigen::Vector3d(r, 0.0, 0.0), stepped_time(std::numbers::pi, search.time_step), 1.0};
  return follow_branch(flow, section, {guess, {{r, 1.0}, {1.0, 0.0}}, {1.0, 0.0}}, search, {});
}

BranchSearch search_of(double time_step) {
  return {.unit = {1.0, 1.0},
          .first_step = 0.02,
          .smallest_step = 1e-4,
          .largest_step = 0.05,
          .lowest_parameter = 0.5,
          .highest_parameter = 1.5,
          .lowest_height = 0.05,
          .highest_height = 2.0,
          .time_step = time_step,
          .max_cycles = 200,
          .parameter_tolerance = 1e-8,
          .shooting = {.tolerance = 1e-10, .relative_tolerance = 0.0}};
}

TEST(CycleBranch, IsThatOfTheNormalForm) {
  const NormalForm flow;
  const CycleBranch branch = branch_of(flow, search_of(0.01));
  EXPECT_EQ(branch.end, BranchEnd::parameter_range);
  ASSERT_GT(branch.cycles.size(), 20u);
  for (const BranchCycle& cycle : branch.cycles) {
    const double r2 = radius_squared(cycle.motion), T = 2.0 * std::numbers::pi / (2.0 + r2);
    const double growth = 2.0 * r2 - 4.0 * r2 * r2;
    EXPECT_NEAR(cycle.motion.parameter, 1.0 + r2 * r2 - r2, 1e-7);
    EXPECT_NEAR(cycle.motion.period.duration, T, 1e-7);
    EXPECT_NEAR(cycle.multipliers[0].real(), std::max(std::exp(T * growth), std::exp(-T)), 1e-6);
    EXPECT_EQ(cycle.is_stable(), growth < 0.0);
    EXPECT_LT(cycle.error_along_motion, 1e-6);
  }
}

TEST(CycleBranch, FindsItsFold) {
  const NormalForm flow;
  const BranchSearch search = search_of(0.01);
  const CycleBranch branch = branch_of(flow, search);
  const auto lowest = std::min_element(branch.cycles.begin(), branch.cycles.end(), [](const auto& a, const auto& b) {
    return a.motion.parameter < b.motion.parameter;
  });
  const auto fold = fold_near(flow, section, branch, static_cast<std::size_t>(lowest - branch.cycles.begin()), search);
  ASSERT_TRUE(fold);
  EXPECT_NEAR(fold->motion.parameter, 0.75, 1e-7);
  EXPECT_NEAR(radius_squared(fold->motion), 0.5, 1e-3);
  EXPECT_NEAR(fold->multipliers[0].real(), 1.0, 1e-2);
}

// The branch goes back the way that it came.
TEST(CycleBranch, CanBeFollowedBothWays) {
  const NormalForm flow;
  const BranchSearch search = search_of(0.01);
  const double r = 1.1;
  const PeriodicMotion guess{Eigen::Vector3d(r, 0.0, 0.5), stepped_time(2.0, search.time_step), 1.2};
  const CycleBranch branch = follow_branch(flow, section, {guess, {{r, 1.2}, {0.0, 1.0}}, {0.0, -1.0}}, search, {});
  ASSERT_GT(branch.cycles.size(), 20u);
  EXPECT_EQ(branch.end, BranchEnd::height_range);
  EXPECT_GE(branch.cycles.back().motion.point(section).height, search.lowest_height);
  EXPECT_LT(branch.cycles.back().motion.point(section).height, search.lowest_height + 0.01);
  EXPECT_NEAR(branch.cycles.front().motion.parameter, 1.2, 1e-9);
}

// Rest solves the equations of a cycle, too: below the fold nothing else does.
TEST(CycleBranch, RestIsNoCycle) {
  const NormalForm flow;
  const BranchSearch search = search_of(0.01);
  const PeriodicMotion guess{Eigen::Vector3d(0.1, 0.0, 0.0), stepped_time(3.0, search.time_step), 0.7};
  const CycleBranch branch = follow_branch(flow, section, {guess, {{0.1, 0.7}, {0.0, 1.0}}, {0.0, 1.0}}, search, {});
  EXPECT_TRUE(branch.cycles.empty());
}

TEST(CycleBranch, SaysWhereItEnds) {
  const NormalForm flow;
  BranchSearch search = search_of(0.01);
  search.max_cycles = 3;
  EXPECT_EQ(branch_of(flow, search).end, BranchEnd::max_cycles);
  search.shooting.max_iterations = 0;
  const CycleBranch none = branch_of(flow, search);
  EXPECT_TRUE(none.cycles.empty());
  EXPECT_EQ(none.end, BranchEnd::no_convergence);
}

}  // namespace
}  // namespace railtab
