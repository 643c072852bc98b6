// Extremes of the whole deck against the recorded series of its nodes, in runs of wheels that follow the rails.
#include "railtab/runtime/results/deck_envelope.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/measures/low_pass.hpp"
#include "railtab/runtime/scene/recorded_run.hpp"
#include "railtab/runtime/scene/scene_run.hpp"
#include "railtab/tables/files/array_file.hpp"
#include "scene_fixture.hpp"

namespace railtab {
namespace {

SceneParameters crossing() {
  SceneParameters scene;
  scene.contact.normal = NormalContact::rigid;
  scene.train.start = -1.0;
  scene.train.speed = 70.0;
  scene.track.length_before = 40.0;
  scene.track.length_after = 30.0;
  BridgeParameters span;
  span.length = 16.0;
  span.elements = 16;
  span.Iy = 2.0;
  scene.spans.assign(2, span);
  scene.structure.report = {4.0, 8.0, 11.0, 20.0};
  scene.integration.time_step = 1e-3;
  scene.integration.duration = 0.7;
  scene.output.deck_envelope = true;
  return scene;
}

struct Passage {
  ResultHeader header;
  std::vector<StepRecord> records;
  std::vector<RunCheckpoint> checkpoints;
  RunSummary summary;

  [[nodiscard]] std::size_t index(std::string_view quantity) const {
    const auto places = std::ranges::find(header.deck, quantity, &DeckPlaces::quantity);
    if (places == header.deck.end()) throw std::out_of_range(std::string(quantity));
    return static_cast<std::size_t>(places - header.deck.begin());
  }
  struct Extreme {
    double smallest, smallest_time, largest, largest_time;
    bool operator==(const Extreme&) const = default;
  };
  [[nodiscard]] Extreme at(std::string_view quantity, double x) const {
    const std::size_t q = index(quantity);
    const auto i = static_cast<std::size_t>(std::ranges::find(header.deck[q].x, x) - header.deck[q].x.begin());
    const DeckExtremes& of = summary.deck.at(q);
    return {of.smallest.at(i), of.smallest_time.at(i), of.largest.at(i), of.largest_time.at(i)};
  }
};

Passage run(const SceneParameters& scene, const std::optional<RunCheckpoint>& from = std::nullopt) {
  Passage result;
  RunObserver observer;
  observer.start = [&](const ResultHeader& header) { result.header = header; };
  observer.record = [&](const StepRecord& record) { result.records.push_back(record); };
  observer.checkpoint = [&](long step, std::span<const double> state) {
    result.checkpoints.push_back({step, {state.begin(), state.end()}});
  };
  result.summary = run_scene(scene, observer, from);
  EXPECT_TRUE(result.summary.complete) << result.summary.message;
  return result;
}

Passage::Extreme extreme_of(const std::vector<double>& series, double step) {
  const auto [low, high] = std::minmax_element(series.begin(), series.end());
  const auto first_high = std::max_element(series.begin(), series.end());
  return {*low, step * static_cast<double>(low - series.begin()), *high,
          step * static_cast<double>(first_high - series.begin())};
}

void expect_as_recorded(const Passage& found, double step, double cut_off) {
  for (std::size_t n = 0; n < found.header.node_names.size(); ++n) {
    if (!is_deck(found.header.node_names[n])) continue;
    std::vector<double> displacement, acceleration;
    for (const StepRecord& record : found.records) {
      displacement.push_back(record.nodes[n].displacement[2]);
      acceleration.push_back(record.nodes[n].acceleration[2]);
    }
    const double x = found.header.node_x[n];
    EXPECT_EQ(found.at("displacement", x), extreme_of(displacement, step)) << x;
    EXPECT_EQ(found.at("acceleration", x), extreme_of(acceleration, step)) << x;
    const Passage::Extreme filtered = found.at("filtered_acceleration", x);
    const Passage::Extreme stored = extreme_of(low_passed(acceleration, cut_off, step), step);
    EXPECT_NEAR(filtered.largest, stored.largest, 1e-12) << x;
    EXPECT_NEAR(filtered.smallest, stored.smallest, 1e-12) << x;
    EXPECT_EQ(filtered.largest_time, stored.largest_time) << x;
    EXPECT_GT(filtered.largest, 0.1) << "a passage that accelerates the deck";
  }
}

TEST(DeckEnvelope, IsThatOfTheStoredSeries) {
  const SceneParameters scene = crossing();
  const Passage found = run(scene);
  EXPECT_EQ(found.header.deck[found.index("displacement")].x.size(), 34U) << "all nodes of both spans";
  EXPECT_EQ(found.header.deck_cut_off, 30.0);
  expect_as_recorded(found, 1e-3, 30.0);
}

TEST(DeckEnvelope, TakesEveryStepWhateverIsRecorded) {
  SceneParameters scene = crossing();
  const Passage all = run(scene);
  scene.output.every = 50;
  scene.output.nodes = {};
  const Passage few = run(scene);
  EXPECT_LT(few.records.size(), 20U);
  ASSERT_EQ(few.summary.deck.size(), all.summary.deck.size());
  for (std::size_t q = 0; q < all.summary.deck.size(); ++q) {
    EXPECT_EQ(few.summary.deck[q].largest, all.summary.deck[q].largest);
    EXPECT_EQ(few.summary.deck[q].smallest_time, all.summary.deck[q].smallest_time);
  }
}

TEST(DeckEnvelope, ChangesNothingElse) {
  SceneParameters scene = crossing();
  const Passage with = run(scene);
  scene.output.deck_envelope = false;
  const Passage without = run(scene);
  EXPECT_TRUE(without.header.deck.empty());
  EXPECT_TRUE(without.summary.deck.empty());
  ASSERT_EQ(with.records.size(), without.records.size());
  for (std::size_t i = 0; i < with.records.size(); ++i) {
    const auto &a = with.records[i].nodes, &b = without.records[i].nodes;
    ASSERT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])), 0) << "record " << i;
  }
}

TEST(DeckEnvelope, OfSpansBehindAMovingWindow) {
  SceneParameters scene = crossing();
  scene.spans.assign(6, scene.spans.front());
  scene.reduction = {Reduction::window, 6.0, 6.0};
  scene.integration.duration = 1.6;
  const Passage found = run(scene);
  expect_as_recorded(found, 1e-3, 30.0);
  scene.output.deck_envelope = false;
  const Passage without = run(scene);
  ASSERT_EQ(found.records.size(), without.records.size());
  for (std::size_t i = 0; i < found.records.size(); ++i) {
    const auto &a = found.records[i].nodes, &b = without.records[i].nodes;
    ASSERT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])), 0) << "record " << i;
  }
}

TEST(DeckEnvelope, OfAResumedRunIsThatOfTheWholeOne) {
  SceneParameters scene = crossing();
  scene.integration.reinitialise_every = 90;
  const Passage whole = run(scene);
  ASSERT_GE(whole.checkpoints.size(), 5U);
  for (const std::size_t c : {std::size_t{0}, whole.checkpoints.size() - 1}) {
    const Passage resumed = run(scene, whole.checkpoints[c]);
    for (std::size_t q = 0; q < whole.summary.deck.size(); ++q) {
      EXPECT_EQ(resumed.summary.deck[q].smallest, whole.summary.deck[q].smallest);
      EXPECT_EQ(resumed.summary.deck[q].largest, whole.summary.deck[q].largest);
      EXPECT_EQ(resumed.summary.deck[q].largest_time, whole.summary.deck[q].largest_time);
    }
  }
  SceneParameters plain = scene;
  plain.output.deck_envelope = false;
  const Passage without = run(plain);
  EXPECT_THROW(static_cast<void>(run(scene, without.checkpoints[0])), InputError) << "no envelope in that checkpoint";
}

// A process may end between the checkpoint of the last step and the record of it, which no multiple asks for.
TEST(Checkpoint, AtTheEndOfARunLeavesItsLastRecordToMake) {
  SceneParameters scene = crossing();
  scene.output.every = 7;
  scene.integration.duration = 200 * scene.integration.time_step;
  scene.integration.reinitialise_every = 100;
  const Passage whole = run(scene);
  ASSERT_EQ(whole.checkpoints.size(), 2U);
  const Passage resumed = run(scene, whole.checkpoints.back());
  ASSERT_EQ(resumed.records.size(), 1U);
  const StepRecord &last = whole.records.back(), &made = resumed.records.back();
  EXPECT_EQ(made.time, last.time);
  ASSERT_EQ(std::memcmp(made.nodes.data(), last.nodes.data(), last.nodes.size() * sizeof(last.nodes[0])), 0);
}

TEST(DeckEnvelope, HoldsNoMoreTheLongerTheRun) {
  SceneParameters scene = crossing();
  scene.integration.reinitialise_every = 100;
  scene.integration.duration = 0.5;
  const auto largest = [](const Passage& r) {
    std::size_t most = 0;
    for (const RunCheckpoint& c : r.checkpoints) most = std::max(most, c.state.size());
    return most;
  };
  const std::size_t of_half_a_second = largest(run(scene));
  scene.spans.assign(4, scene.spans.front());
  scene.train.speed = 30.0;
  scene.integration.duration = 2.0;
  const Passage longer = run(scene);
  // four spans have twice the nodes
  EXPECT_LT(largest(longer), 3 * of_half_a_second);
}

class EnvelopeScene : public Scene {};

TEST_F(EnvelopeScene, AsksForADeckAndShortSteps) {
  const std::string bridge = "[contact]\nnormal = \"rigid\"\n[[bridge]]\nlength = 20.0\n";
  EXPECT_TRUE(read(bridge + "[output]\ndeck_envelope = true\ndeck_cut_off = 40.0\n").output.deck_envelope);
  EXPECT_EQ(
      message("[contact]\nnormal = \"rigid\"\n[track]\nkind = \"rigid\"\n[integration]\nduration = 1.0\n"
              "[output]\ndeck_envelope = true\n"),
      "scene.toml:8: output.deck_envelope: found true without a deck, expected a [[bridge]] under flexible track, "
      "or a [structure] with nodes and structure.deck");
  const std::string coarse =
      message(bridge + "[integration]\ntime_step = 0.01\n[output]\ndeck_envelope = true\ndeck_cut_off = 30\n");
  EXPECT_NE(coarse.find("30 Hz with integration.time_step = 0.01 s, expected at most 25 Hz, or shorter steps"),
            std::string::npos)
      << coarse;
  EXPECT_NE(message(bridge + "[output]\ndeck_cut_off = 30.0\n").find("output.deck_envelope = true"), std::string::npos);
}

TEST_F(EnvelopeScene, StandsInTheResultsFile) {
  SceneParameters scene = crossing();
  scene.text = "a scene";
  const std::filesystem::path file = folder_ / "results.h5";
  RunObserver observer;
  const RunSummary summary = RecordedRun(scene, file, false).run(observer);
  ASSERT_TRUE(summary.complete) << summary.message;
  const RunResults read_back = read_results(file);
  ASSERT_EQ(read_back.header.deck.size(), read_back.summary.deck.size());
  EXPECT_EQ(read_back.header.deck_cut_off, 30.0);
  for (std::size_t q = 0; q < summary.deck.size(); ++q) {
    EXPECT_EQ(read_back.summary.deck[q].largest, summary.deck[q].largest);
    EXPECT_EQ(read_back.summary.deck[q].smallest, summary.deck[q].smallest);
    EXPECT_EQ(read_back.summary.deck[q].largest_time, summary.deck[q].largest_time);
    EXPECT_EQ(read_back.summary.deck[q].smallest_time, summary.deck[q].smallest_time);
    EXPECT_EQ(read_back.summary.deck[q].largest.size(), read_back.header.deck[q].x.size());
  }
}

TEST_F(EnvelopeScene, ChangedExtremesAreFound) {
  SceneParameters scene = crossing();
  scene.text = "a scene";
  const std::filesystem::path file = folder_ / "results.h5";
  RunObserver quiet;
  ASSERT_TRUE(RecordedRun(scene, file, false).run(quiet).complete);
  std::vector<double> largest = read_results(file).summary.deck[0].largest;
  largest[3] *= 0.5;
  {
    ArrayFileWriter writer = ArrayFileWriter::reopen(file, results_filetype, 5);
    writer.replace("deck/displacement/largest", largest);
    writer.close();
  }
  EXPECT_THROW(static_cast<void>(read_results(file)), InputError);
}

// A run that is stopped has the extremes up to there; the rest of it those of the whole run.
TEST_F(EnvelopeScene, OfARunThatIsStoppedAndResumed) {
  SceneParameters scene = crossing();
  scene.text = "a scene";
  const std::filesystem::path file = folder_ / "results.h5", whole_file = folder_ / "whole.h5";
  int steps = 0;
  RunObserver observer;
  observer.stop = [&] { return ++steps == 300; };
  EXPECT_TRUE(RecordedRun(scene, file, false).run(observer).interrupted);
  const RunResults part = read_results(file);
  ASSERT_FALSE(part.summary.deck.empty());
  EXPECT_LE(*std::ranges::max_element(part.summary.deck[0].largest_time), 0.3 + 1e-9);
  RunObserver quiet;
  ASSERT_TRUE(RecordedRun(scene, file, true).run(quiet).complete);
  scene.integration.reinitialise_every = 2000;
  const RunResults resumed = read_results(file);
  ASSERT_TRUE(RecordedRun(scene, whole_file, false).run(quiet).complete);
  const RunResults whole = read_results(whole_file);
  for (std::size_t q = 0; q < whole.summary.deck.size(); ++q) {
    for (std::size_t i = 0; i < whole.summary.deck[q].largest.size(); ++i) {
      EXPECT_NEAR(resumed.summary.deck[q].largest[i], whole.summary.deck[q].largest[i],
                  1e-6 * (1.0 + std::abs(whole.summary.deck[q].largest[i])));
    }
  }
}

}  // namespace
}  // namespace railtab
