// What the division of steps at impacts costs where there are none: a train on ordinary rough track.

#include <gtest/gtest.h>

#include <cstdio>

#include "../measured.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/scene/scene_run.hpp"

namespace railtab {
namespace {

struct RoughRun {
  RunSummary summary;
  double largest_Q = 0.0;  // [N]
};

TEST(RoughTrack, StepsAreDividedForImpactsOnly) {
  SceneParameters scene;
  scene.train.count = 8;
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

}  // namespace
}  // namespace railtab
