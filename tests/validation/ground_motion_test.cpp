// Ground motion against closed-form oscillators, against the equations of relative motion, and with a coach on top.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "../measured.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "railtab/runtime/structure/stiffness_factor.hpp"
#include "railtab/runtime/structure/track_bridge.hpp"
#include "railtab/runtime/vsi/external_load.hpp"
#include "railtab/runtime/vsi/simulation.hpp"

namespace railtab {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double point_step = 0.02, duration = 4.0;  // of the records [s]

// Shaking of some seconds with several frequencies, the same along y and z.
GroundRecord shaking() {
  std::vector<double> time;
  std::vector<GroundVector> acceleration;
  for (int i = 0; point_step * i <= duration + 1e-9; ++i) {
    const double t = point_step * i;
    const double a = std::sin(pi * t / duration) * (1.5 * std::sin(7.0 * t) + std::sin(16.0 * t + 1.0));
    time.push_back(t);
    acceleration.emplace_back(a, a);
  }
  return GroundRecord::from_acceleration(time, acceleration);
}

// Relative displacement of u'' + 2ζω u' + ω² u = −p·a_g at the record's points, exact for an acceleration that is a
// straight line between them.
std::vector<double> oscillator(const GroundRecord& ground, double omega, double zeta, double p) {
  std::vector<double> result{0.0};
  const double damped = omega * std::sqrt(1.0 - zeta * zeta), h = point_step;
  double u = 0.0, v = 0.0;
  for (int i = 0; point_step * (i + 1) <= duration + 1e-9; ++i) {
    // just inside the interval: the record is at rest at and beyond its ends
    const double a0 = ground.at(h * i + 1e-9 * h).acceleration[1];
    const double jerk = (ground.at(h * (i + 1) - 1e-9 * h).acceleration[1] - a0) / h;
    const auto particular = [&](double t) {
      return -p * (a0 + jerk * t - 2.0 * zeta * jerk / omega) / (omega * omega);
    };
    const double rate = -p * jerk / (omega * omega);
    const double A = u - particular(0.0), B = (v - rate + zeta * omega * A) / damped;
    const double decay = std::exp(-zeta * omega * h), c = std::cos(damped * h), s = std::sin(damped * h);
    u = decay * (A * c + B * s) + particular(h);
    v = decay * ((B * damped - zeta * omega * A) * c - (A * damped + zeta * omega * B) * s) + rate;
    result.push_back(u);
  }
  return result;
}

double largest(const std::vector<double>& v) {
  double m = 0.0;
  for (const double x : v) m = std::max(m, std::abs(x));
  return m;
}

// Largest difference at the record's points, of the largest value.
template <class At>
double difference(const std::vector<double>& expected, At&& at) {
  double worst = 0.0;
  for (std::size_t i = 0; i < expected.size(); ++i) worst = std::max(worst, std::abs(at(i) - expected[i]));
  return worst / largest(expected);
}

// A sprung mass whose wheels follow rigid rails, and with them the ground.
double sprung_mass_error(double time_step) {
  constexpr double mass = 5750.0, omega = 2.0 * pi * 1.3, zeta = 0.05;
  VsiModel model;
  const DofIndices all_but_z{held, held, 0, held, held, held};
  model.vehicle =
      assemble_vehicle({"sprung mass",
                        {{"wheelset", 100.0, {1, 1, 1}, {0, 0, -0.46}}, {"mass", mass, {1, 1, 1}, {0, 0, -1.0}}},
                        {{0, 1, {0, 0, -0.7}, {0, 0, mass * omega * omega}, {0, 0, 2.0 * zeta * omega * mass}}},
                        {0},
                        {all_but_z, all_but_z},
                        0.46,
                        10.0});
  model.vehicle_x = {0.0};
  model.contact.speed = 20.0;
  model.normal_contact = NormalContact::rigid;
  model.ground_motion.emplace(shaking());
  VsiState state(model);
  EXPECT_TRUE(static_equilibrium(model, state).converged);
  std::vector<double> relative;
  RunObserver observer;
  observer.record = [&](const StepRecord& r) {
    relative.push_back(r.bodies[1].displacement[2] - r.bodies[0].displacement[2]);
  };
  IntegrationParameters integration;
  integration.time_step = time_step;
  integration.alpha = 0.0;
  const int every = static_cast<int>(std::lround(point_step / time_step));
  EXPECT_TRUE(simulate(model, integration, duration, every, state, observer).complete);
  const std::vector<double> expected = oscillator(shaking(), omega, zeta, 1.0);
  EXPECT_EQ(relative.size(), expected.size());
  const double rest = relative.front();  // sag under its own weight is zero by definition; what rounding leaves
  return difference(expected, [&](std::size_t i) { return relative[i] - rest; });
}

TEST(GroundMotion, SprungMassOnRigidTrackIsTheClosedFormOscillator) {
  const double coarse = sprung_mass_error(4e-3), fine = sprung_mass_error(2e-3);
  testing::measured("ground.sprung_mass", 1e4 * fine);
  testing::measured("ground.sprung_mass_order", std::log2(coarse / fine));
  std::printf("sprung mass on moving ground: %.2e of the largest deflection at 2 ms, order %.2f\n", fine,
              std::log2(coarse / fine));
  EXPECT_LT(fine, 2e-3);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.2);
}

// One mass on a spring and a damper from the ground, with a part of its own mass at the support.
double supported_mass_error(double time_step) {
  constexpr double m = 2e4, at_support = 5e3, omega = 2.0 * pi * 2.1, zeta = 0.03;
  VsiModel model;
  StructureModel s;
  const auto one = [](double value, int columns, int column) {
    Eigen::SparseMatrix<double> matrix(1, columns);
    matrix.insert(0, column) = value;
    return matrix;
  };
  const double k = m * omega * omega, c = 2.0 * zeta * omega * m;
  s.mass = one(m, 1, 0);
  s.stiffness = one(k, 1, 0);
  s.damping = one(c, 1, 0);
  s.supports = {{3.0}, one(at_support, 2, 1), one(-c, 2, 1), one(-k, 2, 1)};
  model.structure = share(s);
  model.ground_motion.emplace(shaking());

  const HhtScheme hht{.alpha = -0.05, .time_step = time_step};
  StructureResponse response(s, hht);
  LinearMotion motion(1);
  Eigen::VectorXd load;
  const std::vector<double> expected = oscillator(shaking(), omega, zeta, 1.0 + at_support / m);
  std::vector<double> relative{0.0};
  const int every = static_cast<int>(std::lround(point_step / time_step));
  for (int step = 0; relative.size() < expected.size(); ++step) {
    past_contact_load(hht, motion, {0, s.dofs()}, load);
    add_ground_load(model, hht, step * time_step, {0, s.dofs()}, load);
    update(hht, response.increment(motion, load), motion);
    const double ground = model.ground_motion->at(3.0, (step + 1) * time_step).displacement[1];
    if ((step + 1) % every == 0) relative.push_back(motion.displacement[0] - ground);
  }
  return difference(expected, [&](std::size_t i) { return relative[i]; });
}

TEST(GroundMotion, SupportedMassIsTheClosedFormOscillator) {
  const double coarse = supported_mass_error(2e-3), fine = supported_mass_error(1e-3);
  testing::measured("ground.supported_mass", 1e4 * fine);
  testing::measured("ground.supported_mass_order", std::log2(coarse / fine));
  std::printf("mass on a moving support: %.2e of the largest deflection at 1 ms, order %.2f\n", fine,
              std::log2(coarse / fine));
  EXPECT_LT(fine, 2e-3);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.3);
}

// Track and bridge by absolute displacements against the equations of the motion relative to the ground, whose load is
// the inertia of all that is carried along: -(M 1 + M_s 1) a_g. Largest difference at midspan, lateral.
double two_routes(double time_step) {
  TrackParameters track;
  track.length_before = track.length_after = 3.0;
  BridgeParameters span;
  span.length = 20.0;
  span.elements = 8;
  VsiModel model;
  model.structure = share(build_track_bridge(track, {span}));
  model.ground_motion.emplace(shaking());
  const StructureModel& s = *model.structure;
  const HhtScheme hht{.alpha = -0.05, .time_step = time_step};
  StructureResponse response(s, hht);

  Eigen::VectorXd supports = Eigen::VectorXd::Zero(s.supports.columns());
  for (int i = 0; i < supports.size(); i += 2) supports[i] = 1.0;
  const SparseLdlt stiffness = stiffness_factor(s.stiffness);
  const Eigen::VectorXd carried = stiffness.solve(-(s.supports.stiffness * supports));
  const Eigen::VectorXd inertia = s.mass * carried + s.supports.mass * supports;

  LinearMotion absolute(s.dofs()), relative(s.dofs());
  Eigen::VectorXd load;
  const int midspan = s.nodes.front().dof[1];
  double worst = 0.0, size = 0.0;
  for (int step = 0; step * time_step < 2.0; ++step) {
    const double end = (step + 1) * time_step;
    past_contact_load(hht, absolute, {0, s.dofs()}, load);
    add_ground_load(model, hht, step * time_step, {0, s.dofs()}, load);
    update(hht, response.increment(absolute, load), absolute);
    const GroundPoint now = model.ground_motion->at(0.0, end);
    past_contact_load(hht, relative, {0, s.dofs()}, load);
    const double before = model.ground_motion->at(0.0, step * time_step).acceleration[0];
    load -= (hht.load_weight() * now.acceleration[0] - hht.alpha * before) * inertia;
    update(hht, response.increment(relative, load), relative);
    worst = std::max(worst,
                     std::abs(absolute.displacement[midspan] - now.displacement[0] - relative.displacement[midspan]));
    size = std::max(size, std::abs(relative.displacement[midspan]));
  }
  return worst / size;
}

TEST(GroundMotion, AbsoluteAndRelativeMotionOfTrackAndBridgeAgree) {
  const double coarse = two_routes(2e-3), fine = two_routes(1e-3);
  testing::measured("ground.two_routes", 1e4 * fine);
  testing::measured("ground.two_routes_order", std::log2(coarse / fine));
  std::printf("bridge on moving ground, absolute against relative: %.2e of the deflection at 1 ms, order %.2f\n", fine,
              std::log2(coarse / fine));
  // What is left at this level is of first order in the time step.
  EXPECT_LT(fine, 3e-4);
  EXPECT_GT(std::log2(coarse / fine), 0.9);
}

// Ground that moves slowly takes the train along, and its wheel loads with it.
void expect_taken_along(TrackKind track) {
  SceneParameters scene;
  scene.contact.mode = ContactMode::online;
  scene.contact.creep_law = "polach";
  scene.track_kind = track;
  scene.track.length_before = 36.0;
  scene.track.length_after = 20.0;
  scene.train.speed = 4.0;
  scene.train.start = 0.0;
  scene.integration.time_step = 2e-3;
  scene.integration.duration = 4.0;
  VsiModel model = build_model(scene);
  std::vector<double> time;
  std::vector<GroundVector> displacement;
  for (int i = 0; i <= 60; ++i) {
    time.push_back(0.05 * i);
    const double part = 0.5 * (1.0 - std::cos(pi * i / 60.0));
    displacement.emplace_back(0.08 * part, -0.04 * part);
  }
  model.ground_motion.emplace(GroundRecord::from_displacement(time, displacement));
  VsiState state(model);
  ASSERT_TRUE(steady_start(model, state).converged);
  StepRecord first, last;
  double least = 1e9, most = 0.0;
  RunObserver observer;
  observer.record = [&](const StepRecord& r) {
    if (r.time == 0.0) first = r;
    last = r;
    for (const WheelRecord& wheel : r.wheels) {
      least = std::min(least, wheel.Q);
      most = std::max(most, wheel.Q);
    }
  };
  ASSERT_TRUE(simulate(model, scene.integration, scene.integration.duration, 10, state, observer).complete);
  const double car_z = last.bodies[0].displacement[2] - first.bodies[0].displacement[2];
  EXPECT_NEAR(last.bodies[0].displacement[1], 0.08, 2e-3);
  EXPECT_NEAR(car_z, -0.04, 1e-3);
  for (int w = 3; w < 7; ++w) EXPECT_NEAR(last.bodies[static_cast<std::size_t>(w)].displacement[1], 0.08, 1e-3);
  const double static_load = first.wheels[0].Q;
  EXPECT_GT(least, 0.93 * static_load);
  EXPECT_LT(most, 1.07 * static_load);
  const std::string name = track == TrackKind::rigid ? "ground.rigid" : "ground.flexible";
  testing::measured(name + "_least", least / static_load);
  testing::measured(name + "_most", most / static_load);
  std::printf("wheel loads %.3f to %.3f of the static one\n", least / static_load, most / static_load);
}

TEST(GroundMotion, RigidTrackTakesTheTrainAlong) { expect_taken_along(TrackKind::rigid); }
TEST(GroundMotion, FlexibleTrackTakesTheTrainAlong) { expect_taken_along(TrackKind::flexible); }

}  // namespace
}  // namespace railtab
