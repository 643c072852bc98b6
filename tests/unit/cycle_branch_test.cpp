// Shooting and continuation on a motion whose limit cycles are known in closed form:
//     ṙ = r (λ − c(r)),   θ̇ = 2 + r²,   ż = −z + x,      x = r cos θ, y = r sin θ
// has cycles of radius r at λ = c(r), folds where c'(r) = 0, periods T = 2π/(2 + r²) and the multipliers
// exp(−T r c'(r)) and exp(−T). With c = 1 + r⁴ − r² it is the normal form of a subcritical bifurcation whose cycles
// come back [Strogatz2018, section 8.2]: a fold at r² = ½, λ = ¾.

#include "railtab/runtime/stability/branch_folds.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <numbers>
#include <utility>

#include "../validation/runge_kutta.hpp"

namespace railtab {
namespace {

using State = std::array<double, 3>;

using Curve = std::function<double(double)>;

double subcritical(double r) { return 1.0 + std::pow(r, 4) - r * r; }

class NormalForm : public Flow {
 public:
  explicit NormalForm(Curve curve = subcritical) : curve_(std::move(curve)) {}
  [[nodiscard]] std::optional<Eigen::VectorXd> end(const Eigen::VectorXd& start, const SteppedTime& time,
                                                   double parameter) const override {
    State s{start[0], start[1], start[2]};
    if (unknown_.first < start[0] && start[0] < unknown_.second) return {};
    const auto rate = [&](const State& at) {
      const double r = std::hypot(at[0], at[1]), grows = parameter - curve_(r), turns = 2.0 + r * r;
      return State{grows * at[0] - turns * at[1], grows * at[1] + turns * at[0], at[0] - at[2]};
    };
    for (int i = 0; i < time.steps; ++i) runge_kutta_step(rate, time.duration / time.steps, s);
    return Eigen::Vector3d(s[0], s[1], s[2]);
  }
  [[nodiscard]] std::optional<FlowEnd> end_with_derivatives(const Eigen::VectorXd& start, const SteppedTime& time,
                                                            double parameter) const override {
    constexpr double h = 1e-6;
    if (!end(start, time, parameter)) return {};
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
  /// No motion that begins at these x is found.
  void forget(double from, double to) { unknown_ = {from, to}; }

 private:
  Curve curve_;
  std::pair<double, double> unknown_{0.0, 0.0};
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

// Branches of cycles with given radii, in their order.
CycleBranch branch_of_radii(const NormalForm& flow, const Curve& curve, const BranchSearch& search,
                            std::initializer_list<double> radii) {
  CycleBranch branch;
  Shooting shooting(flow, section, search.shooting);
  for (const double r : radii) {
    const PeriodicMotion guess{Eigen::Vector3d(r, 0.0, 0.3 * r),
                               stepped_time(2.0 * std::numbers::pi / (2.0 + r * r), search.time_step), curve(r)};
    auto cycle = cycle_near(shooting, section, guess, {{r, curve(r)}, {1.0, 0.0}}, search);
    EXPECT_TRUE(cycle) << r;
    if (cycle) branch.cycles.push_back(*cycle);
  }
  return branch;
}

double radius(const BranchCycle& cycle) { return cycle.motion.start[0]; }

// Of these radii, within their brackets.
void expect_folds(const std::vector<BranchFold>& folds, const std::vector<double>& radii, const Curve& curve) {
  ASSERT_EQ(folds.size(), radii.size());
  for (std::size_t i = 0; i < radii.size(); ++i) {
    EXPECT_TRUE(folds[i].converged);
    EXPECT_NEAR(folds[i].cycle.motion.parameter, curve(radii[i]), 1e-7);
    EXPECT_NEAR(radius(folds[i].cycle), radii[i], 1e-3);
    EXPECT_LT(radius(folds[i].bracket[0]), radii[i]);
    EXPECT_GT(radius(folds[i].bracket[1]), radii[i]);
    EXPECT_NEAR(folds[i].cycle.multipliers[0].real(), 1.0, 1e-2);
  }
}

TEST(BranchFolds, FindThatOfTheNormalForm) {
  const NormalForm flow;
  const BranchSearch search = search_of(0.01);
  expect_folds(branch_folds(flow, section, branch_of(flow, search), search), {std::sqrt(0.5)}, subcritical);
}

// A branch with steps so short that none of those beside the fold changes the parameter by much.
TEST(BranchFolds, AreFoundWhateverTheSteps) {
  const NormalForm flow;
  BranchSearch search = search_of(0.01);
  search.largest_step = 0.01;
  const CycleBranch branch = branch_of(flow, search);
  const auto parameter = [&](std::size_t i) { return branch.cycles[i].motion.parameter; };
  std::size_t lowest = 0;
  for (std::size_t i = 0; i < branch.cycles.size(); ++i) lowest = parameter(i) < parameter(lowest) ? i : lowest;
  EXPECT_LT(std::max(parameter(lowest - 1), parameter(lowest + 1)) - parameter(lowest), 5e-4);
  expect_folds(branch_folds(flow, section, branch, search), {std::sqrt(0.5)}, subcritical);
}

// c has a maximum at 0.5, a minimum at 0.7, a maximum at 0.9.
double wave(double r) { return 1.0 + 0.05 * std::cos(5.0 * std::numbers::pi * (r - 0.5)); }

TEST(BranchFolds, AreFoundWhateverTheSignsOfTheChanges) {
  const NormalForm flow(wave);
  const BranchSearch search = search_of(0.01);
  const auto folds = [&](std::initializer_list<double> radii) {
    return branch_folds(flow, section, branch_of_radii(flow, wave, search, radii), search);
  };
  expect_folds(folds({0.42, 0.49, 0.58, 0.66, 0.71, 0.8, 0.89, 1.0}), {0.5, 0.7, 0.9}, wave);
  expect_folds(folds({0.45, 0.6, 0.75}), {0.5, 0.7}, wave);  // parameters fall throughout
  expect_folds(folds({0.45, 0.56}), {0.5}, wave);            // in the only step
  expect_folds(folds({0.45, 0.55, 0.6}), {0.5}, wave);       // beside two of one parameter
  expect_folds(folds({0.4, 0.48, 0.5, 0.52}), {0.5}, wave);  // at one of the cycles
  expect_folds(folds({0.47, 0.74}), {0.5, 0.7}, wave);       // two in one step
  expect_folds(folds({0.52, 0.6, 0.68}), {}, wave);          // none
}

// Cycles of all radii at one parameter, as those of a linear vehicle: what errors leave of differences is no fold.
TEST(BranchFolds, OfEqualParametersAreNone) {
  const Curve curve = [](double) { return 1.0; };
  const NormalForm flow(curve);
  BranchSearch search = search_of(0.05);
  search.shooting.tolerance = 1e-5;
  const CycleBranch branch =
      branch_of_radii(flow, curve, search, {0.1, 0.12, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9});
  double largest = 0.0;
  for (const BranchCycle& cycle : branch.cycles) largest = std::max(largest, std::abs(cycle.motion.parameter - 1.0));
  EXPECT_GT(largest, search.parameter_tolerance) << "nothing to mistake";
  EXPECT_TRUE(branch_folds(flow, section, branch, search).empty());
}

// Where no cycle is found about the fold, it is reported with the bracket that remains.
TEST(BranchFolds, KeepTheirBracketsWithoutConvergence) {
  NormalForm flow;
  const BranchSearch search = search_of(0.01);
  const double fold = std::sqrt(0.5);
  for (const auto& radii :
       {std::initializer_list<double>{0.5, 0.6, 0.68, 0.75, 0.9}, std::initializer_list<double>{0.6, 0.82}}) {
    flow.forget(0.0, 0.0);
    const CycleBranch branch = branch_of_radii(flow, subcritical, search, radii);
    flow.forget(0.69, 0.73);
    const std::vector<BranchFold> folds = branch_folds(flow, section, branch, search);
    ASSERT_EQ(folds.size(), 1u);
    EXPECT_FALSE(folds[0].converged);
    EXPECT_LT(radius(folds[0].bracket[0]), fold);
    EXPECT_GT(radius(folds[0].bracket[1]), fold);
  }
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
