#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "command/command_line.hpp"
#include "command/json_text.hpp"
#include "command/output_place.hpp"
#include "command/print.hpp"
#include "command/progress_bar.hpp"
#include "commands.hpp"
#include "headline.hpp"
#include "headline_text.hpp"
#include "interrupt.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/process_end.hpp"
#include "railtab/runtime/base/process_memory.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/results/result_file.hpp"
#include "railtab/runtime/scene/recorded_run.hpp"
#include "railtab/runtime/scene/run_plan.hpp"
#include "railtab/runtime/scene/scene_keys.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/scene/scene_run.hpp"
#include "railtab/runtime/vsi/simulation.hpp"
#include "railtab/runtime/vsi/step_record.hpp"
#include "railtab/tables/files/array_file.hpp"
#include "reduction_report.hpp"
#include "run_command.hpp"

namespace railtab::vsi {
namespace po = boost::program_options;
namespace {

using exit_code::done, exit_code::failed, exit_code::interrupted;

ContactMode contact_mode(const std::string& name) {
  if (name == "table") return ContactMode::table;
  if (name == "online") return ContactMode::online;
  if (name == "paper") return ContactMode::paper;
  throw input_error("--contact", name, "table, online or paper");
}

void warn(const RunOptions& options, std::string_view warning) {
  if (!options.quiet) print_message(fmt::format("vsi run: warning: {}\n", warning));
}

/// Adds to a plan's warnings what this machine has too little of.
void warn_of_room(const std::filesystem::path& results, RunPlan& plan) {
  const PlannedMemory& memory = plan.memory;
  if (const double here = installed_memory(); here > 0.0 && memory.most > here) {
    plan.warnings.push_back(fmt::format("the run may need {} of memory, and this machine has {}",
                                        bytes_text(memory.most), bytes_text(here)));
  }
  if (std::string full = room_warning(results, memory.results); !full.empty()) plan.warnings.push_back(std::move(full));
}

int print_plan(const SceneParameters& scene, const RunOptions& options) {
  SetupProgress progress(!options.quiet && !options.json);
  RunPlan plan = plan_run(scene, [&](std::string_view part) { progress.show(part); });
  progress.end();
  warn_of_room(options.output, plan);
  if (options.json) {
    print_json_line({{"scene", scene.name},
                     {"structure_dofs", plan.structure_dofs},
                     {"vehicle_dofs", plan.vehicle_dofs},
                     {"wheels", plan.wheels},
                     {"steps", plan.steps},
                     {"pre_roll_steps", plan.pre_roll_steps},
                     {"time_step", plan.time_step},
                     {"duration", plan.duration},
                     {"memory_bytes", plan.memory.most},
                     {"memory_undivided_bytes", plan.memory.undivided},
                     {"results_bytes", plan.memory.results},
                     {"paraview_bytes", plan.memory.grid},
                     {"step_reads_bytes", plan.memory.step_reads},
                     {"built", plan.built},
                     {"left_out", plan.left_out},
                     {"warnings", plan.warnings}});
    return 0;
  }
  for (const std::string& warning : plan.warnings) warn(options, warning);
  if (options.quiet) return 0;
  const std::string before = plan.pre_roll_steps > 0 ? fmt::format(", after {} of pre-roll", plan.pre_roll_steps) : "";
  print_formatted("{}: {} steps of {} s, {:.4g} s in all{}\n", scene.name, plan.steps, plan.time_step, plan.duration,
                  before);
  print_formatted("  {} degrees of freedom of the structure, {} of the vehicles, {} wheels\n", plan.structure_dofs,
                  plan.vehicle_dofs, plan.wheels);
  print_formatted("  at most {} of memory in all, {} where no step is divided; a step reads {} of it\n",
                  bytes_text(plan.memory.most), bytes_text(plan.memory.undivided), bytes_text(plan.memory.step_reads));
  print_formatted("  {} of results, {} of it for ParaView\n", bytes_text(plan.memory.results),
                  bytes_text(plan.memory.grid));
  for (const std::string& part : plan.built) print_formatted("  built:    {}\n", part);
  for (const std::string& part : plan.left_out) print_formatted("  left out: {}\n", part);
  return 0;
}

/// Wheel forces that the scene's track or contact cannot give, wherever they come from; empty: none.
std::string negative_force(const report::Headline& headline, const SceneParameters& scene) {
  const report::Extreme& least = headline.smallest_Q;
  if (!least.found() || scene.contact.normal != NormalContact::rigid || least.value >= 0.0) return {};
  return fmt::format(
      "negative contact force (smallest Q {:.4g} kN, {}, t = {:.3f} s): the wheel would lift off there, but "
      "contact.normal = \"rigid\" holds it on its rail; contact.normal = \"hertz\" computes lift-off and landing",
      1e-3 * least.value, least.where, least.time);
}

/// What a run says that could not begin, and its exit code. Results of another run that are in its place stay there.
/// @param warnings those that it has given
int conclude_without_results(const RunSummary& summary, const RunOptions& options,
                             const std::vector<std::string>& warnings) {
  if (options.ended) {
    options.ended({}, summary, warnings);
    return failed;
  }
  if (options.json) {
    nlohmann::ordered_json json = report::headline_json({}, summary);
    json["warnings"] = warnings;
    print_json_line(json);
  }
  print_message(
      fmt::format("vsi run: {}; no step was made, and {} stays as it was\n", summary.message, options.output));
  return failed;
}

/// What a run that has ended says, and its exit code.
/// @param warnings those that it has given
int conclude(const SceneParameters& scene, const report::Headline& headline, const RunSummary& summary,
             const RunOptions& options, std::vector<std::string> warnings) {
  std::vector<std::string> last{report::uncovered_queries(summary), negative_force(headline, scene)};
  std::erase(last, "");
  warnings.insert(warnings.end(), last.begin(), last.end());
  if (options.ended) {
    options.ended(headline, summary, warnings);
  } else if (options.json) {
    nlohmann::ordered_json json = report::headline_json(headline, summary);
    json["results"] = options.output;
    json["warnings"] = warnings;
    print_json_line(json);
  } else if (!options.quiet && summary.steps > 0) {
    print_formatted("{}Results: {}\n", report::headline_text(headline, summary), options.output);
  }
  for (const std::string& warning : last) warn(options, warning);
  if (summary.complete) return done;
  if (options.ended) return summary.interrupted ? interrupted : failed;
  if (summary.interrupted) {
    print_message(fmt::format(
        "vsi run: interrupted at t = {:.6g} s; everything up to there is in {}; the same command with --resume "
        "goes on from there\n",
        headline.simulated_time, options.output));
    return interrupted;
  }
  print_message(summary.steps == 0
                    ? fmt::format("vsi run: {}; no step was made, and {} holds no more than this\n", summary.message,
                                  options.output)
                    : fmt::format("vsi run: the run ended at t = {:.6g} s: {}; everything up to there is in {}\n",
                                  headline.simulated_time, summary.message, options.output));
  return failed;
}

/// The results of a run that came to its end are worth a word before they are gone.
void say_what_is_replaced(const RunOptions& options) {
  if (options.quiet || !std::filesystem::exists(options.output)) return;
  try {
    if (!read_run_summary(options.output).complete) return;
    print_message(
        fmt::format("vsi run: note: {} holds the results of a whole run, which this one replaces\n", options.output));
  } catch (const InputError&) {  // nothing that could be read is lost
  }
}

/// Headline and progress of a run.
class RunDisplay {
 public:
  explicit RunDisplay(const RunOptions& options)
      : options_(options), setup_(!options.quiet && !options.json), progress_("run", !options.quiet && !options.json) {}

  /// The run goes on from records that its file holds.
  void take_up(const RunResults& before, std::span<const StepRecord> records) {
    collector_.emplace(before.header);
    warnings_ = before.header.warnings;  // those of the start are not given again
    for (const StepRecord& record : records) collector_->add(record);
  }

  [[nodiscard]] RunObserver observer() {
    const bool resumed = collector_.has_value();
    RunObserver observer;
    observer.setup = [this](std::string_view part) { setup_.show(part); };
    observer.note = [this](std::string_view note) {
      if (!options_.quiet) print_message(fmt::format("vsi run: note: {}\n", note));
    };
    observer.warning = [this](std::string_view warning) {
      if (std::find(warnings_.begin(), warnings_.end(), warning) == warnings_.end()) warnings_.emplace_back(warning);
      warn(options_, warning);
    };
    observer.ready = [this, resumed] {
      if (!resumed) say_what_is_replaced(options_);
      setup_.end();
      Interrupt::listen();
    };
    observer.stop = [this] { return Interrupt::asked() || (options_.stop && options_.stop()); };
    observer.start = [this, resumed](const ResultHeader& header) {
      if (!resumed) collector_.emplace(header);
    };
    observer.record = [this](const StepRecord& step) { collector_->add(step); };
    observer.progress = [this](double fraction) {
      progress_.show(fraction);
      if (options_.progress) options_.progress(fraction);
    };
    return observer;
  }

  /// @return exit code
  [[nodiscard]] int finish(const SceneParameters& scene, const RunSummary& summary, bool has_results) {
    setup_.end();
    progress_.wipe();
    if (!has_results) return conclude_without_results(summary, options_, warnings_);
    return conclude(scene, collector_->result(summary), summary, options_, warnings_);
  }

 private:
  const RunOptions& options_;
  SetupProgress setup_;
  ProgressBar progress_;
  std::optional<report::HeadlineCollector> collector_;
  std::vector<std::string> warnings_;
};

/// Results must not overwrite what the run reads.
void check_output(const SceneParameters& scene, const std::filesystem::path& scene_file, const RunOptions& options) {
  const std::string& output = options.output;
  require_writable_place(output, "-o");
  // says how results that are wanted are damaged, not only that they may not be replaced
  if (options.resume && std::filesystem::is_regular_file(output) && is_array_file(output)) {
    static_cast<void>(array_file_type(output));
  }
  require_results_place(output, scene, scene_file);
  require_fitting_name(output, "-o", "an HDF5 file", {".h5", ".hdf5"});
}

}  // namespace

namespace {

/// What --resume does where it does not go on from a checkpoint.
void say_how_it_resumes(const RecordedRun& run, const RunOptions& options) {
  if (run.is_complete()) {
    print_message(fmt::format("vsi run: note: {} holds the whole run, which is left as it is\n", options.output));
  } else if (run.before() && !run.is_resumed()) {
    print_message(fmt::format(
        "vsi run: note: {} holds {} records and no checkpoint yet (the first is after {} steps): the run begins anew\n",
        options.output, run.before()->steps.size(), IntegrationParameters{}.reinitialise_every));
  }
}

}  // namespace

int run_to_file(const SceneParameters& scene, const RunOptions& options) {
  RecordedRun run(scene, options.output, options.resume);
  if (!options.quiet) say_how_it_resumes(run, options);
  if (run.is_complete()) {
    const RunResults& before = *run.before();
    return conclude(scene, report::headline_of(before), before.summary, options, before.header.warnings);
  }
  RunDisplay display(options);
  if (run.is_resumed()) display.take_up(*run.before(), run.records_before());
  try {
    const RunSummary summary = run.run(display.observer(), options.shared);
    return display.finish(scene, summary, run.has_results());
  } catch (const ComputationError& failure) {
    if (!run.is_resumable()) throw;
    throw ComputationError(fmt::format("{}; the same command{} goes on from the last checkpoint in {}", failure.what(),
                                       options.ended ? "" : " with --resume", options.output));
  }
}

int run_without_results(const SceneParameters& scene, const RunOptions& options) {
  RunDisplay display(options);
  RunObserver observer = display.observer();
  observer.contact_points = false;  // the headline has no use for them
  const RunSummary summary = run_scene(scene, observer, std::nullopt, options.shared);
  return display.finish(scene, summary, summary.steps > 0);
}

namespace {

po::options_description run_options() {
  po::options_description own("Options");
  own.add_options()("scene", text_value()->value_name("SCENE.toml"), "the scene to run")  //
      ("output,o", text_value()->value_name("RESULTS.h5"),
       "results; default: <scene>.results.h5 in the current folder")  //
      ("resume",
       "continue from the last checkpoint in RESULTS.h5; a complete run is left as it is")   //
      ("plan", "print the model, its steps and its memory, without a run")                   //
      ("contact", text_value()->value_name("table|online|paper"), "instead of the scene's")  //
      ("check-reduction", text_value()->value_name("SECONDS"),
       "error of structure.reduction over the first SECONDS, against a run without; no further run");
  return own;
}

/// @throws InputError
void set_contact_mode(const std::string& name, SceneParameters& scene) {
  if (scene.contact.normal == NormalContact::rigid) {
    throw input_error("--contact", "a scene with contact.normal = \"rigid\"", "one whose wheels have contact patches");
  }
  scene.contact.mode = contact_mode(name);
  scene.validate();
}

}  // namespace

int run_command(const Arguments& arguments) {
  const CommandLine line(
      "vsi run SCENE.toml [-o RESULTS.h5] [--resume] [--plan] [--contact table|online|paper]\n"
      "               [--check-reduction SECONDS]",
      run_options(), {"scene"}, arguments);
  if (line.help_printed()) return 0;
  const std::filesystem::path file = line.required("scene");
  SceneParameters scene = read_scene(file);
  if (line.given("contact")) set_contact_mode(line.text("contact"), scene);
  RunOptions options{file.stem().string() + ".results.h5", line.json(), line.quiet(), line.given("resume")};
  if (line.given("output")) options.output = line.text("output");
  for (const char* other : {"plan", "resume", "output"}) {
    if (line.given("check-reduction") && line.given(other)) {
      throw input_error("--check-reduction", fmt::format("--{} too", other), "one of them");
    }
  }
  if (line.given("plan") && line.given("resume")) throw input_error("--plan", "--resume too", "one of them");
  try {
    if (line.given("plan")) {
      if (line.given("output")) check_output(scene, file, options);
      return print_plan(scene, options);
    }
    if (line.given("check-reduction")) {
      const double seconds = line.number("check-reduction");
      if (!(seconds > 0.0)) throw input_error("--check-reduction", fmt::format("{}", seconds), "> 0 s");
      return print_reduction_error(scene, seconds, options.json);
    }
    check_output(scene, file, options);
    return run_to_file(scene, options);
  } catch (const InputError& wrong) {
    throw with_scene_line(wrong, scene, file);
  }
}

}  // namespace railtab::vsi
