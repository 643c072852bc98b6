// A train on ordinary rough track: what the division of steps at impacts costs where there are none, and what forces
// that follow the tangent without an evaluation differ by.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "../measured.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/scene/scene_run.hpp"
#include "recorded_steps.hpp"

namespace railtab {
namespace {

struct RoughRun {
  RunSummary summary;
  double largest_Q = 0.0;  // [N]
};

SceneParameters rough_track(int coaches) {
  SceneParameters scene;
  scene.train.count = coaches;
  scene.train.speed = 200.0 / 3.6;
  scene.contact.mode = ContactMode::online;
  scene.track.length_before = 240.0;
  scene.track.length_after = 60.0;
  scene.spans.clear();
  scene.spectrum.emplace();
  scene.spectrum->name = "german-low";
  scene.spectrum->fade_in = 0.0;
  scene.integration.time_step = 1e-3;
  scene.integration.duration = 0.3;
  return scene;
}

TEST(RoughTrack, StepsAreDividedForImpactsOnly) {
  SceneParameters scene = rough_track(8);
  const auto run = [&](std::optional<ContactForceRule> rule) {
    scene.integration.contact_force = rule;
    VsiModel model = build_model(scene);
    RoughRun r{run_scene(scene, model, {}), 0.0};
    r.largest_Q = r.summary.wheel_extremes.largest_Q.value;
    return r;
  };
  const RoughRun automatic = run({}), endpoint = run(ContactForceRule::endpoint);
  ASSERT_TRUE(automatic.summary.complete && endpoint.summary.complete);
  const auto ratio = [](long a, long b) { return static_cast<double>(a) / static_cast<double>(b); };
  const double iterations = ratio(automatic.summary.newton_iterations, endpoint.summary.newton_iterations);
  const double solutions = ratio(automatic.summary.back_substitutions, endpoint.summary.back_substitutions);
  std::printf(
      "automatic rule over endpoint: %.3f of the iterations, %.3f of the back-substitutions, Q %.0f and %.0f N\n",
      iterations, solutions, automatic.largest_Q, endpoint.largest_Q);
  testing::measured("rough.automatic.iterations", iterations);
  testing::measured("rough.automatic.solutions", solutions);
  EXPECT_LT(iterations, 1.15);
  EXPECT_LT(solutions, 1.15);
  EXPECT_NEAR(automatic.largest_Q, endpoint.largest_Q, 2e-3 * endpoint.largest_Q);
}

/// Forces at the default tolerance, where small corrections are made by the tangent alone, against converged ones.
TEST(RoughTrack, ForcesByTheTangentKeepTheTolerance) {
  SceneParameters scene = rough_track(2);
  scene.output.every = 1;
  const std::vector<StepRecord> steps = testing::recorded_steps(scene);
  scene.integration.tolerance = 1e-9;
  const std::vector<StepRecord> converged = testing::recorded_steps(scene);
  ASSERT_EQ(steps.size(), converged.size());
  const std::size_t wheels = steps.front().wheels.size();
  double load = 0.0, squares = 0.0;
  std::vector<double> differences;  // by the tolerance
  for (const WheelRecord& wheel : steps.front().wheels) load += wheel.Q / static_cast<double>(wheels);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    for (std::size_t w = 0; w < wheels; ++w) {
      const WheelRecord &a = steps[i].wheels[w], &b = converged[i].wheels[w];
      const double difference = std::hypot(a.Q - b.Q, a.Y - b.Y) / (1e-4 * load);
      differences.push_back(difference);
      squares += difference * difference;
    }
  }
  const double rms = std::sqrt(squares / static_cast<double>(steps.size() * wheels));
  std::sort(differences.begin(), differences.end());
  const double most = differences[differences.size() * 99 / 100], largest = differences.back();
  std::printf("forces against converged ones, in tolerances: rms %.2f, 99 %% %.2f, largest %.2f\n", rms, most, largest);
  testing::measured("rough.tangent.rms", rms);
  testing::measured("rough.tangent.p99", most);
  testing::measured("rough.tangent.largest", largest);
  EXPECT_LT(rms, 1.0);
  EXPECT_LT(most, 2.5);
  EXPECT_LT(largest, 15.0);  // for some steps after a second patch has come or gone
}

/// Evaluations of the contact per wheel and step, pre-roll apart.
TEST(RoughTrack, FewEvaluationsAreEnough) {
  SceneParameters scene = rough_track(2);
  const auto queries = [&](double duration) {
    scene.integration.duration = duration;
    return static_cast<double>(run_scene(scene, {}).contact_queries);
  };
  const double steps = 0.3 / scene.integration.time_step, wheels = 16.0;
  const double evaluations = (queries(0.6) - queries(0.3)) / (steps * wheels);
  std::printf("%.2f evaluations per wheel and step\n", evaluations);
  testing::measured("rough.evaluations", evaluations);
  EXPECT_LT(evaluations, 2.8);  // 3.3 with an evaluation after every correction
}

}  // namespace
}  // namespace railtab
