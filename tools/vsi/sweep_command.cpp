#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <map>
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
#include "run_command.hpp"
#include "sweep_plan.hpp"

namespace railtab::vsi {
namespace po = boost::program_options;
namespace {

namespace fs = std::filesystem;
constexpr int done = 0, failed = 1, wrong_input = 2, interrupted = 130;
constexpr int kept = 3;  // of a process whose run was finished before

std::string whole_text(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

bool is_readable(const fs::path& results) {
  try {
    static_cast<void>(read_results(results));
    return true;
  } catch (const InputError&) {
    return false;
  }
}

/// The runs of a sweep in processes of their own: one that dies takes no other with it, and every one can be resumed.
class Sweep {
 public:
  Sweep(const SceneParameters& scene, fs::path scene_file, fs::path folder, bool quiet)
      : scene_(scene), scene_file_(std::move(scene_file)), folder_(std::move(folder)), quiet_(quiet) {}

  /// Input that is wrong for the first run that ends is wrong for all: the rest is not begun.
  /// @return exit code: 1 where a run failed or ended early, 2 where the input of all is wrong, 130 after Ctrl-C
  int run(const std::vector<SweepRun>& runs, std::size_t processes) {
    signal(SIGINT, [](int) { asked_ = 1; });
    int code = done;
    std::size_t next = 0;
    while (next < runs.size() || !going_.empty()) {
      while (asked_ == 0 && next < runs.size() && going_.size() < processes) {
        const SweepRun& run = runs[next++];
        going_.emplace(begin(run), &run);
      }
      if (going_.empty()) break;
      code = std::max(code, wait());
      if (code == wrong_input) next = runs.size();
    }
    return asked_ != 0 ? interrupted : code;
  }

  /// A run is finished when its row is there, which is written last, where the train has derailed too, and so are its
  /// results.
  [[nodiscard]] bool finished(const SweepRun& run) const {
    return fs::exists(file(run, ".row")) && fs::exists(file(run, ".h5"));
  }
  [[nodiscard]] fs::path file(const SweepRun& run, const char* suffix) const { return folder_ / (run.name + suffix); }

 private:
  pid_t begin(const SweepRun& run) const {
    std::fflush(nullptr);
    const pid_t process = fork();
    if (process < 0) throw ComputationError("vsi sweep: no more processes can be started");
    if (process == 0) _exit(in_own_process(run));
    return process;
  }

  /// Another name beside the old one, which nothing is lost by.
  void set_aside(const SweepRun& run, const char* suffix, const std::string& why) const {
    const fs::path old = file(run, suffix);
    fs::path aside = old.string() + "." + why;
    constexpr int most = 10000;
    for (int k = 2; fs::exists(aside); ++k) {
      if (k > most) throw input_error(old.string(), fmt::format("{} files set aside", most), "fewer: remove them");
      aside = fmt::format("{}.{}-{}", old.string(), why, k);
    }
    fs::rename(old, aside);
    print_message(fmt::format("vsi sweep: {}: {} is set aside as {}\n", run.name, old.filename().string(),
                              aside.filename().string()));
  }

  /// Whether results there are the run's own, which it can keep or go on from. @throws InputError why they are not
  void check_results(const SweepRun& run, const SceneParameters& scene) const {
    const fs::path results = file(run, ".h5");
    const RunResults before = read_results(results);
    if (!finished(run)) return check_same_run(before, scene, results.string());
    if (before.header.scene_text != scene.text) {
      throw input_error(results.string(), "results of another scene", "those of this run");
    }
  }

  /// Results that cannot be read, cut off by a full disk or a kill, or that are another run's would stand in the way of
  /// their run for good; and a row is only believed beside its results.
  void set_others_aside(const SweepRun& run, const SceneParameters& scene) const {
    std::string why = "alone";
    if (fs::exists(file(run, ".h5"))) {
      try {
        check_results(run, scene);
        return;
      } catch (const InputError& wrong) {
        print_message(fmt::format("vsi sweep: {}: {}; the run is made again\n", run.name, wrong.what()));
      }
      why = is_readable(file(run, ".h5")) ? "other" : "damaged";
      set_aside(run, ".h5", why);
    }
    if (fs::exists(file(run, ".row"))) set_aside(run, ".row", why);
  }

  [[nodiscard]] int in_own_process(const SweepRun& run) const {
    const SceneParameters scene = scene_of(scene_, run);
    try {
      signal(SIGINT, SIG_DFL);
      prctl(PR_SET_PDEATHSIG, SIGKILL);  // a sweep that is killed leaves no run behind that would hold its file
      set_others_aside(run, scene);
      if (finished(run)) return kept;
      std::string row;
      RunOptions options{file(run, ".h5").string(), false, true, true};
      options.ended = [&](const report::Headline& headline, const RunSummary& summary) {
        if (!summary.interrupted) row = summary_row(run, headline, summary);
      };
      const int code = run_to_file(scene, options);
      if (!row.empty()) write_text_file(file(run, ".row"), row);
      return code;
    } catch (const InputError& wrong) {
      print_message(fmt::format("vsi sweep: {}: {}\n", run.name, with_scene_line(wrong, scene, scene_file_).what()));
      return wrong_input;
    } catch (const std::exception& failure) {
      print_message(fmt::format("vsi sweep: {}: {}\n", run.name, failure.what()));
    }
    return failed;
  }

  /// Waits for one of the processes; its exit code, 2 only where no run has ended otherwise.
  int wait() {
    int status = 0;
    const pid_t process = ::wait(&status);
    if (process < 0) return done;  // a signal: those that go on are waited for again
    const auto ended = going_.find(process);
    if (ended == going_.end()) return done;
    const SweepRun& run = *ended->second;
    going_.erase(ended);
    if (WIFEXITED(status) && WEXITSTATUS(status) == wrong_input && !one_ended_) return wrong_input;
    one_ended_ = true;
    if (WIFEXITED(status) && WEXITSTATUS(status) == kept) return done;
    const bool complete = WIFEXITED(status) && WEXITSTATUS(status) == done;
    if (!quiet_)
      print_formatted("{}: {}\n", run.name, complete ? "done" : finished(run) ? "ended early" : "not finished");
    std::fflush(stdout);
    return complete ? done : failed;
  }

  static inline volatile std::sig_atomic_t asked_ = 0;
  const SceneParameters& scene_;
  fs::path scene_file_, folder_;
  bool quiet_;
  bool one_ended_ = false;  ///< with another exit code than that of wrong input
  std::map<pid_t, const SweepRun*> going_;
};

struct SweepCount {
  std::size_t finished = 0, ended_early = 0;
};

/// Row of a finished run, and whether it came to its end. @throws InputError
std::pair<std::string, bool> row_of(const Sweep& sweep, const SweepRun& run) {
  std::string row = whole_text(sweep.file(run, ".row"));
  const std::optional<bool> complete = complete_of_row(run, row);
  if (complete) return {std::move(row), *complete};
  throw input_error(sweep.file(run, ".row").string(), "no row of this run",
                    "the one that vsi sweep wrote; without the file the run is made again");
}

/// Finished runs; `rows` takes theirs where it is not null. @throws InputError
SweepCount count_runs(const Sweep& sweep, const std::vector<SweepRun>& runs, std::string* rows = nullptr) {
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
SweepCount write_summary(const Sweep& sweep, const std::vector<SweepRun>& runs, const fs::path& file) {
  std::string text = summary_columns();
  const SweepCount count = count_runs(sweep, runs, &text);
  write_text_file(file, text);
  return count;
}

/// The folder of the results is made, but none that would hold it: a path with a slip is refused, as for every -o.
void make_folder(const fs::path& folder) {
  if (fs::is_directory(folder)) return;
  if (fs::exists(folder)) throw input_error("-o", folder.string() + ", which is a file", "a folder");
  const fs::path parent = fs::absolute(folder / "").parent_path().parent_path();
  if (!fs::is_directory(parent)) {
    throw input_error("-o", fmt::format("no folder {}", parent.string()), "a new folder in an existing one");
  }
  std::error_code failure;
  fs::create_directory(folder, failure);
  if (failure) throw input_error("-o", folder.string() + ": " + failure.message(), "a folder that can be made");
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

std::vector<double> speeds_of(const CommandLine& line) {
  const bool si = line.given("speed"), kmh = line.given("speed-kmh");
  if (si && kmh) throw input_error("--speed-kmh", "--speed too", "one of them");
  if (!si && !kmh) throw input_error("vsi sweep", "no speeds", "--speed LO:HI:STEP (m/s) or --speed-kmh LO:HI:STEP");
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
  own.add_options()("scene", text_value()->value_name("SCENE.toml"), "what is run")                         //
      ("output,o", text_value()->value_name("DIR"), "folder of the results, made where it does not exist")  //
      ("speed", text_value()->value_name("LO:HI:STEP"), "speeds in m/s")                                    //
      ("speed-kmh", text_value()->value_name("LO:HI:STEP"), "speeds in km/h")                               //
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
  const std::vector<SweepRun> all = sweep_runs(scene, speeds_of(line), seeds);
  for (const SweepRun& run : all) static_cast<void>(scene_of(scene, run));
  const PartOf shard = line.part("shard");
  std::vector<SweepRun> own;
  for (std::size_t i = static_cast<std::size_t>(shard.index - 1); i < all.size();
       i += static_cast<std::size_t>(shard.count)) {
    own.push_back(all[i]);
  }

  make_folder(folder);
  remove_abandoned_of(all, folder);
  check_same_scene(scene, folder);
  const auto processes = static_cast<std::size_t>(line.workers());
  Sweep sweep(scene, scene_file, folder, line.quiet() || line.json());
  const int code = sweep.run(own, processes);
  const bool whole = shard.count == 1;
  const fs::path summary = folder / "summary.csv";
  const SweepCount count = whole ? write_summary(sweep, all, summary) : count_runs(sweep, own);
  print_outcome(line, count, own.size(), all.size(), whole ? summary.string() : "");
  return code == done && count.ended_early > 0 ? failed : code;
}

}  // namespace railtab::vsi
