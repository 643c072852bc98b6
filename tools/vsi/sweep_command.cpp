#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>

#include "command/command_line.hpp"
#include "command/json_text.hpp"
#include "command/print.hpp"
#include "commands.hpp"
#include "railtab/runtime/base/file_checksum.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/process_end.hpp"
#include "railtab/runtime/base/temporary_file.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/results/result_file.hpp"
#include "railtab/runtime/scene/scene_keys.hpp"
#include "run_pool.hpp"
#include "sweep_plan.hpp"

namespace railtab::vsi {
namespace po = boost::program_options;
namespace {

namespace fs = std::filesystem;
using exit_code::done, exit_code::failed;

std::string whole_text(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

struct SweepCount {
  std::size_t finished = 0, ended_early = 0;
};

/// Row of a finished run, and whether it came to its end. @throws InputError
std::pair<std::string, bool> row_of(const RunPool& sweep, const SweepRun& run) {
  std::string row = whole_text(sweep.file(run, ".row"));
  const std::optional<bool> complete = complete_of_row(run, row);
  if (complete) return {std::move(row), *complete};
  throw input_error(sweep.file(run, ".row").string(), "no row of this run",
                    "the one that vsi sweep wrote; without the file the run is repeated");
}

/// Finished runs; `rows` takes theirs where it is not null. @throws InputError
SweepCount count_runs(const RunPool& sweep, const std::vector<SweepRun>& runs, std::string* rows = nullptr) {
  SweepCount count;
  for (const SweepRun& run : runs) {
    if (!sweep.finished(run)) continue;
    const auto [row, complete] = row_of(sweep, run);
    if (rows) *rows += row;
    ++count.finished;
    count.ended_early += !complete;
  }
  return count;
}

/// All finished runs of the whole sweep, whichever process or shard made them. @throws InputError
SweepCount write_summary(const RunPool& sweep, const std::vector<SweepRun>& runs, const fs::path& file) {
  std::string text = summary_columns();
  const SweepCount count = count_runs(sweep, runs, &text);
  write_text_file(file, text);
  return count;
}

/// A folder holds the runs of one scene and of the same contents of the files that it names.
void check_same_scene(const SceneParameters& scene, const fs::path& folder) {
  const fs::path file = folder / "scene.toml";
  std::string text = scene.text;
  for (const fs::path& input : scene.files) text += fmt::format("\n# {}: {}", input.string(), file_checksum(input));
  text += '\n';
  try {
    if (!fs::exists(file)) write_text_file(file, text);
  } catch (const std::runtime_error&) {
    if (!fs::exists(file)) throw;  // else another shard was first
  }
  if (whole_text(file) != text) {
    throw input_error(file.string(), "another scene, or other contents of the files that it names",
                      "the scene of this sweep, or another folder for -o");
  }
}

std::vector<double> sweep_speeds(const CommandLine& line) {
  const bool si = line.given("speed"), kmh = line.given("speed-kmh");
  if (si && kmh) throw input_error("--speed-kmh", "--speed too", "one of them");
  if (!si && !kmh) throw input_error("--speed", "no speeds", "--speed LO:HI:STEP (m/s) or --speed-kmh LO:HI:STEP");
  const std::string option = si ? "speed" : "speed-kmh";
  std::vector<double> speeds = values_of_range("--" + option, line.text(option));
  if (kmh) std::transform(speeds.begin(), speeds.end(), speeds.begin(), [](double v) { return v / 3.6; });
  return speeds;
}

/// What processes left that were killed while they wrote: of finished runs too, which nothing is written of any more.
void remove_abandoned_of(const std::vector<SweepRun>& runs, const fs::path& folder) {
  std::set<std::string> outputs{"scene.toml", "summary.csv"};
  for (const SweepRun& run : runs) {
    for (const char* suffix : {".h5", ".row"}) outputs.insert(run.name + suffix);
  }
  remove_abandoned_in(folder, [&](const std::string& output) { return outputs.contains(output); });
}

po::options_description sweep_options() {
  po::options_description own("Options");
  own.add_options()("scene", text_value()->value_name("SCENE.toml"), "the scene to run")         //
      ("output,o", text_value()->value_name("DIR"), "folder of the results, created if absent")  //
      ("speed", text_value()->value_name("LO:HI:STEP"), "speeds in m/s")                         //
      ("speed-kmh", text_value()->value_name("LO:HI:STEP"), "speeds in km/h")                    //
      ("seeds", text_value("1")->value_name("N"),
       "random tracks for each speed: irregularity.seed and the N - 1 that follow")  //
      ("shard", text_value("1/1")->value_name("I/N"), "the I-th of N parts of the runs");
  return own;
}

/// What the whole sweep has come to, or one of its shards, which writes no summary.
void print_outcome(const CommandLine& line, const SweepCount& count, std::size_t own, std::size_t all,
                   const std::string& summary) {
  if (line.json()) {
    nlohmann::ordered_json json{{"runs", own}, {"finished", count.finished}, {"ended_early", count.ended_early}};
    if (!summary.empty()) json["summary"] = summary;
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
  const CommandLine line("vsi sweep SCENE.toml --speed LO:HI:STEP [--seeds N] [--shard I/N] -o DIR", sweep_options(),
                         {"scene"}, arguments);
  if (line.help_printed()) return done;
  const std::string scene_file = line.required("scene");
  const fs::path folder = line.required("output");
  const SceneParameters scene = read_scene(scene_file);
  constexpr int most_seeds = 100000;
  const int seeds = static_cast<int>(line.whole_number("seeds", 1, most_seeds));
  const std::vector<SweepRun> all = sweep_runs(scene, sweep_speeds(line), seeds);
  for (const SweepRun& run : all) static_cast<void>(scene_of(scene, run));
  const PartOf shard = line.part("shard");
  std::vector<SweepRun> own;
  for (std::size_t i = static_cast<std::size_t>(shard.index - 1); i < all.size();
       i += static_cast<std::size_t>(shard.count)) {
    own.push_back(all[i]);
  }

  make_output_folder(folder);
  remove_abandoned_of(all, folder);
  check_same_scene(scene, folder);
  const auto processes = static_cast<std::size_t>(line.workers());
  RunPool sweep(scene, scene_file, folder, {"vsi sweep", line.quiet() || line.json()});
  const int code = sweep.run(own, processes);
  const bool whole = shard.count == 1;
  const fs::path summary = folder / "summary.csv";
  const SweepCount count = whole ? write_summary(sweep, all, summary) : count_runs(sweep, own);
  print_outcome(line, count, own.size(), all.size(), whole ? summary.string() : "");
  return code == done && count.ended_early > 0 ? failed : code;
}

}  // namespace railtab::vsi
