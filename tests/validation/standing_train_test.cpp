// Trains that stand and start, and friction that changes along the track and with slip.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "hunting_model.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/line/rail_friction.hpp"
#include "railtab/runtime/line/speed_profile.hpp"
#include "railtab/runtime/vehicle/coach.hpp"
#include "railtab/runtime/vehicle/vehicle_library.hpp"

namespace railtab::hunting {
namespace {

constexpr double ellipse_a = 5.667e-3, ellipse_b = 4.284e-3, G = 82e9, c22 = 4.121;

TEST(SpeedProfile, StandsAndStarts) {
  const SpeedProfile profile({0.0, 1.0, 3.0, 5.0}, {0.0, 0.0, 4.0, 0.0});
  EXPECT_EQ(profile.lowest(), 0.0);
  EXPECT_EQ(profile.distance(1.0), 0.0);
  EXPECT_EQ(profile.distance(3.0), 4.0);
  EXPECT_EQ(profile.distance(9.0), 8.0);
  EXPECT_NEAR(profile.time_at(1.0), 2.0, 1e-12);
  EXPECT_EQ(profile.time_at(0.0), 1.0) << "the last time at which the train stands there";
  EXPECT_EQ(profile.time_at(8.0), 5.0);
  EXPECT_TRUE(std::isinf(profile.time_at(8.1)));
}

// A wheelset that stands creeps under a lateral force by F/(2 f22) times the floor: the error that the floor makes.
TEST(StandingTrain, CreepsByTheFloorAlone) {
  constexpr double floor = 0.05, force = 2000.0;
  VsiModel model = wheelset({.suspension = Suspension::none}, 1.0);
  model.speed_profile.emplace(std::vector<double>{0.0, 10.0}, std::vector<double>{0.0, 0.0});
  model.contact.speed = 0.0;
  model.contact.speed_floor = floor;
  ForceAndMoment lateral = ForceAndMoment::Zero();
  lateral[1] = force;
  model.loads.push_back({0, {1}, LoadHistory(LoadArgument::time, {0.0}, {lateral})});
  VsiState state(model);
  ASSERT_TRUE(static_equilibrium(
                  [&] {
                    VsiModel unloaded = model;
                    unloaded.loads.clear();
                    unloaded.contact.geometry = unloaded.geometry.get();
                    return unloaded;
                  }(),
                  state)
                  .converged);
  Motion motion;
  run(model, 1e-3, 2.0, 100, state, motion);
  const double f22 = G * c22 * ellipse_a * ellipse_b;
  const double expected = force / (2.0 * f22) * floor;  // m/s
  const double rate = (motion.y.back() - motion.y[5]) / (motion.t.back() - motion.t[5]);
  std::printf("drift %.4e m/s, closed form %.4e m/s\n", rate, expected);
  EXPECT_NEAR(rate / expected, 1.0, 1e-2);
}

// A coach stands for half a second, starts, and ends at 4 m/s.
TEST(StandingTrain, ACoachStartsWithoutShock) {
  const VehicleData data = library_vehicle("manchester-coach");
  VsiModel model;
  model.vehicle = build_vehicle(data, MotionPlane::spatial, {}, ForceElementChoice::nonlinear);
  model.vehicle_x = {0.0};
  model.geometry = std::make_shared<const ContactGeometry>(
      ContactSearch(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "S1002", 0.0)),
                                  ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)), {})));
  model.contact.geometry = model.geometry.get();
  model.speed_profile.emplace(std::vector<double>{0.0, 0.5, 2.5}, std::vector<double>{0.0, 0.0, 2.0});
  model.contact.speed = 0.0;
  model.contact.speed_floor = 0.1;
  VsiState state(model);
  ASSERT_TRUE(steady_start(model, state).converged);
  std::vector<double> t, Q, Y, X;
  RunObserver observer;
  observer.record = [&](const StepRecord& record) {
    t.push_back(record.time);
    Q.push_back(record.wheels[0].Q);
    Y.push_back(record.wheels[0].Y + record.wheels[1].Y);
    double sum = 0.0;
    for (const WheelRecord& wheel : record.wheels) sum += wheel.X;
    X.push_back(sum);
  };
  IntegrationParameters integration;
  integration.time_step = 1e-3;
  integration.tolerance = 1e-8;
  const RunSummary summary = simulate(model, integration, 2.4, 1, state, observer);
  ASSERT_TRUE(summary.complete) << summary.message;
  for (std::size_t i = 0; i < t.size(); ++i) {
    ASSERT_TRUE(std::isfinite(Q[i]) && std::isfinite(Y[i]));
    if (t[i] < 0.499) {
      EXPECT_NEAR(Q[i] / Q[0], 1.0, 3e-5) << t[i];  // the contact vibrates by what rest leaves out of balance
    }
    // the bogies' inertia shifts load between their wheelsets: about 1 kN of 54 kN, twice that as it begins to act
    EXPECT_NEAR(Q[i] / Q[0], 1.0, 0.1) << t[i];
  }
  EXPECT_NEAR(model.distance(2.4), 0.5 * 1.9 * 1.9, 1e-12);
  // Wheelsets that roll faster and faster: their rails push them by J_y a/R0² each, in the mean of two periods in which
  // bogies sway along the track on their springs.
  const double Jy = 112.0, a = 1.0;
  double mean = 0.0;
  long samples = 0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (t[i] <= 0.5) continue;
    mean += std::abs(X[i]);
    ++samples;
  }
  mean /= static_cast<double>(samples);
  std::printf("rails push by %.0f N, closed form %.0f N\n", mean, 4.0 * Jy * a / (0.46 * 0.46));
  EXPECT_NEAR(mean / (4.0 * Jy * a / (0.46 * 0.46)), 1.0, 0.05);
}

// A coach brakes from 0.5 m/s to a stand in half a second, with the tolerance of runs by default. Wheels would slide
// after a move of a tenth of a micrometre: no correction may take them there unseen.
TEST(StandingTrain, ACoachThatStopsDoesNotSlideToAndFro) {
  VsiModel model;
  model.vehicle = build_vehicle(library_vehicle("manchester-coach"), MotionPlane::spatial, {});
  model.vehicle_x = {0.0};
  model.geometry = std::make_shared<const ContactGeometry>(
      ContactSearch(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "S1002", 0.0)),
                                  ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)), {})));
  model.contact.geometry = model.geometry.get();
  model.speed_profile.emplace(std::vector<double>{0.0, 0.5}, std::vector<double>{0.5, 0.0});
  model.contact.speed = 0.5;
  model.contact.speed_floor = 0.1;
  VsiState state(model);
  ASSERT_TRUE(steady_start(model, state).converged);
  double largest = 0.0, largest_jump = 0.0, before = 0.0;
  RunObserver observer;
  observer.record = [&](const StepRecord& record) {
    const double X = record.wheels[0].X;
    if (record.time > 0.5) largest_jump = std::max(largest_jump, std::abs(X - before));
    before = X;
    largest = std::max(largest, std::abs(X));
  };
  ASSERT_TRUE(simulate(model, {}, 1.0, 1, state, observer).complete);
  std::printf("X of a wheel up to %.0f N, from step to step by %.0f N\n", largest, largest_jump);
  EXPECT_LT(largest, 2e3) << "friction would bear 16 kN";
  EXPECT_LT(largest_jump, 200.0);
}

TEST(RailFriction, IsEachRailsAndChangesAlongTheTrack) {
  const RailFriction friction({10.0, 20.0}, {0.1, 0.3}, {0.4, 0.4});
  EXPECT_EQ(friction.at(RailSide::left, 0.0), 0.1);
  EXPECT_NEAR(friction.at(RailSide::left, 15.0), 0.2, 1e-15);
  EXPECT_EQ(friction.at(RailSide::right, 99.0), 0.4);
  EXPECT_THROW(RailFriction({0.0, 0.0}, {0.1, 0.1}, {0.1, 0.1}), InputError);
  EXPECT_THROW(RailFriction({0.0}, {0.1}, {-0.1}), InputError);
}

// One wheel that slides along its rail.
struct Sliding {
  WheelContactModel model;
  ContactGeometry geometry{ContactSearch(cones_on_crowns())};
  double Q = 0.0;

  explicit Sliding(const CreepLaw& law) {
    model.geometry = &geometry;
    model.creep_law = law;
    model.speed = 20.0;
  }
  // Longitudinal force over Q/cos γ at a slip velocity [m/s].
  double adhesion(double slip, double rail_friction = 1.0) {
    WheelsetMotion motion;
    motion.displacement[2] = 1e-4;
    motion.velocity[0] = slip;
    RailHeadMotion rail;
    rail.friction = rail_friction;
    const WheelsetPose pose = relative_pose(geometry.pair(), WheelSide::right, motion, rail);
    const LoadedWheelForce force = wheel_force(model, WheelSide::right, motion, rail, wheel_contact(geometry, pose));
    Q = force.normal[0];
    return -force.wheelset[0] / Q;
  }
};

TEST(FrictionLaw, FallsWithTheSlipVelocity) {
  for (const CreepLaw& law : {CreepLaw(PolachCreep{}), CreepLaw(FastsimCreep{})}) {
    Sliding clean(law), falling(law);
    falling.model.friction_law = {.limit = 0.4, .decay = 0.6};
    // in full slip: μ0 ((1 − A) e^{−B w} + A)
    for (const double w : {2.0, 4.0, 8.0}) {
      const double mu = 0.3 * (0.6 * std::exp(-0.6 * w) + 0.4);
      EXPECT_NEAR(falling.adhesion(w) / mu, 1.0, 0.02) << w;
    }
    // an adhesion curve with a top
    EXPECT_GT(falling.adhesion(0.2), 1.2 * falling.adhesion(4.0));
    EXPECT_GT(falling.adhesion(0.2), falling.adhesion(0.01));
    // a rail of half the friction
    EXPECT_NEAR(clean.adhesion(8.0, 0.5) / clean.adhesion(8.0), 0.5, 1e-3);
  }
}

// Without spin, whose creepage no motion of the wheel scales.
TEST(FrictionLaw, ThirdBodyScalesCreepages) {
  const CreepLaw law =
      LinearCreep{.nu = 0.28, .saturated = true, .coefficients = KalkerCoefficients{4.5, 4.1, 0.0, 0.0}};
  Sliding clean(law), soft(law);
  soft.model.friction_law.initial_slope = 0.3;
  const double offset = clean.adhesion(0.0) / (clean.adhesion(1e-3) - clean.adhesion(0.0)) * 1e-3;  // of the radius
  for (const double slip : {1e-4, 0.01, 0.1, 0.5}) {
    EXPECT_NEAR(soft.adhesion(slip - offset) / clean.adhesion(0.3 * slip - offset), 1.0, 1e-3) << slip;
  }
  // the slope at no slip does not know the friction
  const auto slope = [&](double rail) { return clean.adhesion(1e-5 - offset, rail) / 1e-5; };
  EXPECT_NEAR(slope(0.5) / slope(1.0), 1.0, 1e-3);
}

}  // namespace
}  // namespace railtab::hunting
