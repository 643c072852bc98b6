// HHT's numerical damping and period error against theory, and the energy of closed systems, by railtab's own steps.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <complex>
#include <cstdio>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "railtab/runtime/base/dense_solvers.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "railtab/runtime/structure/simple_beam.hpp"
#include "railtab/runtime/structure/track_bridge.hpp"
#include "railtab/runtime/vsi/moving_window.hpp"
#include "railtab/runtime/vsi/operator_levels.hpp"
#include "railtab/runtime/vsi/operator_room.hpp"
#include "railtab/runtime/vsi/simulation.hpp"

namespace railtab {
namespace {

constexpr double omega = 2.0 * std::numbers::pi;  // of the sprung mass on a rigid track: a period of 1 s

VsiModel sprung_mass() {
  VsiModel model;
  const std::vector<RigidBody> bodies{{"wheelset", 100.0, {1.0, 1.0, 1.0}, {0.0, 0.0, -0.46}},
                                      {"mass", 5000.0, {1.0, 1.0, 1.0}, {0.0, 0.0, -1.0}}};
  const std::vector<Suspension> spring{
      {0, 1, {0.0, 0.0, -0.7}, {0.0, 0.0, 5000.0 * omega * omega}, Eigen::Vector3d::Zero()}};
  const DofIndices all_but_z{held, held, 0, held, held, held};
  model.vehicle = assemble_vehicle({"sprung mass", bodies, spring, {0}, {all_but_z, all_but_z}, 0.46, 10.0});
  model.vehicle_x = {0.0};
  model.contact.speed = 1.0;
  model.normal_contact = NormalContact::rigid;
  return model;
}

// Free vibration of the mass from rest at 1 mm with its acceleration, step by step.
std::vector<double> free_vibration(double alpha, double time_step, int steps) {
  const VsiModel model = sprung_mass();
  VsiState state(model);
  EXPECT_TRUE(static_equilibrium(model, state).converged);
  const int z = model.vehicle.dof[1][2];
  const double rest = state.vehicle[0].displacement[z];
  state.vehicle[0].displacement[z] += 1e-3;
  state.vehicle[0].acceleration[z] = -omega * omega * 1e-3;
  std::vector<double> u;
  RunObserver observer;
  observer.record = [&](const StepRecord& record) { u.push_back(record.bodies.at(1).displacement[2] - rest); };
  IntegrationParameters integration;
  integration.time_step = time_step;
  integration.alpha = alpha;
  EXPECT_TRUE(simulate(model, integration, steps * time_step, 1, state, observer).complete);
  return u;
}

struct Mode {
  double damping, period_error;
};

Mode mode_of(std::complex<double> root, double step) {
  const double angle = std::abs(std::arg(root)), decay = -std::log(std::abs(root));
  return {decay / std::hypot(angle, decay), omega * step / std::hypot(angle, decay) - 1.0};
}

// The principal root of the characteristic polynomial λ³ − 2 A1 λ² + A2 λ − A3 of HHT on one degree of freedom
// [HHT1977]: the complex one.
std::complex<double> principal_root(double alpha, double step) {
  const double beta = 0.25 * (1 - alpha) * (1 - alpha), gamma = 0.5 - alpha;
  const double W = omega * omega * step * step;
  const double D = 1 + (1 + alpha) * beta * W;
  const double A1 = 1 - W * ((1 + alpha) * (gamma + 0.5) - alpha * beta) / (2 * D);
  const double A2 = 1 - W * (gamma - 0.5 + 2 * alpha * (gamma - beta)) / D;
  const double A3 = alpha * W * (beta - gamma + 0.5) / D;
  Eigen::Matrix3d companion;
  companion << 2 * A1, -A2, A3, 1, 0, 0, 0, 1, 0;
  const Eigen::Vector3cd roots = general_spectrum(companion).values;
  std::complex<double> principal = roots[0];
  for (int i = 1; i < 3; ++i) {
    if (std::abs(roots[i].imag()) > std::abs(principal.imag())) principal = roots[i];
  }
  return principal;
}

// Root of the samples' own two-term recurrence, once the spurious third root has died out.
std::complex<double> measured_root(const std::vector<double>& u, std::size_t first) {
  const auto n = static_cast<Eigen::Index>(u.size() - first - 2);
  Eigen::MatrixXd a(n, 2);
  Eigen::VectorXd b(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::size_t k = first + static_cast<std::size_t>(i);
    a.row(i) << u[k + 1], u[k];
    b[i] = u[k + 2];
  }
  const Eigen::Vector2d pq = least_squares_solution(a, b);
  return pq[0] / 2 + std::sqrt(std::complex<double>(pq[0] * pq[0] / 4 + pq[1]));
}

TEST(Hht, DampingAndPeriodErrorAreThoseOfTheory) {
  for (const double alpha : {0.0, -0.05, -0.1, -0.3}) {
    for (const double step : {0.01, 0.03, 0.1, 0.2, 0.4}) {  // of the period
      const Mode theory = mode_of(principal_root(alpha, step), step);
      const Mode found = mode_of(measured_root(free_vibration(alpha, step, 150), 50), step);
      std::printf("alpha %5.2f, dt/T %.2f: damping %.6f (theory %+.1e off), period error %.6f (%+.1e)\n", alpha, step,
                  found.damping, found.damping - theory.damping, found.period_error,
                  found.period_error - theory.period_error);
      EXPECT_NEAR(found.damping, theory.damping, 1e-7);
      EXPECT_NEAR(found.period_error, theory.period_error, 1e-7);
      // In closed form: Newmark's period is longer by (ωΔt/2)/atan(ωΔt/2) and undamped.
      if (alpha == 0.0) {
        EXPECT_NEAR(found.period_error, 0.5 * omega * step / std::atan(0.5 * omega * step) - 1.0, 1e-7);
        EXPECT_NEAR(found.damping, 0.0, 1e-7);
      }
    }
  }
}

// Kinetic and strain energy of train and structure and the potential of the weights.
double energy(const VsiModel& model, const VsiState& state) {
  double sum = 0.0;
  for (const LinearMotion& m : state.vehicle) {
    sum += 0.5 * m.velocity.dot(model.vehicle.mass * m.velocity) +
           0.5 * m.displacement.dot(model.vehicle.stiffness * m.displacement) -
           model.vehicle.static_load.dot(m.displacement);
  }
  const LinearMotion& s = state.structure.whole();
  return sum + 0.5 * s.velocity.dot(model.structure->mass * s.velocity) +
         0.5 * s.displacement.dot(model.structure->stiffness * s.displacement);
}

// A sprung mass that stands on a beam, both undamped, after a push: Newmark's steps keep the energy of the whole.
TEST(Newmark, KeepsTheEnergyOfAClosedLinearSystem) {
  VsiModel model = sprung_mass();
  model.vehicle_x = {10.3};
  model.contact.speed = 0.0;
  model.structure = share(build_simple_beam({.elements = 10}));
  VsiState state(model);
  ASSERT_TRUE(static_equilibrium(model, state).converged);
  const double at_rest = energy(model, state);
  LinearMotion& mass = state.vehicle[0];
  mass.velocity[model.vehicle.dof[1][2]] = 0.5;  // no force comes with it: accelerations remain zero
  const double pushed = energy(model, state) - at_rest;
  EXPECT_NEAR(pushed, 0.5 * 5000.0 * 0.25, 1e-6);

  IntegrationParameters integration;
  integration.time_step = 1e-3;
  integration.alpha = 0.0;
  double worst = 0.0;
  for (int part = 1; part <= 100; ++part) {
    ASSERT_TRUE(simulate(model, integration, part * 1.0, 1000, state, {}).complete);
    worst = std::max(worst, std::abs((energy(model, state) - at_rest) / pushed - 1.0));
  }
  std::printf("energy over 100000 steps: largest relative change %.2e\n", worst);
  EXPECT_LT(worst, 1e-6);
}

// Steps of more sizes than the three that large operators leave room for: none of these small ones is made twice.
TEST(SharedOperators, KeepStepsOfManySizes) {
  VsiModel model = sprung_mass();
  model.vehicle_x = {5.0};
  TrackParameters track;
  track.length_before = track.length_after = 9.0;
  model.structure = share(build_track_bridge(track, {BridgeParameters{}}, MotionPlane::vertical));
  OperatorLevels levels(model, 0.0, 1e-3);
  const DofRange all{0, model.structure->dofs()};
  const auto factor_of = [&](int level, double end) { return levels.update(level, end, all).structure->factor().id(); };
  std::vector<long> factor;
  for (int level = 0; level < OperatorRoom::most; ++level) {
    factor.push_back(factor_of(level, 1e-3));
  }
  for (int level = 0; level < OperatorRoom::most; ++level) {
    EXPECT_EQ(factor_of(level, 2e-3), factor[static_cast<std::size_t>(level)]) << level;
  }
  levels.update(OperatorRoom::most, 2e-3, all);
  EXPECT_THROW(static_cast<void>(levels.at(1)), std::out_of_range);  // the farthest from the new one
}

// Every move makes a factor: one serves both ends.
TEST(MovingWindow, MovesBothEndsAtOnceByAnEighthOfItsLength) {
  VsiModel model = sprung_mass();
  model.vehicle_x = {100.0};
  model.contact.speed = 40.0;
  TrackParameters track;
  track.length_before = 6.0;
  track.length_after = 600.0;
  model.structure = share(build_track_bridge(track, {}, MotionPlane::vertical));
  model.window = make_window(*model.structure, {.kind = Reduction::window, .ahead = 60.0, .behind = 60.0});
  constexpr double time_step = 5e-3, duration = 8.0, stride = (60.0 + 60.0) / 8.0;
  MovingWindow window(model, time_step);
  VsiState state(model);
  DofRange before = window.move(state);
  int moves = 0;
  for (int step = 1; step * time_step <= duration; ++step) {
    state.time = step * time_step;
    const DofRange range = window.move(state);
    EXPECT_EQ(range.begin != before.begin, range.end() != before.end()) << "at " << state.time << " s";
    if (range != before) ++moves;
    before = range;
  }
  EXPECT_NEAR(moves, model.contact.speed * duration / stride, 1.0);
}

// Operators that have served an earlier run, here from 3 s before to beyond where the window moves, change no bit of
// the next one.
TEST(SharedOperators, LeaveARunAsItIs) {
  VsiModel model = sprung_mass();
  model.vehicle_x = {5.0};
  model.contact.speed = 20.0;
  TrackParameters track;
  track.length_before = track.length_after = 90.0;
  model.structure = share(build_track_bridge(track, {BridgeParameters{}, BridgeParameters{}}, MotionPlane::vertical));
  model.window = make_window(*model.structure, {.kind = Reduction::window});
  IntegrationParameters integration;
  integration.time_step = 5e-3;
  OperatorLevels shared(model, integration.alpha, integration.time_step);
  const auto run = [&](OperatorLevels* operators, double from, double to, VsiState& state) {
    state.time = from;
    ASSERT_TRUE(static_equilibrium(model, state).converged);
    ASSERT_TRUE((operators ? simulate(*operators, integration, to, 1000, state, {})
                           : simulate(model, integration, to, 1000, state, {}))
                    .complete);
  };
  VsiState early(model), again(model), alone(model);
  run(&shared, -3.0, 1.0, early);
  run(&shared, 0.0, 2.0, again);
  run(nullptr, 0.0, 2.0, alone);
  EXPECT_GT(alone.structure.whole().displacement.cwiseAbs().maxCoeff(), 0.0);
  EXPECT_EQ(again.structure.whole().displacement, alone.structure.whole().displacement);
  EXPECT_EQ(again.vehicle[0].acceleration, alone.vehicle[0].acceleration);
  EXPECT_EQ(again.contact.end_force, alone.contact.end_force);
}

}  // namespace
}  // namespace railtab
