// Changes of the speed of a coach and of a mass, against equations of motion solved otherwise.

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "../measured.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "railtab/runtime/structure/simple_beam.hpp"
#include "railtab/runtime/vsi/simulation.hpp"

namespace railtab {
namespace {

constexpr double pi = std::numbers::pi;

SceneParameters coach_on_rigid_track() {
  SceneParameters scene;
  scene.contact.mode = ContactMode::online;
  scene.track_kind = TrackKind::rigid;
  scene.train.speed = 40.0;
  scene.train.force_elements = ForceElementChoice::linear;
  return scene;
}

TEST(SpeedProfile, ConstantProfileIsConstantSpeed) {
  SceneParameters scene = coach_on_rigid_track();
  scene.train.initial_lateral_shift = 2e-3;
  scene.integration.duration = 0.1;
  const VsiModel constant = build_model(scene);
  VsiModel profile = constant;
  profile.speed_profile.emplace(std::vector<double>{0.0, 1.0}, std::vector<double>{40.0, 40.0});
  std::array<StepRecord, 2> last;
  for (const VsiModel* model : std::initializer_list<const VsiModel*>{&constant, &profile}) {
    VsiState state(*model);
    ASSERT_TRUE(steady_start(*model, state).converged);
    for (LinearMotion& motion : state.vehicle) motion.velocity[model->vehicle.dof[0][1]] = 0.05;
    RunObserver observer;
    observer.record = [&](const StepRecord& r) { last[model == &constant ? 0 : 1] = r; };
    ASSERT_TRUE(simulate(*model, scene.integration, 0.1, 100, state, observer).complete);
  }
  for (std::size_t wheel = 0; wheel < 8; ++wheel) {
    EXPECT_NEAR(last[0].wheels[wheel].Q, last[1].wheels[wheel].Q, 1e-3);
    EXPECT_NEAR(last[0].wheels[wheel].Y, last[1].wheels[wheel].Y, 1e-3);
  }
  EXPECT_NEAR(last[0].position, last[1].position, 1e-12);
}

TEST(SpeedProfile, RailsSlowTheWheelsRotation) {
  // J_y dΩ/dt = R·F_x with Ω = V/R: every wheelset pushes its rails back by J_y/R² times its deceleration, the train's
  // and that of its own surging on the longitudinal springs, which have no damping.
  constexpr double braking = 1.0;  // m/s²
  SceneParameters scene = coach_on_rigid_track();
  scene.integration.time_step = 1e-3;
  scene.integration.duration = 3.0;
  VsiModel model = build_model(scene);
  model.speed_profile.emplace(std::vector<double>{0.0, 1.0, 11.0},
                              std::vector<double>{40.0, 40.0, 40.0 - 10.0 * braking});
  VsiState state(model);
  ASSERT_TRUE(steady_start(model, state).converged);
  double X = 0.0, acceleration = 0.0, position = 0.0;
  int n = 0;
  RunObserver observer;
  observer.record = [&](const StepRecord& r) {
    position = r.position;
    if (r.time < 2.0) return;  // the shock of the braking's begin has to die out
    for (const WheelRecord& wheel : r.wheels) X += wheel.X;
    for (std::size_t b = 3; b < 7; ++b) acceleration += r.bodies[b].acceleration[0] - braking;
    ++n;
  };
  ASSERT_TRUE(simulate(model, scene.integration, scene.integration.duration, 1, state, observer).complete);
  const double expected = 112.0 / (0.46 * 0.46) * acceleration / n;
  EXPECT_NEAR(acceleration / n, -4.0 * braking, 0.4 * braking);
  std::printf("force on the rails by the wheels' rotation: %.1f N, expected %.1f N\n", X / n, expected);
  testing::measured("braking.force_percent", 100 * std::abs(X / n / expected - 1));
  EXPECT_NEAR(X / n, expected, 0.01 * std::abs(expected));
  EXPECT_NEAR(position, 40.0 * 3.0 - 0.5 * braking * 4.0, 1e-9);
}

// A mass that runs over a simple beam while it brakes: the beam's first modes with the mass on them,
//   (μL/2 δ_ij + m φ_i φ_j) q'' = m φ_i (g − 2V φ_j' q' − (V² φ_j'' + V' φ_j') q) − μL/2 ω_i² q_i,
// by Runge–Kutta steps.
class BrakingMass {
 public:
  static constexpr int modes = 12;
  static constexpr double L = 25.0, EI = 2.87e9 * 2.90, mu = 2303.0, m = 5750.0, V0 = 60.0, rate = -40.0;
  using Vector = Eigen::Matrix<double, modes, 1>;

  static double x(double t) { return V0 * t + 0.5 * rate * t * t; }

  [[nodiscard]] Vector acceleration(double t, const Vector& q, const Vector& v) const {
    const double V = V0 + rate * t, s = x(t);
    Vector shape, slope, bend, restoring;
    for (int i = 0; i < modes; ++i) {
      const double k = (i + 1) * pi / L;
      shape[i] = std::sin(k * s);
      slope[i] = k * std::cos(k * s);
      bend[i] = -k * k * std::sin(k * s);
      restoring[i] = 0.5 * L * EI * std::pow(k, 4) * q[i];
    }
    const Eigen::Matrix<double, modes, modes> mass =
        0.5 * mu * L * Eigen::Matrix<double, modes, modes>::Identity() + m * shape * shape.transpose();
    const double load = m * (9.81 - 2.0 * V * slope.dot(v) - V * V * bend.dot(q) - rate * slope.dot(q));
    return mass.partialPivLu().solve(Vector(load * shape - restoring));
  }

  // Midspan deflection at equal times.
  [[nodiscard]] std::vector<double> midspan(double end, int points) const {
    constexpr int between = 40;
    const double h = end / (points * between);
    Vector q = Vector::Zero(), v = Vector::Zero();
    std::vector<double> result{0.0};
    for (int step = 0; step < points * between; ++step) {
      const double t = step * h;
      const Vector a1 = acceleration(t, q, v);
      const Vector v2 = v + 0.5 * h * a1, a2 = acceleration(t + 0.5 * h, q + 0.5 * h * v, v2);
      const Vector v3 = v + 0.5 * h * a2, a3 = acceleration(t + 0.5 * h, q + 0.5 * h * v2, v3);
      const Vector v4 = v + h * a3, a4 = acceleration(t + h, q + h * v3, v4);
      q += h / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4);
      v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
      if ((step + 1) % between != 0) continue;
      double u = 0.0;
      for (int i = 0; i < modes; ++i) u += q[i] * std::sin((i + 1) * pi / 2.0);
      result.push_back(u);
    }
    return result;
  }
};

TEST(SpeedProfile, BrakingMassOnABeamFollowsItsEquations) {
  const double end = 0.5;  // s: 25 m at 60 m/s and -40 m/s² take 0.5 s
  ASSERT_NEAR(BrakingMass::x(end), BrakingMass::L, 1e-12);
  constexpr int points = 50;
  const std::vector<double> expected = BrakingMass().midspan(end, points);
  VsiModel model;
  const DofIndices all_but_z{held, held, 0, held, held, held};
  model.vehicle = assemble_vehicle(
      {"mass", {{"wheelset", BrakingMass::m, {1, 1, 1}, {0, 0, -0.46}}}, {}, {0}, {all_but_z}, 0.46, 10.0});
  model.vehicle_x = {0.0};
  model.structure =
      share(build_simple_beam({.length = BrakingMass::L, .E = 2.87e9, .I = 2.90, .mass = 2303.0, .elements = 40}));
  model.contact.speed = BrakingMass::V0;
  model.speed_profile.emplace(std::vector<double>{0.0, end},
                              std::vector<double>{BrakingMass::V0, BrakingMass::V0 + BrakingMass::rate * end});
  model.normal_contact = NormalContact::rigid;
  VsiState state(model);
  ASSERT_TRUE(static_equilibrium(model, state).converged);
  std::vector<double> u;
  RunObserver observer;
  observer.record = [&](const StepRecord& r) { u.push_back(r.nodes.at(0).displacement[2]); };
  IntegrationParameters integration;
  integration.time_step = end / 2000.0;
  integration.alpha = 0.0;
  ASSERT_TRUE(simulate(model, integration, end, 2000 / points, state, observer).complete);
  ASSERT_EQ(u.size(), expected.size());
  double size = 0.0, worst = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    size = std::max(size, std::abs(expected[i]));
    worst = std::max(worst, std::abs(u[i] - expected[i]));
  }
  std::printf("braking mass on a beam: midspan within %.2e of %.3f mm\n", worst / size, 1e3 * size);
  testing::measured("braking.midspan", 1e4 * worst / size);
  EXPECT_LT(worst, 5e-3 * size);
}

}  // namespace
}  // namespace railtab
