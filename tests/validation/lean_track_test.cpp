// What a track with fewer degrees of freedom changes in a run: a coach that hunts over a rough track and a span.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "../measured.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "recorded_steps.hpp"

namespace railtab {
namespace {

struct Difference {
  double largest = 0.0, of = 0.0, squares = 0.0, dynamic = 0.0;

  void add(double lean, double full, double rest) {
    largest = std::max(largest, std::abs(lean - full));
    of = std::max(of, std::abs(full));
    squares += (lean - full) * (lean - full);
    dynamic += (full - rest) * (full - rest);
  }
  [[nodiscard]] double rms() const { return std::sqrt(squares / dynamic); }
};

SceneParameters rough_span(LongitudinalMotion motion) {
  SceneParameters scene;
  scene.train.speed = 200.0 / 3.6;
  scene.train.start = -25.0;
  scene.train.initial_lateral_shift = 2e-3;
  scene.contact.mode = ContactMode::online;
  scene.track.length_before = 90.0;
  scene.track.longitudinal = motion;
  scene.spans = {BridgeParameters{}};
  scene.spectrum.emplace();
  scene.spectrum->name = "german-low";
  scene.spectrum->fade_in = 0.0;
  scene.integration.time_step = 1e-3;
  scene.integration.duration = 0.8;
  scene.output.every = 1;
  return scene;
}

TEST(LeanTrack, MotionsAlongTheTrackChangeRunsByLessThanOnePercent) {
  const std::vector<StepRecord> lean = testing::recorded_steps(rough_span(LongitudinalMotion::automatic));
  const std::vector<StepRecord> full = testing::recorded_steps(rough_span(LongitudinalMotion::kept));
  ASSERT_EQ(lean.size(), full.size());
  Difference Q, Y, car, deck;
  for (std::size_t i = 0; i < full.size(); ++i) {
    for (std::size_t w = 0; w < full[i].wheels.size(); ++w) {
      Q.add(lean[i].wheels[w].Q, full[i].wheels[w].Q, full[0].wheels[w].Q);
      Y.add(lean[i].wheels[w].Y, full[i].wheels[w].Y, full[0].wheels[w].Y);
    }
    for (std::size_t k : {1U, 2U}) car.add(lean[i].bodies[0].acceleration[k], full[i].bodies[0].acceleration[k], 0.0);
    deck.add(lean[i].nodes[0].acceleration[2], full[i].nodes[0].acceleration[2], 0.0);
  }
  std::printf("rms and largest differences: Q %.2e %.2e, Y %.2e %.2e, car body %.2e %.2e, deck %.2e %.2e\n", Q.rms(),
              Q.largest / Q.of, Y.rms(), Y.largest / Y.of, car.rms(), car.largest / car.of, deck.rms(),
              deck.largest / deck.of);
  testing::measured("lean.Q_rms", Q.rms());
  testing::measured("lean.Y_rms", Y.rms());
  testing::measured("lean.car_rms", car.rms());
  testing::measured("lean.deck_rms", deck.rms());
  EXPECT_LT(Q.rms(), 0.01);
  EXPECT_LT(Y.rms(), 0.01);
  EXPECT_LT(car.rms(), 1e-3);
  EXPECT_LT(deck.rms(), 0.02);
  EXPECT_LT(Q.largest, 0.01 * Q.of);
  EXPECT_GT(Q.rms(), 0.0);
}

// The deflection of elements between their nodes is exact at rest. What is left are waves shorter than some elements.
TEST(LeanTrack, OneRailElementPerBayIsCloseToEight) {
  SceneParameters scene = rough_span(LongitudinalMotion::automatic);
  scene.integration.time_step = 5e-4;
  const auto run = [&](int elements) {
    scene.track.elements_per_bay = elements;
    return testing::recorded_steps(scene);
  };
  const std::vector<StepRecord> one = run(1), eight = run(8);
  ASSERT_EQ(one.size(), eight.size());
  Difference Q, Y, deck;
  for (std::size_t i = 0; i < eight.size(); ++i) {
    for (std::size_t w = 0; w < eight[i].wheels.size(); ++w) {
      Q.add(one[i].wheels[w].Q, eight[i].wheels[w].Q, eight[0].wheels[w].Q);
      Y.add(one[i].wheels[w].Y, eight[i].wheels[w].Y, eight[0].wheels[w].Y);
    }
    deck.add(one[i].nodes[0].acceleration[2], eight[i].nodes[0].acceleration[2], 0.0);
  }
  std::printf("one element and eight: Q %.2e, Y %.2e, deck %.2e\n", Q.rms(), Y.rms(), deck.rms());
  testing::measured("lean.one_element.Q_rms", Q.rms());
  testing::measured("lean.one_element.Y_rms", Y.rms());
  testing::measured("lean.one_element.deck_rms", deck.rms());
  EXPECT_LT(Q.rms(), 0.006);
  EXPECT_LT(Y.rms(), 0.003);
  EXPECT_LT(deck.rms(), 0.005);  // unfiltered, up to the waves of single elements
}

}  // namespace
}  // namespace railtab
