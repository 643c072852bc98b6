// Runs with a reduced structure against the same runs without, and resumed against uninterrupted.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "railtab/runtime/measures/dynamic_difference.hpp"
#include "railtab/runtime/scene/reduction_check.hpp"

namespace railtab {
namespace {

SceneParameters coach_on_spans(Reduction reduction) {
  SceneParameters scene;
  scene.contact.mode = ContactMode::online;
  scene.train.start = -2.0;
  scene.track.length_before = 60.0;
  scene.track.length_after = 40.0;
  BridgeParameters span;
  span.length = 16.0;
  span.elements = 16;
  span.Iy = 2.0;
  scene.spans.assign(4, span);
  scene.spectrum = SpectrumParameters{.fade_in = 0.0};
  scene.integration.time_step = 1e-3;
  scene.integration.tolerance = 1e-7;  // what the window does, not where an iteration ends
  scene.reduction.kind = reduction;
  return scene;
}

TEST(ReducedRun, WindowIsWithinOnePercent) {
  const ReductionError e = check_reduction(coach_on_spans(Reduction::window), 0.8);
  EXPECT_LT(e.force_max, 0.01);
  EXPECT_LT(e.deck_max, 0.01);
  EXPECT_LT(e.rms_Y, 0.01);
  EXPECT_GT(e.rms_Y, 0.0);
  EXPECT_GT(e.force_max, 0.0) << "a window is an approximation: equal runs would be one run";
  EXPECT_EQ(e.whole.window_error, 0.0);
}

// Two steps of one wheel: the part that differs from the mean counts.
TEST(ReductionError, RootMeanSquaresAreOfTheDynamicPart) {
  ComparedHistory whole, reduced;
  whole.static_load = {50.0};
  whole.force = {{99.0F}, {101.0F}};
  whole.lateral = {{-5.0F}, {5.0F}};
  whole.deck = {{7.0F}, {7.0F}};
  reduced = whole;
  reduced.force[0][0] = 99.5F;
  reduced.lateral[1][0] = 2.0F;
  const ReductionError e = compare(reduced, whole);
  EXPECT_DOUBLE_EQ(e.rms_Q, std::sqrt(0.25 / 2.0));
  EXPECT_DOUBLE_EQ(e.rms_Y, std::sqrt(9.0 / 50.0));
  EXPECT_EQ(e.rms_deck, 0.0);
  const DynamicDifference of = dynamic_difference(whole.lateral, reduced.lateral);
  EXPECT_EQ(of.largest, 3.0);
  EXPECT_EQ(of.dynamic_largest, 5.0);
}

// What a run states of its window follows what the window does to its results.
TEST(ReducedRun, WindowStatesItsError) {
  const auto error = [](double reach) {
    SceneParameters scene = coach_on_spans(Reduction::window);
    scene.reduction.behind = scene.reduction.ahead = reach;
    const ReductionError e = check_reduction(scene, 0.8);
    std::printf("window %2.0f m: stated %.2e, forces %.2e, deck %.2e\n", reach, e.reduced.window_error, e.force_max,
                e.deck_max);
    return e;
  };
  const ReductionError near = error(5.0), far = error(20.0);
  for (const ReductionError* e : {&near, &far}) {
    EXPECT_GT(e->reduced.window_error, 0.0);
    EXPECT_LT(e->deck_max, 10.0 * e->reduced.window_error);
  }
  EXPECT_LT(far.reduced.window_error, near.reduced.window_error);
}

// The coach leaves the first spans, which vibrate on in their own modes: 44 m/s over four spans of 16 m, and on.
TEST(ReducedRun, SpansBehindTheWindowVibrateOn) {
  SceneParameters scene = coach_on_spans(Reduction::window);
  scene.contact.normal = NormalContact::rigid;
  scene.track.length_after = 120.0;
  scene.reduction.behind = 10.0;
  scene.integration.duration = 3.0;
  const ReductionError e = check_reduction(scene, 3.0);
  EXPECT_LT(e.deck_max, 0.02);
  EXPECT_GT(e.deck_max, 0.0);
}

struct RecordedRun {
  std::vector<StepRecord> records;
  std::vector<RunCheckpoint> checkpoints;
};

RecordedRun recorded(const SceneParameters& scene, const std::optional<RunCheckpoint>& from = std::nullopt) {
  RecordedRun result;
  RunObserver observer;
  observer.record = [&](const StepRecord& record) { result.records.push_back(record); };
  observer.checkpoint = [&](long step, std::span<const double> state) {
    result.checkpoints.push_back({step, {state.begin(), state.end()}});
  };
  const RunSummary summary = run_scene(scene, observer, from);
  EXPECT_TRUE(summary.complete) << summary.message;
  return result;
}

bool same(const StepRecord& a, const StepRecord& b) {
  const auto equal = [](const auto& x, const auto& y) {
    return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0;
  };
  return a.time == b.time && equal(a.bodies, b.bodies) && equal(a.nodes, b.nodes) &&
         a.wheels.size() == b.wheels.size() && [&] {
           for (std::size_t w = 0; w < a.wheels.size(); ++w) {
             if (a.wheels[w].Q != b.wheels[w].Q || a.wheels[w].Y != b.wheels[w].Y) return false;
           }
           return true;
         }();
}

class ResumedRun : public ::testing::TestWithParam<Reduction> {};

void expect_same_when_resumed(const SceneParameters& scene, const RecordedRun& whole, std::size_t checkpoint) {
  const auto step = static_cast<std::size_t>(whole.checkpoints[checkpoint].step);
  const RecordedRun resumed = recorded(scene, whole.checkpoints[checkpoint]);
  ASSERT_EQ(resumed.records.size() + step + 1, whole.records.size());
  for (std::size_t i = 0; i < resumed.records.size(); ++i)
    ASSERT_TRUE(same(resumed.records[i], whole.records[step + 1 + i])) << "step " << step + 1 + i;
}

// At 80 m/s the last wheelset, 21.56 m behind the first, enters the third span of 16 m right before step 800: the
// window leaves the first span there.
TEST(ResumedWindow, MovesOnceWhereTheRunGoesOn) {
  SceneParameters scene = coach_on_spans(Reduction::window);
  scene.reduction.behind = scene.reduction.ahead = 6.0;
  scene.train.speed = 80.0;
  scene.train.start = -10.4;
  scene.integration.reinitialise_every = 800;
  scene.integration.duration = 0.9;
  const RecordedRun whole = recorded(scene);
  ASSERT_EQ(whole.checkpoints.size(), 1U);
  expect_same_when_resumed(scene, whole, 0);
}

// From every checkpoint: the window moves several times in between, and spans fall behind.
TEST_P(ResumedRun, IsTheUninterruptedOneToTheLastBit) {
  SceneParameters scene = coach_on_spans(GetParam());
  scene.reduction.behind = scene.reduction.ahead = 6.0;
  scene.integration.reinitialise_every = 70;
  scene.integration.duration = GetParam() == Reduction::window ? 1.0 : 0.2;
  if (GetParam() == Reduction::window) scene.train.speed = 80.0;
  scene.track.length_after = 60.0;
  const RecordedRun whole = recorded(scene);
  ASSERT_GE(whole.checkpoints.size(), 2U);
  for (std::size_t c = 0; c < whole.checkpoints.size(); c += 5) expect_same_when_resumed(scene, whole, c);
}
INSTANTIATE_TEST_SUITE_P(Reductions, ResumedRun, ::testing::Values(Reduction::none, Reduction::window),
                         [](const auto& instance) {
                           std::string name(reduction_name(instance.param));
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace railtab
