#include <fmt/format.h>

#include <filesystem>
#include <set>

#include "command/command_line.hpp"
#include "command/json_text.hpp"
#include "command/print.hpp"
#include "commands.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/process_end.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/scene/scene_keys.hpp"
#include "run_folder.hpp"
#include "run_pool.hpp"
#include "sweep_plan.hpp"

namespace railtab::vsi {
namespace po = boost::program_options;
namespace {

namespace fs = std::filesystem;
using exit_code::done, exit_code::interrupted;

RunRow row_of(const SweepRun& run) { return {run.name, row_begin(run)}; }

std::vector<RunRow> rows_of(const std::vector<SweepRun>& runs) {
  std::vector<RunRow> rows;
  for (const SweepRun& run : runs) rows.push_back(row_of(run));
  return rows;
}

std::vector<double> sweep_speeds(const CommandLine& line, const SceneParameters& scene) {
  std::vector<double> speeds = speeds_of_options(line);
  if (speeds.empty()) throw input_error("--speed", "no speeds", "--speed LO:HI:STEP (m/s) or --speed-kmh LO:HI:STEP");
  if (!scene.train.speed_file.empty()) {
    throw input_error(line.given("speed") ? "--speed" : "--speed-kmh", "a scene with train.speed_file",
                      "a scene without it, whose speed is constant");
  }
  return speeds;
}

po::options_description sweep_options() {
  po::options_description own("Options");
  own.add_options()("scene", text_value()->value_name("SCENE.toml"), "the scene to run")         //
      ("output,o", text_value()->value_name("DIR"), "folder of the results, created if absent")  //
      ("speed", text_value()->value_name("LO:HI:STEP"), "speeds in m/s")                         //
      ("speed-kmh", text_value()->value_name("LO:HI:STEP"), "speeds in km/h")                    //
      ("seeds", text_value("1")->value_name("N"),
       "random tracks for each speed: irregularity.seed and the N - 1 that follow")       //
      ("shard", text_value("1/1")->value_name("I/N"), "the I-th of N parts of the runs")  //
      ("summary-only", "only the rows of summary.csv, no files of results");
  return own;
}

/// Finished runs of earlier sweeps into the folder.
std::size_t count_other_runs(const std::vector<SweepRun>& all, const fs::path& folder) {
  std::set<std::string> names;
  for (const SweepRun& run : all) names.insert(run.name);
  std::size_t others = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    others += entry.path().extension() == ".row" && !names.contains(entry.path().stem().string());
  }
  return others;
}

/// What the whole sweep has come to, or one of its shards, which writes no summary.
void print_outcome(const CommandLine& line, const RunCount& count, std::size_t own, std::size_t all,
                   const std::vector<std::string>& warnings, const std::string& summary) {
  if (line.json()) {
    nlohmann::ordered_json json{{"runs", own}, {"finished", count.finished}, {"ended_early", count.ended_early}};
    if (!summary.empty()) json["summary"] = summary;
    json["warnings"] = warnings;
    print_json_line(json);
  } else if (!line.quiet() && !summary.empty()) {
    print_formatted("{} of {} runs finished, {} of them ended early: {}\n", count.finished, all, count.ended_early,
                    summary);
  } else if (!line.quiet()) {
    const PartOf shard = line.part("shard");
    print_formatted(
        "shard {} of {}: {} of its {} runs finished, {} of them ended early; the sweep has {} runs, and the same "
        "command without --shard writes the summary of all\n",
        shard.index, shard.count, count.finished, own, count.ended_early, all);
  }
}

}  // namespace

int sweep_command(const Arguments& arguments) {
  const CommandLine line(
      "vsi sweep SCENE.toml --speed LO:HI:STEP [--seeds N] [--shard I/N] [--summary-only]\n"
      "               -o DIR",
      sweep_options(), {"scene"}, arguments);
  if (line.help_printed()) return done;
  const std::string scene_file = line.required("scene");
  const fs::path folder = line.required("output");
  const SceneParameters scene = read_scene(scene_file);
  constexpr int most_seeds = 100000;
  const int seeds = static_cast<int>(line.whole_number("seeds", 1, most_seeds));
  const std::vector<SweepRun> all = sweep_runs(scene, sweep_speeds(line, scene), seeds);
  for (const SweepRun& run : all) static_cast<void>(scene_of(scene, run));
  const PartOf shard = line.part("shard");
  const std::vector<SweepRun> own = own_part(all, shard);

  make_output_folder(folder);
  remove_abandoned_runs(rows_of(all), {"scene.toml", "summary.csv"}, folder);
  check_same_scene(scene_file, scene.text, scene.files, folder);
  const auto processes = static_cast<std::size_t>(line.workers());
  RunPool sweep(scene_file, folder,
                {"vsi sweep",
                 line.quiet() || line.json(),
                 {},
                 line.given("summary-only") ? PooledResults::unwritten : PooledResults::kept});
  std::vector<PooledRun> runs;
  for (const SweepRun& run : own) runs.push_back(pooled(scene, run));
  const int code = sweep.run(runs, processes);
  const bool whole = shard.count == 1;
  const fs::path summary = folder / "summary.csv";
  std::string text = summary_columns();
  const RunCount count = count_rows(sweep, rows_of(whole ? all : own), summary_columns(), text);
  if (whole) write_text_file(summary, text);
  const std::vector<std::string> warnings = warnings_of_runs(sweep, rows_of(whole ? all : own));
  if (!line.quiet()) print_warnings("vsi sweep", warnings);
  print_outcome(line, count, own.size(), all.size(), warnings, whole ? summary.string() : "");
  const std::size_t others = whole ? count_other_runs(all, folder) : 0;
  if (others > 0 && !line.quiet()) {
    print_message(fmt::format(
        "vsi sweep: note: {} finished run{} of other speeds or seeds in this folder {} not in summary.csv\n", others,
        others == 1 ? "" : "s", others == 1 ? "is" : "are"));
  }
  if (code == interrupted) print_message("vsi sweep: interrupted; the same command goes on\n");
  return code_of_runs(code, count);
}

}  // namespace railtab::vsi
