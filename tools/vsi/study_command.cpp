#include <fmt/format.h>

#include <filesystem>
#include <map>

#include "command/command_line.hpp"
#include "command/json_text.hpp"
#include "command/print.hpp"
#include "command/progress_bar.hpp"
#include "commands.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/process_end.hpp"
#include "study_output.hpp"

namespace railtab::vsi {
namespace po = boost::program_options;
namespace {

namespace fs = std::filesystem;
using exit_code::done, exit_code::failed, exit_code::interrupted;

po::options_description study_options() {
  po::options_description own("Options");
  own.add_options()("plan", text_value()->value_name("PLAN.toml"), "what of which scene varies")                  //
      ("output,o", text_value()->value_name("DIR"), "folder of the results, created if absent")                   //
      ("shard", text_value("1/1")->value_name("I/N"), "the I-th of N parts of the runs, without results of all")  //
      ("count", "print how many runs the plan has, without a run");
  return own;
}

int print_count(const StudyPlan& plan, bool json) {
  const bool ends =
      plan.method == StudyMethod::subset || plan.method == StudyMethod::peak || plan.method == StudyMethod::threshold;
  if (json) {
    print_json_line({{"most_runs", greatest_run_count(plan)}, {"variables", plan.variables.size()}});
    return done;
  }
  print_formatted("{}{} runs of {}\n", ends ? "at most " : "", greatest_run_count(plan), plan.scene_file.string());
  for (const StudyVariable& v : plan.variables) {
    print_formatted("  {} [{}]: {}\n", v.name, v.unit,
                    v.random() ? std::string("random") : fmt::format("{} values", v.values.size()));
  }
  return done;
}

std::vector<std::string> print_study_warnings(const StudyRuns& runs, const std::vector<StudyPoint>& points,
                                              const CommandLine& line) {
  std::vector<std::string> warnings = runs.warnings(points);
  if (!line.quiet()) print_warnings("vsi study", warnings);
  return warnings;
}

int run_shard(const StudyPlan& plan, StudyRuns& runs, const PartOf& shard, const CommandLine& line) {
  if (plan.method == StudyMethod::subset || plan.method == StudyMethod::peak || plan.method == StudyMethod::threshold ||
      plan.method == StudyMethod::importance) {
    throw input_error("--shard", "a plan with [peak], [threshold], [importance] or method = \"subset\"",
                      "one process on one machine, whose --threads share the runs");
  }
  const std::vector<StudyPoint> own = own_part(planned_points(plan), shard);
  ProgressBar bar(fmt::format("{} runs", own.size()), !line.quiet() && !line.json());
  const int code = runs.make(own, [&](double share) { bar.show(share); });
  bar.wipe();
  const std::vector<std::string> warnings = print_study_warnings(runs, own, line);
  std::string rows;
  const RunCount count = runs.table(own, rows);
  if (line.json()) {
    print_json_line({{"runs", own.size()},
                     {"finished", count.finished},
                     {"ended_early", count.ended_early},
                     {"warnings", warnings}});
  } else if (!line.quiet()) {
    print_formatted(
        "shard {} of {}: {} of its {} runs finished, {} of them ended early; the same command without --shard writes "
        "the results of all\n",
        shard.index, shard.count, count.finished, own.size(), count.ended_early);
  }
  return code_of_runs(code, count);
}

/// @return exit code of the runs
int make_result(const StudyPlan& plan, StudyRuns& runs, const CommandLine& line, StudyResult& result) {
  ProgressBar bar(fmt::format("{} runs", greatest_run_count(plan)), !line.quiet() && !line.json());
  const auto progress = [&](double share) { bar.show(share); };
  int code = done;
  if (plan.method == StudyMethod::table) {
    result.points = planned_points(plan);
    code = runs.make(result.points, progress);
  } else {
    result = analyse(plan, runs, progress);
  }
  bar.wipe();
  return code;
}

/// @param code of the runs @return that of the command
int report_study(const StudyPlan& plan, const SceneParameters& scene, const StudyRuns& runs, const StudyResult& result,
                 const CommandLine& line, int code) {
  const fs::path folder = line.required("output");
  std::string rows;
  StudyReport report{plan, runs, result, scene.name, scene.text, runs.table(result.points, rows), {}, {}, {}, {}};
  std::map<std::string, std::size_t> places;
  for (const StudyPoint& point : result.points) {
    const std::string name = runs.name_of(point);
    if (const auto known = places.find(name); known != places.end()) {
      report.weights[known->second] += 1.0;
      continue;
    }
    std::optional<StudyRow> row = runs.find_row(point);
    if (!row) continue;
    places.emplace(name, report.rows.size());
    report.rows.push_back(std::move(*row));
    report.names.push_back(name);
    report.points.push_back(point);
    report.weights.push_back(1.0);
  }
  write_study(report, rows, folder);
  const std::vector<std::string> warnings = print_study_warnings(runs, result.points, line);
  if (line.json()) {
    nlohmann::ordered_json json = study_json(report);
    json["table"] = (folder / "runs.csv").string();
    json["warnings"] = warnings;
    print_json_line(json);
  } else if (!line.quiet()) {
    print_formatted("{}{} runs finished, {} of them ended early: {}\n", study_text(report), report.count.finished,
                    report.count.ended_early, (folder / "runs.csv").string());
  }
  return code_of_runs(code, report.count);
}

int run_study(const StudyPlan& plan, const CommandLine& line) {
  const SceneParameters scene = read_scene(plan.scene_file);
  const fs::path folder = line.required("output");
  StudyRuns runs(plan, scene, {folder, static_cast<std::size_t>(line.workers()), true});
  const std::vector<StudyPoint> points = planned_points(plan);
  runs.check(points);
  make_output_folder(folder);
  require_study_places(plan, runs, folder);
  runs.bind_folder();
  runs.tidy(points);
  const PartOf shard = line.part("shard");
  if (shard.count > 1) return run_shard(plan, runs, shard, line);
  StudyResult result;
  const int code = make_result(plan, runs, line, result);
  if (code > failed) return code;
  return report_study(plan, scene, runs, result, line, code);
}

int code_of_study(const StudyPlan& plan, const CommandLine& line) {
  try {
    return run_study(plan, line);
  } catch (const StudyStopped& stopped) {
    return stopped.code;
  }
}

}  // namespace

int study_command(const Arguments& arguments) {
  const CommandLine line("vsi study PLAN.toml [--shard I/N] -o DIR", study_options(), {"plan"}, arguments);
  if (line.help_printed()) return done;
  const StudyPlan plan = read_study_plan(line.required("plan"));
  if (line.given("count")) {
    const SceneParameters scene = read_scene(plan.scene_file);
    StudyRuns(plan, scene, {".", 1, true}).check(planned_points(plan));
    return print_count(plan, line.json());
  }
  const int code = code_of_study(plan, line);
  if (code == interrupted) print_message("vsi study: interrupted; the same command goes on\n");
  return code;
}

}  // namespace railtab::vsi
