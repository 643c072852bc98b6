#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "assess_contact.hpp"
#include "assess_stages.hpp"
#include "assessment_csv.hpp"
#include "assessment_json.hpp"
#include "assessment_page.hpp"
#include "assessment_text.hpp"
#include "command/command_line.hpp"
#include "command/json_text.hpp"
#include "command/print.hpp"
#include "command/progress_bar.hpp"
#include "commands.hpp"
#include "moving_load_output.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/process_end.hpp"
#include "railtab/runtime/base/stopwatch.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/base/version.hpp"
#include "railtab/runtime/report/html_page.hpp"
#include "railtab/runtime/scene/scene_keys.hpp"
#include "run_pool.hpp"

namespace railtab::vsi {
namespace po = boost::program_options;
namespace fs = std::filesystem;
namespace {

using assess::Assessment;
using assess::StageReport;

using exit_code::done, exit_code::failed, exit_code::wrong_input, exit_code::clause_fails, exit_code::interrupted;
constexpr const char* assess_usage =
    "vsi assess SCENE.toml [--stage check|moving-load|contact] [--speed-kmh V|LO:HI:STEP] [--seeds N]\n"
    "           [--train NAME] [--clauses FILE.toml] [--fail-on any|verified] [--shard I/N] [-o DIR]";

po::options_description assess_options() {
  po::options_description own("Options");
  own.add_options()("scene", text_value()->value_name("SCENE.toml"), "a scene with a bridge")  //
      ("stage", po::value<std::vector<std::string>>()->composing()->value_name("check|moving-load|contact"),
       "this stage alone; may be given twice; default all")  //
      ("speed", text_value()->value_name("LO:HI:STEP"),
       "speeds of the runs with contact in m/s; default: the line's, and the critical one of the scene's train")  //
      ("speed-kmh", text_value()->value_name("LO:HI:STEP"), "the same in km/h")                                   //
      ("seeds", text_value()->value_name("N"), "random tracks for each speed, in place of assessment.seeds")      //
      ("train", po::value<std::vector<std::string>>()->composing()->value_name("NAME"),
       "a train besides the scene's, in place of assessment.trains, may be given many times: NAME, NAME*N wagons or "
       "AXLES.csv as moving forces; vehicles as VEHICLE*N+VEHICLE also in runs; default hslm-a")  //
      ("clauses", po::value<std::vector<std::string>>()->composing()->value_name("FILE.toml"),
       "further clauses, or others of the same id; may be given many times")  //
      ("fail-on", text_value()->value_name("any|verified"),
       "exit code 3 where a limit fails: any, or one whose number was read in the standard")                       //
      ("shard", text_value("1/1")->value_name("I/N"), "the I-th of N parts of the runs with contact, no verdict")  //
      ("output,o", text_value()->value_name("DIR"),
       "folder of assessment.html, assessment.json and runs; default: <scene>.assessment");
  return own;
}

struct Request {
  fs::path scene_file, folder;
  std::vector<AssessmentStage> stages;
  std::vector<double> speeds;  ///< [m/s]; none: chosen
  std::optional<int> seeds;
  std::vector<std::string> trains;  ///< none: those of the scene
  std::string fail_on;
  PartOf shard;
  int threads = 1;
  bool progress = false, json = false, quiet = false;
  [[nodiscard]] bool asks(AssessmentStage stage) const {
    return std::find(stages.begin(), stages.end(), stage) != stages.end();
  }
};

std::vector<AssessmentStage> stages_of(const CommandLine& line) {
  using enum AssessmentStage;
  if (!line.given("stage")) return {check, moving_load, contact};
  std::vector<AssessmentStage> stages;
  for (const std::string& name : line.required_many("stage")) {
    const auto all = {check, moving_load, contact};
    const auto* found = std::find_if(all.begin(), all.end(), [&](AssessmentStage s) { return stage_name(s) == name; });
    if (found == all.end()) throw input_error("--stage", name, "check, moving-load or contact");
    stages.push_back(*found);
  }
  return stages;
}

/// @throws InputError where an option is for stages that are not asked for
void require_stages_of(const CommandLine& line, const Request& request) {
  using enum AssessmentStage;
  for (const char* option : {"speed", "speed-kmh", "seeds", "shard"}) {
    if (line.chosen(option) && !request.asks(contact)) {
      throw input_error(fmt::format("--{}", option), "stages without runs", "stage contact");
    }
  }
  if (line.chosen("train") && !request.asks(moving_load) && !request.asks(contact)) {
    throw input_error("--train", "stage check, which takes no trains", "stage moving-load or contact");
  }
}

Request request_of(const CommandLine& line) {
  Request request;
  request.scene_file = line.required("scene");
  request.folder = line.given("output") ? fs::path(line.text("output"))
                                        : fs::path(request.scene_file.stem().string() + ".assessment");
  request.stages = stages_of(line);
  request.speeds = speeds_of_options(line);
  constexpr int most_seeds = 1000;
  if (line.given("seeds")) request.seeds = static_cast<int>(line.whole_number("seeds", 1, most_seeds));
  if (line.given("fail-on")) {
    request.fail_on = line.text("fail-on");
    if (request.fail_on != "any" && request.fail_on != "verified") {
      throw input_error("--fail-on", request.fail_on, "any or verified");
    }
  }
  if (line.given("train")) request.trains = line.required_many("train");
  request.shard = line.part("shard");
  require_stages_of(line, request);
  request.threads = line.workers();
  request.progress = !line.quiet() && !line.json();
  request.json = line.json();
  request.quiet = line.quiet();
  return request;
}

/// @throws InputError where no clause has rules of that name: nothing would be judged by them
void require_known_rules(const std::vector<std::string>& rules, const std::vector<Clause>& clauses) {
  std::vector<std::string> known;
  for (const Clause& clause : clauses) {
    if (!clause.rules.empty() && std::find(known.begin(), known.end(), clause.rules) == known.end()) {
      known.push_back(clause.rules);
    }
  }
  std::sort(known.begin(), known.end());
  for (const std::string& name : rules) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    throw input_error("scene: assessment.rules", fmt::format("\"{}\"", name),
                      fmt::format("names of {}, or of a file of --clauses", fmt::join(known, ", ")));
  }
}

Assessment begin(const SceneParameters& scene, const Request& request, const CommandLine& line) {
  Assessment assessment;
  assessment.scene_name = scene.name;
  assessment.scene_file = request.scene_file.string();
  assessment.scene_text = scene.text;
  assessment.version = version();
  const double line_speed = scene.assessment.line_speed_kmh / 3.6;
  assessment.facts.line_speed = line_speed > 0.0 ? line_speed : scene.train.speed;
  assessment.facts.track = scene.assessment.track == DeckTrack::ballasted ? "ballasted" : "direct";
  assessment.facts.rules = scene.assessment.rules;
  std::vector<fs::path> files;
  if (line.given("clauses")) {
    for (const std::string& file : line.required_many("clauses")) files.emplace_back(file);
  }
  assessment.clauses = clauses_with(files);
  require_known_rules(scene.assessment.rules, assessment.clauses);
  return assessment;
}

/// A stage in the list, with the time of `work` where it is asked for.
template <class Work>
void stage(AssessmentStage which, const Request& request, Assessment& assessment, const Work& work) {
  StageReport report;
  report.stage = which;
  if (!request.asks(which)) {
    report.skipped = "not asked for (--stage)";
  } else {
    const Stopwatch watch(report.seconds);
    report.done = true;
    work(report);
  }
  assessment.stages.push_back(std::move(report));
}

/// "hslm-a, traxx-locomotive+ordinary-coach*8 and the scene's train (manchester-coach*8)"
std::string names_of(const std::vector<std::string>& names, const AssessTrain& own) {
  return fmt::format("{} and {}", fmt::join(names, ", "), own.name);
}

/// Trains besides the scene's.
std::vector<std::string> train_names_of(const SceneParameters& scene, const Request& request) {
  return request.trains.empty() ? scene.assessment.trains : request.trains;
}

std::vector<AssessTrain> trains_of(const SceneParameters& scene, const Request& request) {
  const fs::path folder = request.trains.empty() ? request.scene_file.parent_path() : fs::path();
  return assess_trains(scene, train_names_of(scene, request), folder);
}

/// HSLM-A is not the load model of short simply supported spans [EN1991-2, 6.4.6.1.1]: with it alone they do not pass.
void note_short_spans(StageReport& report, Assessment& assessment) {
  constexpr double shortest = 7.0;  // [m]
  for (const assess::DeckAssessment& deck : assessment.decks) {
    const bool by_hslm_a =
        std::ranges::any_of(deck.trains, [](const AxleTrain& train) { return train.name.starts_with("hslm-a"); });
    if (!by_hslm_a || !(deck.span > 0.0 && deck.span < shortest)) continue;
    const std::string instead = fmt::format(
        "EN 1991-2, 6.4.6.1.1 requires HSLM-B in place of HSLM-A for simply supported spans below {:g} m, as {} of "
        "{:g} m; railtab has HSLM-A only",
        shortest, deck.deck.name, deck.span);
    report.notes.push_back(instead +
                           "; name the trains of HSLM-B as files of axle loads (assessment.trains, --train).");
    assessment.missing.push_back({"deck_acceleration", AssessmentStage::moving_load, instead, true});
  }
}

void moving_loads(const std::vector<AssessTrain>& trains, const std::vector<std::string>& names, const Request& request,
                  StageReport& report, Assessment& assessment) {
  std::vector<AxleTrain> axles;
  for (const AssessTrain& train : trains) axles.push_back(train.axles);
  ProgressBar bar("moving loads", request.progress);
  run_moving_loads(
      axles, request.threads, [&](double share) { bar.show(share); }, assessment);
  bar.wipe();
  report.notes.push_back(
      fmt::format("Trains: {}, at {:.1f} to {:.1f} km/h, every 2 km/h or nearer, and at the critical "
                  "speeds.",
                  names_of(names, trains.back()), 3.6 * assessment.low_speed, 3.6 * assessment.high_speed));
  report.notes.emplace_back(
      "Axle loads act at points of the deck, without spreading by sleepers and without vehicle-bridge interaction: "
      "accelerations by the modes up to the cut-off frequency of each deck.");
  for (const assess::DeckAssessment& deck : assessment.decks) {
    if (const std::string doubt = doubtful_cut_off(deck.deck); !doubt.empty()) report.notes.push_back(doubt + ".");
    if (!has_free_end(deck.deck)) continue;
    report.notes.push_back(fmt::format(
        "An end of deck {} is free to move: an axle load that comes on accelerates it at once, while rails, "
        "sleepers and ballast would spread the load. A largest acceleration counts as overestimated, and "
        "fails no limit, where one such load gives more than a tenth of it at its place. Resonance that many such "
        "loads excite is not recognised and can fail a limit; runs with contact have the track.",
        deck.deck.name));
  }
  note_short_spans(report, assessment);
}

/// The speed up to `highest` [m/s] at which a train as moving loads gives the largest acceleration of a deck.
double governing_speed(const GoverningTrain& governing, const Assessment& assessment, double highest) {
  LargestResponse worst;
  worst.speed = highest;
  const std::vector<LargestResponse> responses =
      governing.responses.empty() ? largest_responses(governing.train->axles, assessment.decks, highest)
                                  : governing.responses;
  for (const LargestResponse& here : responses) {
    if (here.acceleration > worst.acceleration) worst = here;
  }
  return worst.speed;
}

/// Speeds of a train's runs: those asked for, or the line's and the critical one below it.
std::vector<double> contact_speeds(const GoverningTrain& governing, const Request& request,
                                   const Assessment& assessment, StageReport& report) {
  const double line = assessment.facts.line_speed;
  constexpr double same = 1e-6;
  if (!request.speeds.empty()) {
    const bool of_line = std::any_of(request.speeds.begin(), request.speeds.end(),
                                     [&](double speed) { return std::abs(speed - line) <= same * line; });
    std::string note = "Runs at the speeds of the command";
    if (!of_line) note += fmt::format(", none at the line speed, {:.1f} km/h, which no run judges", 3.6 * line);
    report.notes.push_back(note + ".");
    return request.speeds;
  }
  const double critical = std::round(1e3 * governing_speed(governing, assessment, line)) / 1e3;
  constexpr double alike = 0.01;
  const std::string of = governing.train->own ? "the train" : governing.train->name;
  const std::string fastest = fmt::format("at the line speed, {:.1f} km/h", 3.6 * line);
  if (critical > (1.0 - alike) * line) {
    report.notes.push_back(fmt::format("Runs {}, at which {} as moving loads accelerates the deck most.", fastest, of));
    return {line};
  }
  report.notes.push_back(
      fmt::format("Runs at {:.1f} km/h, at which {} as moving loads accelerates the deck most, and {}.", 3.6 * critical,
                  of, fastest));
  return {critical, line};
}

/// Which trains run, and which do not and why.
std::vector<GoverningTrain> running_trains(const std::vector<AssessTrain>& trains, const Assessment& assessment,
                                           StageReport& report) {
  std::vector<GoverningTrain> running = governing_trains(trains, assessment.decks, assessment.facts.line_speed);
  std::string others;
  for (const AssessTrain& train : trains) {
    const bool runs = std::ranges::find(running, &train, &GoverningTrain::train) != running.end();
    if (train.scene && !runs) others += fmt::format("{}{}", others.empty() ? "" : ", ", train.name);
  }
  if (!others.empty()) {
    report.notes.push_back(
        fmt::format("No runs of {}: as moving loads up to the line speed they give the largest acceleration, "
                    "displacement or end rotation of no deck.",
                    others));
  }
  return running;
}

/// Runs of all trains; none where the stage is skipped.
std::vector<ContactPlan> contact_plans(const std::vector<AssessTrain>& trains, const SceneParameters& scene,
                                       const Request& request, StageReport& report, const Assessment& assessment) {
  if (!scene.train.speed_file.empty()) {
    report.done = false;
    report.skipped = "the scene's speed varies (train.speed_file); limits are judged at constant speeds";
    return {};
  }
  const int seeds = scene.spectrum ? request.seeds.value_or(scene.assessment.seeds) : request.seeds.value_or(1);
  std::vector<ContactPlan> plans;
  for (const GoverningTrain& governing : running_trains(trains, assessment, report)) {
    const std::vector<double> speeds = contact_speeds(governing, request, assessment, report);
    plans.push_back(contact_plan(*governing.train, assessment.decks, speeds, seeds));
    for (const std::string& note : plans.back().notes) {
      const bool there = std::find(report.notes.begin(), report.notes.end(), note) != report.notes.end();
      if (!there) report.notes.push_back(note);
    }
  }
  name_runs(plans);
  if (!scene.spectrum) {
    report.notes.emplace_back(scene.irregularity
                                  ? "One run for each speed: the irregularity is that of a file."
                                  : "One run for each speed: the track is perfect (irregularity.spectrum adds random "
                                    "tracks). Unloading and comfort are those of the bridge alone.");
  }
  return plans;
}

std::vector<std::string> warnings_of(const std::vector<ContactPlan>& plans, const Request& request) {
  std::vector<RunRow> rows;
  for (const ContactPlan& plan : plans) {
    for (const SweepRun& run : plan.runs) rows.push_back({run.name, row_begin(run)});
  }
  return warnings_of_runs(RunPool(request.scene_file, request.folder / "runs", {"vsi assess"}), rows);
}

int contact_runs(const std::vector<AssessTrain>& trains, const SceneParameters& scene, const Request& request,
                 StageReport& report, Assessment& assessment) {
  const std::vector<ContactPlan> plans = contact_plans(trains, scene, request, report, assessment);
  if (plans.empty()) return done;
  make_output_folder(request.folder / "runs");
  ProgressBar bar("runs", request.progress);
  ContactRuns runs(plans, request.scene_file, request.folder / "runs", [&](double share) { bar.show(share); });
  const int code = runs.make(request.shard, request.threads);
  bar.wipe();
  assessment.warnings = warnings_of(plans, request);
  if (!request.quiet) print_warnings("vsi assess", assessment.warnings);
  if (code == wrong_input || code == interrupted) return code;
  if (request.shard.count == 1) {
    runs.measure(assessment);
    return code;
  }
  const RunCount count = runs.count(request.shard);
  if (request.json) {
    print_json_line({{"finished", count.finished}, {"ended_early", count.ended_early}});
  } else if (request.progress) {
    print_formatted(
        "shard {} of {}: {} of its runs finished, {} of them ended early; the same command without --shard writes the "
        "verdict of all\n",
        request.shard.index, request.shard.count, count.finished, count.ended_early);
  }
  return code;
}

/// What stages have computed, as tables for other programs.
void write_tables(const Request& request, const Assessment& assessment) {
  std::vector<DeckResponse> responses;
  for (const assess::DeckAssessment& deck : assessment.decks) {
    if (!deck.responses.empty()) responses.push_back({deck.deck, deck.trains, deck.responses});
  }
  if (!responses.empty()) {
    write_text_file(request.folder / "moving_load.csv", response_rows(responses), response_columns());
  }
  if (!assessment.runs.empty()) {
    write_text_file(request.folder / "runs.csv", assess::run_rows(assessment), assess::run_columns());
  }
}

int write_outputs(const Request& request, const Assessment& assessment, bool json, bool quiet) {
  const auto object = assess::assessment_json(assessment);
  const fs::path page = request.folder / "assessment.html", data = request.folder / "assessment.json";
  write_tables(request, assessment);
  write_text_file(data, object.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n", "{\n \"railtab\"");
  write_text_file(page, assess::assessment_page(assessment), report::html_first_line(assess::assessment_page_kind));
  if (json) {
    print_json_line(object);
  } else if (!quiet) {
    print_formatted("{}\n{}\n{}\n", assess::assessment_text(assessment), page.string(), data.string());
  }
  const bool fails = (request.fail_on == "any" && assessment.failures(false) > 0) ||
                     (request.fail_on == "verified" && assessment.failures(true) > 0);
  return fails ? clause_fails : done;
}

void print_interrupted() { print_message("vsi assess: interrupted; the same command goes on\n"); }

/// Part of the runs, without a verdict.
int assess_shard(const std::vector<AssessTrain>& trains, const SceneParameters& scene, const Request& request,
                 Assessment& assessment) {
  StageReport report;
  report.done = true;
  const int code = contact_runs(trains, scene, request, report, assessment);
  if (!report.skipped.empty()) throw input_error("--shard", report.skipped, "a scene with runs to share");
  if (code == interrupted) print_interrupted();
  return code;
}

int assess_scene(const SceneParameters& scene, const Request& request, const CommandLine& line) {
  Assessment assessment = begin(scene, request, line);
  // The decks are those of every stage.
  Assessment decks = assessment;
  check_decks(scene, decks);
  const std::vector<AssessTrain> trains = trains_of(scene, request);
  make_output_folder(request.folder);
  assessment.decks = decks.decks;
  if (request.shard.count > 1) return assess_shard(trains, scene, request, assessment);
  stage(AssessmentStage::check, request, assessment, [&](StageReport&) {
    assessment.values = decks.values;
    assessment.missing = decks.missing;
  });
  stage(AssessmentStage::moving_load, request, assessment, [&](StageReport& report) {
    moving_loads(trains, train_names_of(scene, request), request, report, assessment);
  });
  int code = done;
  stage(AssessmentStage::contact, request, assessment,
        [&](StageReport& report) { code = contact_runs(trains, scene, request, report, assessment); });
  if (code > failed) {
    if (code == interrupted) print_interrupted();
    return code;
  }
  assessment.verdicts = judge(assessment.clauses, assessment.facts, assessment.values, assessment.missing);
  const int verdict = write_outputs(request, assessment, line.json(), line.quiet());
  const bool run_missing =
      std::any_of(assessment.runs.begin(), assessment.runs.end(), [](const auto& run) { return !run.there; });
  return verdict != done ? verdict : run_missing ? failed : done;
}

}  // namespace

int assess_command(const Arguments& arguments) {
  const CommandLine line(assess_usage, assess_options(), {"scene"}, arguments);
  if (line.help_printed()) return done;
  const Request request = request_of(line);
  const SceneParameters scene = read_scene(request.scene_file);
  try {
    return assess_scene(scene, request, line);
  } catch (const InputError& wrong) {
    throw with_scene_line(wrong, scene, request.scene_file);
  }
}

}  // namespace railtab::vsi
