#include "assess_contact.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "assess_stages.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/line/irregularity.hpp"
#include "railtab/runtime/line/irregularity_spectrum.hpp"
#include "railtab/runtime/line/rail_friction.hpp"
#include "railtab/runtime/measures/low_pass.hpp"
#include "railtab/runtime/results/result_file.hpp"
#include "railtab/runtime/scene/judged_stretch.hpp"
#include "railtab/runtime/scene/scene_structure.hpp"

namespace railtab::vsi {
namespace {

using assess::Assessment;
using assess::RunAssessment;

/// The train starts before the bridge. A random track rises from zero, and has done so where the bridge begins.
void start_before_bridge(const std::vector<assess::DeckAssessment>& decks, ContactPlan& plan) {
  SceneParameters& scene = plan.scene;
  double begin = 0.0;  // of the bridge
  for (const assess::DeckAssessment& deck : decks) begin = std::min(begin, deck.deck.start);
  const double rise = scene.spectrum ? scene.spectrum->fade_length() : 0.0;
  std::string note;
  if (rise > 0.0) note = fmt::format("The random track rises from zero over {:g} m (irregularity.fade_in).", rise);
  if (const double shortage = scene.train.start + rise - begin; shortage > 0.0) {
    scene.train.start -= shortage;
    scene.track.length_before += shortage;
    note += fmt::format("{}The train starts {:g} m earlier, at x = {:g} m, {} (train.start, track.length_before).",
                        note.empty() ? "" : " ", shortage, scene.train.start,
                        rise > 0.0 ? "so that it has risen where the bridge begins" : "where the bridge begins");
  }
  if (!note.empty()) plan.notes.push_back(std::move(note));
}

/// Decks vibrate on freely behind the train, at times more than under it.
void follow_free_vibration(const std::vector<assess::DeckAssessment>& decks, ContactPlan& plan) {
  constexpr double periods = 3.0;
  if (plan.scene.track_kind != TrackKind::flexible) return;
  double lowest = std::numeric_limits<double>::infinity();
  for (const assess::DeckAssessment& deck : decks) lowest = std::min(lowest, deck.deck.first_frequency());
  IntegrationParameters& integration = plan.scene.integration;
  integration.free_vibration = std::max(integration.free_vibration, periods / lowest);
  plan.notes.push_back(
      fmt::format("A run goes on for {:.2g} s after the train has left, {:g} periods of the lowest frequency or more "
                  "(integration.free_vibration).",
                  integration.free_vibration, periods));
  if (integration.duration > 0.0) {
    integration.duration = 0.0;
    plan.notes.emplace_back("integration.duration does not count.");
  }
}

/// The track goes on until the last wheelset has left the bridge, and for the free vibration after it.
void lengthen_track(const AxleTrain& own, double fastest, ContactPlan& plan) {
  constexpr double margin = 5.0;  // [m]
  SceneParameters& scene = plan.scene;
  if (scene.track_kind != TrackKind::flexible) return;
  const double behind = own.reach() + margin - scene.train.start;
  const double after = own.reach() + margin + fastest * scene.integration.free_vibration;
  if (behind > scene.track.length_before) {
    scene.track.length_before = behind;
    plan.notes.push_back(fmt::format("track.length_before is {:.4g} m, so that the whole train stands on it.", behind));
  }
  if (after > scene.track.length_after) {
    scene.track.length_after = after;
    plan.notes.push_back(
        fmt::format("track.length_after is {:.4g} m, so that the whole train leaves the bridge.", after));
  }
}

}  // namespace

void record_what_is_judged(SceneParameters& scene) {
  constexpr double longest = 1e-3;  // [s] between records
  const double steps = std::floor(longest / scene.integration.time_step * (1.0 + 1e-9));
  scene.output.every = std::max(1, static_cast<int>(std::min(1e6, steps)));
  scene.output.wheels = true;
  scene.output.bodies = {scene.train.vehicle == imported_vehicle ? "*" : "*car-body"};
  scene.output.nodes.clear();  // no deck: its pattern would fit no node
  if (scene.track_kind != TrackKind::flexible) scene.output.nodes = {"*"};
  if (scene.track_kind == TrackKind::flexible && has_deck_nodes(scene)) scene.output.nodes = {"deck*"};
}

namespace {

/// Twist of the track without traffic, by the difference of the rails' heights; empty where the track is perfect.
std::function<double(double, double)> track_twist_of(const SceneParameters& scene) {
  if (!scene.irregularity && !scene.spectrum) return {};
  return [file = scene.irregularity, spectrum = scene.spectrum, start = scene.train.start](double first, double last) {
    constexpr double base = 3.0, step = 0.1;  // [m]
    const Irregularity track =
        file ? read_irregularity(*file) : random_irregularity(*spectrum, first, last + base, start);
    const auto cross_level = [&](double x) { return track.at(RailSide::right, x).z - track.at(RailSide::left, x).z; };
    double largest = 0.0;
    for (double x = first; x <= last + 1e-9; x += step) {
      largest = std::max(largest, std::abs(cross_level(x + base) - cross_level(x)));
    }
    return largest;
  };
}

}  // namespace

assess::RunWindow judged_window(const SceneParameters& scene) {
  assess::RunWindow window;
  window.track_twist = track_twist_of(scene);
  window.begin = judging_begin(scene);
  if (scene.assessment.end) window.end = *scene.assessment.end;
  window.section_length = scene.assessment.section_length;
  window.section_step = scene.assessment.section_step;
  const std::filesystem::path& file = scene.contact.friction_file;
  window.friction = file.empty() ? scene.contact.friction : read_rail_friction(file).largest();
  return window;
}

bool follow_deck(SceneParameters& scene, double cut_off) {
  constexpr double least_samples = 5.0;  // in a period of the cut-off
  const double step = scene.integration.time_step;
  const bool fast = samples_fast_enough(cut_off, step);
  scene.output.deck_envelope = has_deck_nodes(scene);
  if (scene.output.deck_envelope) scene.output.deck_cut_off = fast ? cut_off : 1.0 / (least_samples * step);
  return scene.output.deck_envelope && fast;
}

namespace {

/// All nodes of the deck at every step, where that is possible.
void follow_deck_of(ContactPlan& plan) {
  SceneParameters& scene = plan.scene;
  const double cut_off = plan.window.deck_cut_off;
  const bool filtered = follow_deck(scene, cut_off);
  const std::string followed = scene.output.deck_envelope
                                   ? "Decks are judged at all their nodes and every step (output.deck_envelope)"
                                   : "Decks are judged at their recorded nodes (structure.report)";
  const double apart = scene.integration.time_step * (scene.output.deck_envelope ? 1 : scene.output.every);
  plan.notes.push_back(filtered || samples_fast_enough(cut_off, apart)
                           ? fmt::format("{}, accelerations low-passed at {:.1f} Hz.", followed, cut_off)
                           : fmt::format("{}, but not by their accelerations: the low-pass at {:.1f} Hz takes values "
                                         "at most {:.3g} s apart, and these are {:g} s apart (integration.time_step).",
                                         followed, cut_off, longest_low_pass_step(cut_off), apart));
}

/// Runs that lack a measure, by its name and the reason.
using Gaps = std::map<std::pair<std::string, std::string>, std::vector<std::string>>;

/// Values of a run for the whole assessment.
void take_up(const ContactPlan& plan, const SweepRun& run, const RunPool& pool, Assessment& assessment, Gaps& gaps) {
  RunAssessment& entry = assessment.runs.emplace_back();
  entry.name = run.name;
  entry.train = plan.train;
  entry.speed = run.speed;
  if (plan.scene.spectrum) entry.seed = run.seed;
  entry.results = pool.file(run.name, ".h5").string();
  if (!pool.finished(run.name)) {
    entry.message = "the run is not finished";
    return;
  }
  const RunResults results = read_results(entry.results);
  entry.there = true;
  entry.complete = results.summary.complete;
  entry.message = results.summary.message;
  assess::RunWindow window = judged_window(scene_of(plan.scene, run));
  window.deck_cut_off = plan.window.deck_cut_off;
  assess::RunMeasures measures = assess::run_measures(results, window);
  for (MeasuredValue& value : measures.values) {
    value.train = plan.train;
    value.seed = entry.seed;
    value.run = run.name;
    assessment.values.push_back(value);
    entry.values.push_back(std::move(value));
  }
  for (const MissingMeasure& missing : measures.missing) gaps[{missing.measure, missing.reason}].push_back(run.name);
}

/// A measure that some runs lack and others have is known in part.
void note_gaps(const Gaps& gaps, Assessment& assessment) {
  for (const auto& [gap, runs] : gaps) {
    const std::string &measure = gap.first, &reason = gap.second;
    const bool partly = std::any_of(assessment.values.begin(), assessment.values.end(), [&](const MeasuredValue& v) {
      return v.measure == measure && v.stage == AssessmentStage::contact;
    });
    const std::string where =
        runs.size() == 1 ? runs.front() : fmt::format("{} and {} more", runs.front(), runs.size() - 1);
    assessment.missing.push_back(
        {measure, AssessmentStage::contact, partly ? fmt::format("{} (run {})", reason, where) : reason, partly});
  }
}

/// What runs that are not there, or ended early, mean for the measures.
void note_early_ends(Assessment& assessment) {
  const auto early =
      std::count_if(assessment.runs.begin(), assessment.runs.end(), [](const RunAssessment& r) { return !r.complete; });
  if (early == 0) return;
  for (const MeasureKind& kind : measure_kinds()) {
    if (std::count(kind.stages.begin(), kind.stages.end(), AssessmentStage::contact) == 0) continue;
    assessment.missing.push_back({std::string(kind.name), AssessmentStage::contact,
                                  fmt::format("{} of {} runs did not come to their end", early, assessment.runs.size()),
                                  true});
  }
}

/// The largest value of all runs; null where they have none.
const MeasuredValue* largest_of_runs(const Assessment& assessment, std::string_view measure) {
  const MeasuredValue* largest = nullptr;
  for (const MeasuredValue& value : assessment.values) {
    if (value.measure != measure || value.stage != AssessmentStage::contact) continue;
    if (!largest || value.value > largest->value) largest = &value;
  }
  return largest;
}

/// Each chart is of the run that governs its measure.
void add_series(Assessment& assessment) {
  const auto results_of = [&](const MeasuredValue& value) {
    return read_results(std::ranges::find(assessment.runs, value.run, &RunAssessment::name)->results);
  };
  if (const MeasuredValue* worst = largest_of_runs(assessment, "wheel_unloading")) {
    assessment.wheel = assess::wheel_series(results_of(*worst), assessment.window);
    assessment.wheel_run = worst->run;
  }
  for (const char* measure : {"deck_acceleration", "deck_displacement"}) {
    const MeasuredValue* worst = largest_of_runs(assessment, measure);
    if (worst) assessment.deck_series.push_back(assess::deck_series(results_of(*worst), assessment.window, *worst));
  }
}

}  // namespace

ContactPlan contact_plan(const AssessTrain& train, const std::vector<assess::DeckAssessment>& decks,
                         const std::vector<double>& speeds, int seeds) {
  ContactPlan plan{train.name, train.own, *train.scene, {}, {}, {}};
  start_before_bridge(decks, plan);
  follow_free_vibration(decks, plan);
  lengthen_track(train.axles, *std::max_element(speeds.begin(), speeds.end()), plan);
  record_what_is_judged(plan.scene);
  const SceneParameters& made = plan.scene;
  plan.window = judged_window(made);
  for (const assess::DeckAssessment& deck : decks) {
    plan.window.deck_cut_off = std::max(plan.window.deck_cut_off, deck.cut_off);
  }
  plan.notes.push_back(fmt::format(
      "Wheels and car bodies are judged from x = {:g} m {}; percentiles of Q, Y, Y/Q and ΣY of {}, at every "
      "{:g} m.",
      plan.window.begin, made.assessment.end ? fmt::format("to {:g} m", plan.window.end) : "on",
      plan.window.section_length > 0.0 ? fmt::format("sections of {:g} m", plan.window.section_length)
                                       : "that way as one section",
      plan.window.section_step));
  if (!made.contact.friction_file.empty()) {
    plan.notes.push_back(
        fmt::format("The limits of Nadal and Weinstock take the largest coefficient of contact.friction_file, {:g}.",
                    plan.window.friction));
  }
  if (made.train.lateral_acceleration != 0.0 || made.train.cant != 0.0) {
    plan.notes.emplace_back(
        "Lateral accelerations of car bodies are those against the curved and canted track; the acceleration of the "
        "curve itself that cant leaves (train.lateral_acceleration, train.cant) is not in them.");
  }
  follow_deck_of(plan);
  plan.scene.text += "\n# vsi assess:";
  plan.scene.text += fmt::format(
      " train.start = {:.9g}, track.length_before = {:.9g}, track.length_after = {:.9g}, integration.free_vibration = "
      "{:.9g}",
      made.train.start, made.track.length_before, made.track.length_after, made.integration.free_vibration);
  if (made.output.deck_envelope)
    plan.scene.text += fmt::format(", output.deck_cut_off = {:.9g}", made.output.deck_cut_off);
  if (made.spectrum) plan.scene.text += fmt::format(", irregularity.fade_in = {:.9g}", made.spectrum->fade_length());
  plan.runs = sweep_runs(plan.scene, speeds, seeds);
  return plan;
}

void name_runs(std::vector<ContactPlan>& plans) {
  std::set<std::string> taken;
  for (ContactPlan& plan : plans) {
    if (plan.own) continue;
    std::string prefix;
    for (const char letter : plan.train) {
      const bool plain =
          (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') || (letter >= '0' && letter <= '9');
      if (plain || (!prefix.empty() && prefix.back() != '-')) prefix += plain ? letter : '-';
    }
    while (!taken.insert(prefix).second) prefix += "-";
    for (SweepRun& run : plan.runs) run.name = fmt::format("{}-{}", prefix, run.name);
  }
}

ContactRuns::ContactRuns(const std::vector<ContactPlan>& plans, std::filesystem::path scene_file,
                         std::filesystem::path folder, const std::function<void(double)>& progress)
    : plans_(plans), pool_(std::move(scene_file), std::move(folder), {"vsi assess", true, progress}) {}

int ContactRuns::make(const PartOf& shard, int processes) {
  std::vector<PooledRun> runs;
  for (const ContactPlan& plan : plans_) {
    for (const SweepRun& run : plan.runs) runs.push_back(pooled(plan.scene, run));
  }
  return pool_.run(own_part(runs, shard), static_cast<std::size_t>(processes));
}

RunCount ContactRuns::count(const PartOf& shard) const {
  std::vector<RunRow> rows;
  for (const ContactPlan& plan : plans_) {
    for (const SweepRun& run : plan.runs) rows.push_back({run.name, row_begin(run)});
  }
  std::string unused;
  return count_rows(pool_, own_part(rows, shard), summary_columns(), unused);
}

void ContactRuns::measure(Assessment& assessment) const {
  assessment.window = plans_.front().window;
  Gaps gaps;
  for (const ContactPlan& plan : plans_) {
    for (const SweepRun& run : plan.runs) take_up(plan, run, pool_, assessment, gaps);
  }
  note_gaps(gaps, assessment);
  note_early_ends(assessment);
  add_series(assessment);
}

}  // namespace railtab::vsi
