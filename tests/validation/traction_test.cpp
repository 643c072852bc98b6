// The wheelset's rotation speed as an unknown: a torque on the axle, and free rolling.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "hunting_model.hpp"

namespace railtab::hunting {
namespace {

constexpr double axle_inertia = 168.0, speed = 80.0;

VsiModel freely_turning(const DofIndices& dofs, double V) {
  VsiModel model = wheelset({}, V);
  DofIndices none;
  none.fill(held);
  const Eigen::Vector3d k(135e3, 250e3, 0.0);
  model.vehicle = assemble_vehicle(
      {"turning wheelset",
       {{"frame", 1.0, {1.0, 1.0, 1.0}, {0.0, 0.0, -R0}},
        {"wheelset", 1568.0, {656.0, axle_inertia, 656.0}, {0.0, 0.0, -R0}}},
       {{0, 1, {0.0, -l, -R0}, k, Eigen::Vector3d::Zero()}, {0, 1, {0.0, l, -R0}, k, Eigen::Vector3d::Zero()}},
       {1},
       {none, dofs},
       R0,
       10.0});
  return model;
}

struct Axle {
  std::vector<double> t, rate;    ///< deviation from V/R0, about y [rad/s]
  std::vector<double> X, X_left;  ///< longitudinal force on both rails, and on the left one [N]
};

Axle turn(const VsiModel& model, VsiState& state, ContactForceRule rule, double time_step, double duration) {
  Axle axle;
  RunObserver observer;
  observer.record = [&](const StepRecord& record) {
    axle.t.push_back(record.time);
    axle.rate.push_back(record.bodies.at(1).velocity[4]);
    axle.X.push_back(record.wheels[0].X + record.wheels[1].X);
    axle.X_left.push_back(record.wheels[0].X);
  };
  IntegrationParameters integration;
  integration.time_step = time_step;
  integration.alpha = 0.0;
  integration.contact_force = rule;
  EXPECT_TRUE(simulate(model, integration, duration, 1, state, observer).complete);
  return axle;
}

class Traction : public ::testing::TestWithParam<ContactForceRule> {};

// Creepage is R0 ω/V, the rails answer with -2 f11 of it at the radius R0: J ω' = T - (2 R0² f11/V) ω.
TEST_P(Traction, BrakedWheelsetFollowsNewtonsLaw) {
  constexpr double torque = 5000.0;  // N m, about y: against the rolling
  VsiModel model = freely_turning({held, held, 0, held, 0, held}, speed);
  const int pitch = model.vehicle.dof[1][4];
  VsiState state(model);
  ASSERT_TRUE(static_equilibrium(model, state).converged);
  const double free_rate = state.vehicle[0].velocity[pitch];
  model.vehicle.static_load[pitch] = torque;
  state.vehicle[0].acceleration[pitch] = torque / axle_inertia;
  const Axle axle = turn(model, state, GetParam(), 1e-4, 0.03);

  const double f11 = 82e9 * 4.523 * 5.667e-3 * 4.284e-3;
  const double end = torque * speed / (2.0 * R0 * R0 * f11);
  const double time_constant = axle_inertia * end / torque;
  double miss = 0.0;
  for (std::size_t i = 0; i < axle.t.size(); ++i) {
    const double wanted = end * (1.0 - std::exp(-axle.t[i] / time_constant));
    miss = std::max(miss, std::abs(axle.rate[i] - free_rate - wanted));
  }
  std::printf("braked: time constant %.3f ms, creepage %.3e, largest difference of the rate %.2e of its end\n",
              1e3 * time_constant, R0 * end / speed, miss / end);
  EXPECT_LT(miss, 2e-3 * end);
  EXPECT_NEAR(axle.X.back() * R0, torque, 2e-3 * torque);  // the rails are pushed forward
}

// Hunting at constant speed: what one wheel gains the other loses, and the axle's torque has no mean. (With spin creep
// the wheels' spin moments, tilted by the cones, hold a tenth of a newton up.)
TEST_P(Traction, FreeRollingNeedsNoLongitudinalForceOnAverage) {
  const VsiModel model = freely_turning({held, 0, 0, held, 0, 0}, 60.0);
  const int y = model.vehicle.dof[1][1], pitch = model.vehicle.dof[1][4];
  VsiState state(model);
  ASSERT_TRUE(static_equilibrium(model, state).converged);
  state.vehicle[0].displacement[y] += 2e-4;
  const double before = state.vehicle[0].velocity[pitch];
  const Axle axle = turn(model, state, GetParam(), 5e-4, 2.0);
  double impulse = 0.0, mean = 0.0, peak = 0.0;
  for (std::size_t i = 1; i < axle.t.size(); ++i) {
    impulse += 0.5 * (axle.X[i - 1] + axle.X[i]) * (axle.t[i] - axle.t[i - 1]);
    mean += axle.X[i] / static_cast<double>(axle.X.size() - 1);
    peak = std::max(peak, std::abs(axle.X_left[i]));
  }
  const double gained = axle_inertia * (axle.rate.back() - before);
  std::printf(
      "free rolling: mean longitudinal force %.2e of one wheel's largest, %.1f N; axle %+.2e N m s, forces %+.2e\n",
      mean / peak, peak, gained, -R0 * impulse);
  EXPECT_GT(peak, 50.0);
  EXPECT_LT(std::abs(mean), 1e-3 * peak);
  EXPECT_NEAR(gained, -R0 * impulse, 1e-3 * R0 * peak * axle.t.back());
}

INSTANTIATE_TEST_SUITE_P(Rules, Traction, ::testing::Values(ContactForceRule::endpoint, ContactForceRule::energy),
                         [](const auto& rule) {
                           return rule.param == ContactForceRule::energy ? "energy" : "endpoint";
                         });

}  // namespace
}  // namespace railtab::hunting
