// Where a train starts must not decide whether it starts: any speed, no friction, wheelsets far beside the middle of
// the track.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/line/rail_friction.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/scene/scene_run.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "railtab/runtime/vsi/simulation.hpp"
#include "railtab/runtime/vsi/step_record.hpp"

namespace railtab {
namespace {

SceneParameters coach_on_rigid_track(double speed, double friction = 0.3) {
  SceneParameters scene;
  scene.train.speed = speed;
  scene.contact.mode = ContactMode::online;
  scene.contact.friction = friction;
  scene.track_kind = TrackKind::rigid;
  scene.integration.duration = 0.05;
  return scene;
}

double train_weight(const VsiModel& model) {
  double weight = 0.0;
  for (const int body : model.vehicle.wheelsets) {
    weight += model.vehicle.static_load[model.vehicle.dof[static_cast<std::size_t>(body)][2]];
  }
  return weight;
}

double carried(const VsiState& state) {
  double sum = 0.0;
  for (int wheel = 0; 6 * wheel < state.contact.force.size(); ++wheel)
    sum += state.contact.force[rail_unknown(wheel) + 1];
  return sum;
}

TEST(Start, RestDoesNotDependOnTheSpeed) {
  const VsiModel fast = build_model(coach_on_rigid_track(50.0));
  VsiState reference(fast);
  ASSERT_TRUE(static_equilibrium(fast, reference).converged);
  for (const double speed : {1.0, 0.1, 0.01, 0.001}) {
    const VsiModel model = build_model(coach_on_rigid_track(speed));
    VsiState state(model);
    ASSERT_TRUE(static_equilibrium(model, state).converged) << speed << " m/s";
    EXPECT_LT((state.contact.force - reference.contact.force).cwiseAbs().maxCoeff(), 1.0) << speed << " m/s";
  }
}

// Heights at which a millimetre more is the same number: the search for the rails ends, and says that there is no rest.
TEST(Start, RailsOutOfAllReachHaveNoStateOfRest) {
  for (const double z : {1e13, 1e20, 1e290}) {
    VsiModel model = build_model(coach_on_rigid_track(50.0));
    const std::vector<double> x{-1e3, 1e3}, flat{0.0, 0.0}, far{z, z};
    model.irregularity = Irregularity(x, flat, far, flat, far);
    VsiState state(model);
    EXPECT_FALSE(steady_start(model, state).converged) << z;
  }
}

// A wheelset that is moved aside rises and rolls with its treads: wheel loads stay what they were.
TEST(Start, MovedAsideEveryWheelCarriesItsLoad) {
  for (const double shift : {-4e-3, 1e-3, 3e-3}) {
    SceneParameters scene = coach_on_rigid_track(50.0);
    scene.train.initial_lateral_shift = shift;
    scene.train.initial_yaw = 2e-3;
    double largest = 0.0;
    std::vector<double> first;
    RunObserver observer;
    observer.record = [&](const StepRecord& record) {
      for (const WheelRecord& wheel : record.wheels) {
        if (record.time == 0.0) first.push_back(wheel.Q);
        largest = std::max(largest, wheel.Q);
      }
    };
    const VsiModel model = build_model(scene);
    const double load = train_weight(model) / (2.0 * model.wheelsets());
    ASSERT_TRUE(run_scene(scene, observer).complete);
    std::printf("moved aside by %g mm: largest wheel load %.3f of the static one\n", 1e3 * shift, largest / load);
    for (const double Q : first) EXPECT_NEAR(Q, load, 0.02 * load) << 1e3 * shift << " mm";
    EXPECT_LT(largest, 1.4 * load) << 1e3 * shift << " mm";
  }
}

// Whatever the rule of the contact forces: the first record is of the train where it has been moved to, in all of X and
// Y.
TEST(Start, MovedAsideTheFirstRecordIsOfThatPlace) {
  for (const ContactForceRule rule : {ContactForceRule::endpoint, ContactForceRule::energy}) {
    SceneParameters scene = coach_on_rigid_track(50.0);
    scene.train.initial_lateral_shift = 3e-3;
    scene.integration.contact_force = rule;
    scene.integration.duration = 0.002;
    std::vector<std::vector<WheelRecord>> records;
    RunObserver observer;
    observer.record = [&](const StepRecord& record) { records.push_back(record.wheels); };
    ASSERT_TRUE(run_scene(scene, observer).complete);
    ASSERT_GE(records.size(), 2U);
    for (std::size_t w = 0; w < records[0].size(); ++w) {
      const WheelRecord &first = records[0][w], &next = records[1][w];
      EXPECT_GT(std::abs(next.X), 2e3);
      EXPECT_NEAR(first.X / next.X, 1.0, 0.2) << "wheel " << w;
      EXPECT_NEAR(first.Y, next.Y, 0.02 * next.Q) << "wheel " << w;
    }
  }
}

double tape_circle_offset(const VsiModel& model) { return model.geometry->pair().tape_circle_offset(); }

// From the tread over the steep flange, where a wheelset that rolls hardly sinks (contact angle of 70 degrees), to the
// tip of the flange: wheels always carry what they did, and the wheel climbs without a jump.
TEST(Start, EveryShiftUpToTheTipOfTheFlangeHasItsSeat) {
  for (const TrackKind kind : {TrackKind::rigid, TrackKind::flexible}) {
    SceneParameters scene = coach_on_rigid_track(30.0);
    scene.track_kind = kind;
    scene.track.length_before = scene.track.length_after = 30.0;
    const VsiModel model = build_model(scene);
    VsiState rest(model);
    ASSERT_TRUE(static_equilibrium(model, rest).converged);
    const int dof_z = model.vehicle.dof[static_cast<std::size_t>(model.vehicle.wheelsets[0])][2];
    const int dof_roll = model.vehicle.dof[static_cast<std::size_t>(model.vehicle.wheelsets[0])][3];
    double before = -0.01;
    for (const double shift : {5.5, 6.0, 6.2, 6.3, 6.4, 6.5, 6.6, 6.8, 7.0, 8.0, 10.0, 13.0, 16.0, 20.0}) {
      VsiState state = rest;
      ASSERT_TRUE(displace_train(model, 1e-3 * shift, 0.0, state)) << shift << " mm";
      ContactSolution contact = state.contact;
      const ContactProblem present = present_contact(model, state);
      contact.displacement = present.predicted;
      evaluate_contact(model.contact, present, contact);
      for (int wheel = 0; wheel < 2 * model.wheelsets(); ++wheel) {
        const double load = rest.contact.force[rail_unknown(wheel) + 1];
        EXPECT_NEAR(contact.force[rail_unknown(wheel) + 1], load, 1e-3 * load) << shift << " mm, wheel " << wheel;
      }
      const Eigen::VectorXd& x = state.vehicle[0].displacement;
      const double right = -(x[dof_z] + tape_circle_offset(model) * x[dof_roll]);
      EXPECT_GT(right, before) << shift << " mm";
      before = right;
    }
    EXPECT_GT(before, 20e-3);  // on the tip
    EXPECT_LT(before, 30e-3);
  }
}

TEST(Start, WithAWheelBesideItsRailIsRejected) {
  SceneParameters scene = coach_on_rigid_track(50.0);
  scene.contact.dimensions.track_gauge = 1.55;
  scene.train.initial_lateral_shift = 0.02;
  try {
    static_cast<void>(run_scene(scene, {}));
    FAIL() << "a wheel between the rails runs";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("carry their loads"), std::string::npos) << error.what();
  }
}

// At rest there is nothing to integrate: forces must stay. At 0.01 m/s a step is 5 um of way, and a wheel slides
// after 0.1 nm of it.
TEST(Start, RunsAtAnySpeedWithoutHalvedSteps) {
  for (const double speed : {10.0, 1.0, 0.1, 0.01}) {
    const SceneParameters scene = coach_on_rigid_track(speed);
    double least = 1e9, most = 0.0;
    RunObserver observer;
    observer.record = [&](const StepRecord& record) {
      for (const WheelRecord& wheel : record.wheels) {
        least = std::min(least, wheel.Q);
        most = std::max(most, wheel.Q);
      }
    };
    const RunSummary summary = run_scene(scene, observer);
    EXPECT_TRUE(summary.complete) << speed << " m/s: " << summary.message;
    EXPECT_EQ(summary.halved_steps, 0) << speed << " m/s";
    EXPECT_LT(most - least, 1e-3 * most) << speed << " m/s";
    std::printf("%g m/s: %.2f Newton iterations per step\n", speed,
                static_cast<double>(summary.newton_iterations) / static_cast<double>(summary.steps));
  }
}

TEST(Start, WithoutFrictionOnFlexibleTrack) {
  SceneParameters scene = coach_on_rigid_track(20.0, 0.0);
  scene.track_kind = TrackKind::flexible;
  scene.track.length_before = scene.track.length_after = 30.0;
  const VsiModel model = build_model(scene);
  VsiState state(model);
  ASSERT_TRUE(static_equilibrium(model, state).converged);
  EXPECT_NEAR(carried(state) / train_weight(model), 1.0, 1e-6);
}

// Next to no friction, of the whole track or where the train stands, is no reason for a train not to rest.
TEST(Start, WithNextToNoFriction) {
  for (const TrackKind track : {TrackKind::rigid, TrackKind::flexible}) {
    SceneParameters scene = coach_on_rigid_track(20.0);
    scene.track_kind = track;
    scene.track.length_before = scene.track.length_after = 30.0;
    VsiModel model = build_model(scene);
    const auto rests = [&] {
      VsiState state(model);
      const bool converged = static_equilibrium(model, state).converged;
      return converged && std::abs(carried(state) / train_weight(model) - 1.0) < 1e-6;
    };
    for (const double friction : {1e-3, 1e-4, 1e-6, 1e-9}) {
      model.contact.friction = friction;
      EXPECT_TRUE(rests()) << friction;
    }
    model.contact.friction = 0.3;
    model.rail_friction = RailFriction({0.0, 1.0}, {0.0, 0.0}, {0.0, 0.0});
    EXPECT_TRUE(rests()) << "a file of zeros";
    model.rail_friction = RailFriction({-15.0, -10.0}, {0.0, 0.3}, {0.0, 0.3});
    EXPECT_TRUE(rests()) << "rear wheelsets without friction";
  }
}

SceneParameters coach_on_flexible_track() {
  SceneParameters scene = coach_on_rigid_track(120.0 / 3.6);
  scene.track_kind = TrackKind::flexible;
  scene.track.length_before = scene.track.length_after = 30.0;
  return scene;
}

// Vertical forces of the wheels at rest [N].
Eigen::VectorXd wheel_loads(const VsiModel& model) {
  VsiState state(model);
  EXPECT_TRUE(static_equilibrium(model, state).converged);
  Eigen::VectorXd loads(2 * model.wheelsets());
  for (int wheel = 0; wheel < loads.size(); ++wheel) loads[wheel] = state.contact.force[rail_unknown(wheel) + 1];
  return loads;
}

// At rest nothing approaches, though wheels stand where rails are deflected and slope.
TEST(Start, RestDoesNotDependOnTheContactsDamping) {
  SceneParameters scene = coach_on_flexible_track();
  const Eigen::VectorXd without = wheel_loads(build_model(scene));
  scene.contact.damping = 1000.0;
  EXPECT_LT((wheel_loads(build_model(scene)) - without).cwiseAbs().maxCoeff(), 1e-6 * without[0]);
  scene.integration.duration = 0.005;
  const RunSummary summary = run_scene(scene, {});
  EXPECT_TRUE(summary.complete) << summary.message;
}

// From rubber's to five thousand times steel's stiffness the track carries the train as it does on steel.
TEST(Start, OnContactsOfAnyStiffness) {
  SceneParameters scene = coach_on_flexible_track();
  const Eigen::VectorXd steel = wheel_loads(build_model(scene));
  for (const double E : {1e10, 1e12, 1e14, 1e15}) {
    scene.contact.material.E = E;
    const Eigen::VectorXd loads = wheel_loads(build_model(scene));
    EXPECT_LT((loads - steel).cwiseAbs().maxCoeff(), 0.01 * steel[0]) << E << " Pa";
    EXPECT_NEAR(loads.sum() / steel.sum(), 1.0, 1e-5) << E << " Pa";
    scene.integration.duration = 0.002;
    const RunSummary summary = run_scene(scene, {});
    EXPECT_TRUE(summary.complete) << E << " Pa: " << summary.message;
  }
}

// Pads on which rails sink by 8 cm, at rest. Under the train that moves their dampers bear the most of it.
TEST(Start, OnPadsThatSinkByCentimetres) {
  SceneParameters scene = coach_on_flexible_track();
  scene.track.pad.kz = 1e5;
  const VsiModel model = build_model(scene);
  VsiState state(model);
  ASSERT_TRUE(static_equilibrium(model, state).converged);
  EXPECT_NEAR(carried(state) / train_weight(model), 1.0, 1e-5);
  EXPECT_GT(state.contact.displacement[2], 0.05);
  EXPECT_LT(state.contact.displacement[2], 0.15);
  std::vector<std::string> warnings;
  RunObserver observer;
  observer.warning = [&](std::string_view warning) { warnings.emplace_back(warning); };
  scene.integration.duration = 0.01;
  const RunSummary summary = run_scene(scene, observer);
  EXPECT_TRUE(summary.complete) << summary.message;
  EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), [](const std::string& warning) {
    return warning.find("its first seconds are a transient") != std::string::npos;
  }));
}

// What the scene's keys allow at the least: speed, and change of the forces that is none.
TEST(Start, RunsAtTheLeastSpeedAndTolerance) {
  SceneParameters scene = coach_on_flexible_track();
  scene.integration.duration = 0.01;
  for (const double speed : {1e-3, 2e-3, 5e-3}) {
    scene.train.speed = speed;
    const RunSummary summary = run_scene(scene, {});
    EXPECT_TRUE(summary.complete) << speed << " m/s: " << summary.message;
    EXPECT_EQ(summary.halved_steps, 0) << speed << " m/s";
  }
  scene.train.speed = 30.0;
  scene.integration.tolerance = 1e-12;
  const RunSummary summary = run_scene(scene, {});
  EXPECT_TRUE(summary.complete) << summary.message;
  EXPECT_EQ(summary.halved_steps, 0);
}

// The third wheelset stands where both rails lie aside by more than the flanges' clearance: it is reached from the
// smooth track, the deviations growing.
TEST(Start, WithOneWheelsetOnItsFlange) {
  VsiModel model = build_model(coach_on_rigid_track(20.0));
  const double x = model.wheelset_x(2, 0.0);
  for (const double shift : {4e-3, 10e-3, 20e-3}) {
    const std::vector<double> place{x - 5.0, x - 2.0, x - 1.0, x + 1.0, x + 2.0, x + 5.0};
    const std::vector<double> aside{0.0, 0.0, shift, shift, 0.0, 0.0}, level(6, 0.0);
    model.irregularity = Irregularity(place, aside, level, aside, level);
    VsiState state(model);
    const EquilibriumReport rest = static_equilibrium(model, state);
    ASSERT_TRUE(rest.converged) << 1e3 * shift << " mm";
    EXPECT_EQ(rest.deviation_share, 1.0);
    EXPECT_NEAR(carried(state) / train_weight(model), 1.0, 1e-3);
    const double rails = model.irregularity.at(RailSide::right, x).y;
    const double y = state.contact.displacement[2 * wheelset_unknowns + 1];
    EXPECT_LT(std::abs(y - rails), 8e-3);  // between the rails, or on a flange
    std::printf("rails %.2f mm aside: wheelset %.2f mm aside, %d iterations\n", 1e3 * rails, 1e3 * y, rest.iterations);
  }
}

// Wind that unloads a wheel by nearly all of its load: the state of rest is reached from calm, the wind growing.
TEST(Start, InWindThatNearlyLiftsAWheel) {
  SceneParameters scene = read_scene(std::string(RAILTAB_SOURCE_DIR) + "/docs/examples/wind_curve.toml",
                                     {{"load.1.gust_duration", ""}, {"load.1.start", ""}});
  for (const double wind : {38.75, 39.0, 39.25}) {
    scene.loads[0].wind_speed = wind;
    const VsiModel model = build_model(scene);
    VsiState state(model);
    const EquilibriumReport rest = static_equilibrium(model, state);
    ASSERT_TRUE(rest.converged) << wind << " m/s";
    EXPECT_EQ(rest.load_share, 1.0);
    const double lift = -model.loads[0].history.at(0.0)[2];
    EXPECT_NEAR(carried(state) / (train_weight(model) - lift), 1.0, 1e-3);
    std::printf("wind of %.2f m/s: %d iterations\n", wind, rest.iterations);
  }
}

TEST(Start, SaysThatWheelsDoNotFit) {
  SceneParameters scene = coach_on_rigid_track(20.0);
  scene.contact.dimensions.track_gauge = 1.2;
  const RunSummary summary = run_scene(scene, {});
  EXPECT_FALSE(summary.complete);
  EXPECT_NE(summary.message.find("track gauge"), std::string::npos) << summary.message;
}

}  // namespace
}  // namespace railtab
