// Limit cycles of a suspended wheelset whose lateral suspension meets stops, or softens before it does: shooting and
// continuation against time integration of its equations of motion by another scheme, and the order of the time step.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "../measured.hpp"
#include "hunting_model.hpp"
#include "railtab/runtime/stability/hunting_branch.hpp"
#include "runge_kutta.hpp"

namespace railtab::hunting {
namespace {

constexpr double free_travel = 0.5e-3, stop_stiffness = 2e6;  // m, N/m

// Model B of hunting_test.cpp under a load with which no wheel lifts: its roll is held, so that a shift of 1 mm raises
// a wheel by a third of its penetration.
VsiModel loaded_wheelset(double speed) {
  VsiModel model = wheelset({}, speed);
  model.vehicle.static_load[model.vehicle.dof[1][2]] = 2.0 * 50e3;
  return model;
}

// The same with a force element between frame and wheelset.
VsiModel wheelset_with(const ForceCurve& curve, double speed) {
  VsiModel model = loaded_wheelset(speed);
  ForceElements& elements = model.vehicle.elements;
  elements.rows = Eigen::RowVectorXd::Unit(model.vehicle.dofs(), model.vehicle.dof[1][1]);
  ForceElement stop;
  stop.name = "stop";
  stop.kind = ForceElementKind::stop;
  stop.row = 0;
  stop.curve = curve;
  elements.element = {stop};
  return model;
}

VsiModel wheelset_with_stop(double speed) {
  return wheelset_with(ForceCurve({{free_travel, 0.0}, {2.0 * free_travel, stop_stiffness * free_travel}}), speed);
}

double stop_force(double y) { return std::copysign(stop_stiffness * std::max(0.0, std::abs(y) - free_travel), y); }

// A spring of slope k (1 − (y/y0)²)²: its stiffness over a harmonic motion of amplitude A is k (1 − x/2 + x²/8) with
// x = (A/y0)², least at A = √2 y0.
constexpr double spring_stiffness = 100e3, flat_at = 0.3e-3;  // k [N/m], y0 [m]

double softening_force(double y) {
  const double x = y * y / (flat_at * flat_at);
  return spring_stiffness * y * (1.0 - 2.0 / 3.0 * x + x * x / 5.0);
}

ForceCurve softening_curve() {
  std::vector<std::array<double, 2>> points;
  for (int i = 1; i <= 100; ++i) points.push_back({1e-5 * i, softening_force(1e-5 * i)});
  return ForceCurve(points);
}

// Eq. 18 of [MontenegroCalcada2023] with a further lateral force: y, y', yaw, yaw'.
class Equations {
 public:
  Equations(double speed, double (*force)(double)) : V_(speed), force_(force) {}
  using State = std::array<double, 4>;
  [[nodiscard]] State rate(const State& s) const {
    constexpr double m = 1568.0, Iz = 656.0, kx = 135e3, ky = 250e3, conicity = 0.025;
    constexpr double Gab = 82e9 * 5.667e-3 * 4.284e-3, fx = 4.523 * Gab, fy = 4.121 * Gab;
    const double creep_x = Lcp * s[3] / V_ + conicity * s[0] / R0, creep_y = s[1] / V_ - s[2];
    return {s[1], (-2.0 * fy * creep_y - 2.0 * ky * s[0] - force_(s[0])) / m, s[3],
            (-2.0 * Lcp * fx * creep_x - 2.0 * kx * l * l * s[2]) / Iz};
  }

 private:
  double V_;
  double (*force_)(double);
};

struct Steady {
  double amplitude, frequency;  // m, Hz
};

// What the equations settle on from 1 mm on, by the maxima of the last of many cycles.
Steady settled(double speed, double (*force)(double)) {
  const Equations equations(speed, force);
  Equations::State s{1e-3, 0.0, 0.0, 0.0};
  constexpr double dt = 2e-4, end = 150.0, counted_from = 140.0;
  double first = 0.0, last = 0.0, height = 0.0;
  int crossings = 0;
  for (double t = 0.0; t < end; t += dt) {
    const double before = s[0];
    runge_kutta_step([&](const Equations::State& at) { return equations.rate(at); }, dt, s);
    if (t < counted_from) continue;
    height = std::max(height, s[0]);
    if (before < 0.0 && s[0] >= 0.0) {
      last = t - dt * before / (s[0] - before);
      if (crossings++ == 0) first = last;
    }
  }
  return {height, (crossings - 1) / (last - first)};
}

HuntingSearch search_to(double kmh) {
  HuntingSearch search;
  search.speed = {.low = 40.0, .high = kmh / 3.6, .step = 5.0};
  search.time_step = 2e-3;
  search.largest_step = 1.0;
  return search;
}

const HuntingBranch& branch() {
  static const HuntingBranch found =
      hunting_branch(loaded_wheelset(60.0), wheelset_with_stop(60.0), search_to(280.0), {});
  return found;
}

// Amplitude and frequency of the branch at a speed, between its cycles.
Steady on_branch(double speed) {
  const std::vector<LimitCycle>& cycles = branch().cycles;
  for (std::size_t i = 1; i < cycles.size(); ++i) {
    const LimitCycle &a = cycles[i - 1], &b = cycles[i];
    if ((a.speed - speed) * (b.speed - speed) > 0.0) continue;
    const double share = (speed - a.speed) / (b.speed - a.speed);
    return {a.amplitude() + share * (b.amplitude() - a.amplitude()), a.frequency + share * (b.frequency - a.frequency)};
  }
  return {};
}

TEST(LimitCycle, OfAWheelsetBetweenStopsIsThatOfTheEquationsOfMotion) {
  double amplitude = 0.0, frequency = 0.0;
  for (const double kmh : {245.0, 260.0, 275.0}) {
    const Steady found = on_branch(kmh / 3.6), expected = settled(kmh / 3.6, stop_force);
    std::printf("%3.0f km/h: amplitude %.5f mm, equations %.5f mm; %.5f Hz, equations %.5f Hz\n", kmh,
                1e3 * found.amplitude, 1e3 * expected.amplitude, found.frequency, expected.frequency);
    amplitude = std::max(amplitude, std::abs(found.amplitude / expected.amplitude - 1.0));
    frequency = std::max(frequency, std::abs(found.frequency / expected.frequency - 1.0));
  }
  testing::measured("limit_cycle.stop_amplitude_percent", 100 * amplitude);
  testing::measured("limit_cycle.stop_frequency_percent", 100 * frequency);
  EXPECT_LT(amplitude, 2e-3);
  EXPECT_LT(frequency, 1e-3);
}

// Up to the stops the wheelset is linear: its cycles of all amplitudes have the linear critical speed. The stops
// stiffen it: cycles beyond are stable and faster.
TEST(LimitCycle, BranchRisesFromTheLinearCriticalSpeed) {
  const HuntingBranch& found = branch();
  ASSERT_TRUE(found.linear.critical);
  EXPECT_EQ(found.end, BranchEnd::parameter_range);
  for (const LimitCycle& cycle : found.cycles) {
    EXPECT_LT(cycle.residual, 1e-6 + 2e-5 * 1e3 * cycle.amplitude());
    if (cycle.amplitude() < free_travel) {
      EXPECT_NEAR(cycle.speed / found.linear.critical->speed, 1.0, 1e-4);
      EXPECT_NEAR(std::abs(cycle.multiplier), 1.0, 1e-3);
    } else if (cycle.amplitude() > 1.1 * free_travel) {
      EXPECT_TRUE(cycle.is_stable());
      EXPECT_GT(cycle.speed, found.linear.critical->speed);
    }
  }
  EXPECT_NEAR(*found.nonlinear_critical_speed() / found.linear.critical->speed, 1.0, 1e-4);
}

// The spring softens, then stiffens: the branch falls from the linear critical speed and rises after a fold, below
// which the equations come to rest from 1 mm on and above which they settle on a cycle of more than the fold's
// amplitude.
TEST(LimitCycle, FoldIsWhereTheEquationsHaveNoCycleBelow) {
  VsiModel linear = loaded_wheelset(60.0);
  const int y = linear.vehicle.dof[1][1];
  linear.vehicle.stiffness(y, y) += spring_stiffness;
  HuntingSearch search = search_to(260.0);
  search.time_step = 4e-3;
  search.first_amplitude = flat_at;
  search.largest_step = 0.01;
  search.max_cycles = 45;
  const HuntingBranch found = hunting_branch(linear, wheelset_with(softening_curve(), 60.0), search, {});
  EXPECT_EQ(found.bifurcation, Bifurcation::subcritical);
  ASSERT_EQ(found.folds.size(), 1u);
  const LimitCycleFold& fold = found.folds.front();
  EXPECT_TRUE(fold.converged);
  const auto slowest = std::min_element(found.cycles.begin(), found.cycles.end(),
                                        [](const auto& a, const auto& b) { return a.speed < b.speed; });
  EXPECT_LT(std::max(slowest[-1].speed, slowest[1].speed) - slowest->speed, 1e-2);
  EXPECT_EQ(fold.cycle.speed, *found.nonlinear_critical_speed());
  EXPECT_NEAR(std::abs(fold.cycle.multiplier), 1.0, 1e-2);
  EXPECT_NEAR(fold.cycle.amplitude(), std::numbers::sqrt2 * flat_at, 0.05 * flat_at);
  std::printf("fold at %.4f m/s with %.4f mm\n", fold.cycle.speed, 1e3 * fold.cycle.amplitude());
  EXPECT_LT(settled(0.997 * fold.cycle.speed, softening_force).amplitude, 1e-6);
  EXPECT_GT(settled(1.003 * fold.cycle.speed, softening_force).amplitude, fold.cycle.amplitude());
}

TEST(LimitCycle, LinearisedStepsAreTheDerivativesOfTheSteps) {
  const LimitCycle& cycle = branch().cycles.back();
  const VehicleFlow flow(wheelset_with_stop(60.0), 0.0);
  const auto end = flow.end_with_derivatives(cycle.motion.start, cycle.motion.period, cycle.speed);
  ASSERT_TRUE(end);
  const Eigen::VectorXd& unit = flow.unit();
  double largest = 0.0, error = 0.0;
  for (Eigen::Index k = 0; k < unit.size(); ++k) {
    const Eigen::VectorXd step = 1e-4 * unit[k] * Eigen::VectorXd::Unit(unit.size(), k);
    const auto ahead = flow.end(cycle.motion.start + step, cycle.motion.period, cycle.speed);
    const auto behind = flow.end(cycle.motion.start - step, cycle.motion.period, cycle.speed);
    ASSERT_TRUE(ahead && behind);
    const Eigen::VectorXd column = (*ahead - *behind).cwiseQuotient(unit) / 2e-4;
    largest = std::max(largest, column.cwiseAbs().maxCoeff());
    error = std::max(error, (column - (unit[k] * end->by_state.col(k)).cwiseQuotient(unit)).cwiseAbs().maxCoeff());
  }
  std::printf("largest derivative %.4f, error %.2e\n", largest, error);
  EXPECT_LT(error, 5e-3 * largest);
}

// Newmark's scheme: the speed of a cycle of given amplitude has an error of second order.
TEST(LimitCycle, SpeedOfACycleIsOfSecondOrderInTheTimeStep) {
  const LimitCycle& cycle = branch().cycles.back();
  const VehicleFlow flow(wheelset_with_stop(60.0), 0.0);
  const CycleSection section = flow.lateral_section(0);
  const auto speed = [&](int steps) {
    Shooting shooting(flow, section, {.tolerance = 1e-8, .relative_tolerance = 0.0});
    PeriodicMotion guess = cycle.motion;
    guess.period.steps = steps;
    const auto found = shooting.solve(guess, {guess.point(section), {1e3, 0.0}});
    EXPECT_TRUE(found);
    return found ? found->parameter : 0.0;
  };
  const double coarse = speed(40), middle = speed(80), fine = speed(160);
  const double order = std::log2((coarse - middle) / (middle - fine));
  std::printf("speed %.6f, %.6f, %.6f m/s with 40, 80, 160 steps: order %.2f\n", coarse, middle, fine, order);
  testing::measured("limit_cycle.order", order);
  EXPECT_GT(order, 1.7);
  EXPECT_LT(order, 2.3);
}

}  // namespace
}  // namespace railtab::hunting
