// A run starts from the steady state of the moving train: what its first second shows beyond the steady passage of the
// sleepers is a transient of the start. On a smooth track it must stay below 0.1 % of the wheel load.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/vsi/step_record.hpp"
#include "recorded_steps.hpp"

namespace railtab {
namespace {

using testing::recorded_steps;

constexpr double speed = 60.0;        // m/s
constexpr int steps_per_bay = 20;     // of 0.6 m in steps of 0.5 ms
constexpr double length_ahead = 150;  // m

SceneParameters coach_on(TrackKind track) {
  SceneParameters scene;
  scene.train.speed = speed;
  scene.contact.mode = ContactMode::online;
  scene.track_kind = track;
  scene.track.length_before = 120.0;
  scene.track.length_after = length_ahead;
  scene.train.start = -60.0;
  scene.integration.time_step = 5e-4;
  scene.integration.duration = 1.2;
  return scene;
}

// Q and Y of one wheel over one bay, the mean of the last bays of a long run.
struct SteadyBay {
  std::vector<std::array<double, 2>> force;  // by step of the bay

  SteadyBay(const std::vector<StepRecord>& steps, std::size_t wheel) : force(steps_per_bay) {
    constexpr std::size_t bays = 10;
    const std::size_t begin = (steps.size() / steps_per_bay - bays) * steps_per_bay;
    for (std::size_t i = begin; i < begin + bays * steps_per_bay; ++i) {
      force[i % steps_per_bay][0] += steps[i].wheels[wheel].Q / bays;
      force[i % steps_per_bay][1] += steps[i].wheels[wheel].Y / bays;
    }
  }
};

// Largest deviation from the steady passage in the first second, over the static wheel load.
double transient(const std::vector<StepRecord>& start, const std::vector<StepRecord>& steady, double static_load) {
  double largest = 0.0;
  for (std::size_t wheel = 0; wheel < start.front().wheels.size(); ++wheel) {
    const SteadyBay bay(steady, wheel);
    for (std::size_t i = 0; i < start.size() && start[i].time <= 1.0; ++i) {
      const WheelRecord& w = start[i].wheels[wheel];
      largest = std::max(
          {largest, std::abs(w.Q - bay.force[i % steps_per_bay][0]), std::abs(w.Y - bay.force[i % steps_per_bay][1])});
    }
  }
  return largest / static_load;
}

double static_load(const std::vector<StepRecord>& steps) {
  double sum = 0.0;
  for (const WheelRecord& wheel : steps.front().wheels) sum += wheel.Q;
  return sum / static_cast<double>(steps.front().wheels.size());
}

// Creep forces of a slow train are stiff in its velocities: the residual of Newton's method would fade in tenths of a
// second.
TEST(StartTransient, FirstForcesOfASlowTrainDoNotDependOnTheTolerance) {
  SceneParameters scene = coach_on(TrackKind::flexible);
  scene.train.speed = 40.0 / 3.6;
  scene.track.length_before = 90.0;
  scene.track.length_after = 6.0;
  scene.integration.time_step = 1e-3;
  scene.integration.duration = 1e-3;
  scene.integration.tolerance = 1e-9;
  const StepRecord exact = recorded_steps(scene).front();
  scene.integration.tolerance = IntegrationParameters{}.tolerance;
  const StepRecord first = recorded_steps(scene).front();
  double largest = 0.0;
  for (std::size_t w = 0; w < first.wheels.size(); ++w) {
    largest = std::max(
        {largest, std::abs(first.wheels[w].Y - exact.wheels[w].Y), std::abs(first.wheels[w].Q - exact.wheels[w].Q)});
  }
  std::printf("first forces at 40 km/h, tolerance %g against 1e-9: %.2g N\n", scene.integration.tolerance, largest);
  EXPECT_LT(largest, 1.0);  // N; 100 N where the run-in has the scene's tolerance
}

TEST(StartTransient, RigidTrack) {
  SceneParameters scene = coach_on(TrackKind::rigid);
  const std::vector<StepRecord> steps = recorded_steps(scene);
  const double largest = transient(steps, steps, static_load(steps));
  std::printf("largest transient on a rigid track: %.2g of the wheel load\n", largest);
  EXPECT_LT(largest, 1e-3);
}

TEST(StartTransient, BallastedTrackAndBridgeApproach) {
  const SceneParameters open_track = coach_on(TrackKind::flexible);
  const std::vector<StepRecord> plain = recorded_steps(open_track);
  const double load = static_load(plain);
  const double on_track = transient(plain, plain, load);
  double low = INFINITY, high = 0.0;
  for (const std::array<double, 2>& force : SteadyBay(plain, 0).force) {
    low = std::min(low, force[0]);
    high = std::max(high, force[0]);
  }
  // The first wheelset comes within 8 m of the bridge by the end of the second.
  SceneParameters approach = open_track;
  approach.spans.resize(1);
  approach.train.start = -69.0;
  approach.integration.duration = 1.0;
  const double before_bridge = transient(recorded_steps(approach), plain, load);
  std::printf(
      "largest transient: ballasted track %.2g, bridge approach %.2g of the wheel load; the passage of the sleepers "
      "makes %.2g\n",
      on_track, before_bridge, (high - low) / load);
  EXPECT_LT(on_track, 1e-3);
  EXPECT_LT(before_bridge, 1e-3);
}

// The creep table's numbers have 32 bits: the state of rest is found to what they leave, and rougher starts are not.
// On rough rails that do not yield: wheelsets that began at rest there would lift off in the first step, which would be
// the largest unloading of the run.
TEST(StartTransient, WheelsetsBeginAlongRoughRails) {
  SceneParameters scene = coach_on(TrackKind::rigid);
  scene.train.speed = 160.0 / 3.6;
  scene.integration.duration = 1.0;
  scene.spectrum.emplace();
  scene.spectrum->name = "german-high";
  scene.spectrum->fade_in = 0.0;
  const std::vector<StepRecord> steps = recorded_steps(scene);
  const double load = static_load(steps);
  double first = 0.0, later = 0.0;  // largest change of Q
  for (const StepRecord& step : steps) {
    for (const WheelRecord& wheel : step.wheels) {
      double& largest = step.time < 0.05 ? first : later;
      largest = std::max(largest, std::abs(wheel.Q - load) / load);
    }
  }
  std::printf("largest change of Q: %.1f %% in the first 0.05 s, %.1f %% later\n", 100.0 * first, 100.0 * later);
  EXPECT_LT(first, 0.8 * later);
}

TEST(StartTransient, TheCreepTableStartsFromRestOnBothTracks) {
  for (const TrackKind track : {TrackKind::rigid, TrackKind::flexible}) {
    SceneParameters scene = coach_on(track);
    scene.contact.creep_law = "table";
    scene.integration.duration = 0.05;
    const std::vector<StepRecord> steps = recorded_steps(scene);
    ASSERT_GT(steps.size(), 50u);
    const double rest = steps.front().wheels.front().Q;
    for (const StepRecord& step : steps) EXPECT_NEAR(step.wheels.front().Q, rest, 0.02 * rest);
  }
}

}  // namespace
}  // namespace railtab
