#include "run_pool.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "command/print.hpp"
#include "railtab/runtime/base/file_checksum.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/process_end.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/results/result_file.hpp"
#include "railtab/runtime/scene/recorded_run.hpp"
#include "railtab/runtime/scene/scene_keys.hpp"
#include "run_command.hpp"

namespace railtab::vsi {
namespace fs = std::filesystem;
namespace {

using exit_code::done, exit_code::failed, exit_code::wrong_input, exit_code::interrupted;
constexpr int kept = 3;  // of a process whose run was finished before
volatile std::sig_atomic_t asked = 0;

bool is_readable(const fs::path& results) {
  try {
    static_cast<void>(read_results(results));
    return true;
  } catch (const InputError&) {
    return false;
  }
}

/// How far each run is, in memory that all processes share.
class SharedShares {
 public:
  explicit SharedShares(std::size_t count) : count_(count) {
    void* memory = mmap(nullptr, count * sizeof(double), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory != MAP_FAILED) shares_ = static_cast<double*>(memory);
  }
  ~SharedShares() {
    if (shares_) munmap(shares_, count_ * sizeof(double));
  }
  SharedShares(const SharedShares&) = delete;
  SharedShares& operator=(const SharedShares&) = delete;
  [[nodiscard]] double* of(std::size_t run) const { return shares_ ? shares_ + run : nullptr; }
  [[nodiscard]] double mean() const {
    const std::span<const double> all(shares_, shares_ ? count_ : 0);
    return std::accumulate(all.begin(), all.end(), 0.0) / static_cast<double>(count_);
  }

 private:
  std::size_t count_;
  double* shares_ = nullptr;
};

}  // namespace

RunPool::RunPool(fs::path scene_file, fs::path folder, RunPoolOptions options)
    : scene_file_(std::move(scene_file)), folder_(std::move(folder)), options_(std::move(options)) {}

int RunPool::run(const std::vector<PooledRun>& runs, std::size_t processes) {
  if (runs.empty()) return done;
  signal(SIGINT, [](int) { asked = 1; });
  const SharedShares shares(runs.size());
  int code = done;
  std::size_t next = 0;
  while (next < runs.size() || !going_.empty()) {
    while (asked == 0 && next < runs.size() && going_.size() < processes) {
      const PooledRun& run = runs[next];
      going_.emplace(begin(run, shares.of(next)), &run);
      ++next;
    }
    if (going_.empty()) break;
    code = std::max(code, wait());
    if (code == wrong_input) next = runs.size();
    if (options_.progress) options_.progress(shares.mean());
  }
  return asked != 0 ? interrupted : code;
}

bool RunPool::finished(const std::string& name) const {
  return fs::exists(file(name, ".row")) && (!options_.keep_results || fs::exists(file(name, ".h5")));
}

fs::path RunPool::file(const std::string& name, const char* suffix) const { return folder_ / (name + suffix); }

int RunPool::begin(const PooledRun& run, double* share) {
  std::fflush(nullptr);
  const pid_t process = fork();
  if (process < 0) throw ComputationError(options_.command + ": no more processes can be started");
  if (process == 0) _exit(in_own_process(run, share));
  return process;
}

/// Another name beside the old one, which nothing is lost by.
void RunPool::set_aside(const std::string& name, const char* suffix, const std::string& why) const {
  const fs::path old = file(name, suffix);
  fs::path aside = old.string() + "." + why;
  constexpr int most = 10000;
  for (int k = 2; fs::exists(aside); ++k) {
    if (k > most) throw input_error(old.string(), fmt::format("{} files set aside", most), "fewer: remove them");
    aside = fmt::format("{}.{}-{}", old.string(), why, k);
  }
  fs::rename(old, aside);
  print_message(fmt::format("{}: {}: {} is set aside as {}\n", options_.command, name, old.filename().string(),
                            aside.filename().string()));
}

/// Whether results there are the run's own, which it can keep or go on from. @throws InputError why they are not
void RunPool::check_results(const std::string& name, const SceneParameters& scene) const {
  const fs::path results = file(name, ".h5");
  const RunResults before = read_results(results);
  if (!finished(name)) return check_same_run(before, scene, results);
  if (before.header.scene_text != scene.text) {
    throw input_error(results.string(), "results of another scene", "those of this run");
  }
  const std::vector<std::string>& sums = before.header.input_checksums;
  for (std::size_t i = 0; i < std::min(sums.size(), scene.files.size()); ++i) {
    if (file_checksum(scene.files[i]) == sums[i]) continue;
    throw input_error(results.string(), fmt::format("results made with other contents of {}", scene.files[i].string()),
                      "those of this run");
  }
}

/// Results that cannot be read, cut off by a full disk or a kill, or that are another run's would stand in the way of
/// their run for good; and a row is only believed beside its results.
void RunPool::set_others_aside(const std::string& name, const SceneParameters& scene) const {
  std::string why = "alone";
  if (fs::exists(file(name, ".h5"))) {
    try {
      check_results(name, scene);
      return;
    } catch (const InputError& wrong) {
      print_message(fmt::format("{}: {}: {}; the run is repeated\n", options_.command, name, wrong.what()));
    }
    why = is_readable(file(name, ".h5")) ? "other" : "damaged";
    set_aside(name, ".h5", why);
  }
  if (fs::exists(file(name, ".row"))) set_aside(name, ".row", why);
}

int RunPool::in_own_process(const PooledRun& run, double* share) const {
  std::optional<SceneParameters> scene;
  try {
    signal(SIGINT, SIG_DFL);
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // a parent that is killed leaves no run behind that would hold its file
    scene = run.scene();
    return make_row(run, *scene, share);
  } catch (const InputError& wrong) {
    const InputError placed = scene ? with_scene_line(wrong, *scene, scene_file_) : wrong;
    print_message(fmt::format("{}: {}: {}\n", options_.command, run.name, placed.what()));
    return wrong_input;
  } catch (const std::exception& failure) {
    print_message(fmt::format("{}: {}: {}\n", options_.command, run.name, failure.what()));
  }
  return failed;
}

/// The run, where it is not finished, and its row.
int RunPool::make_row(const PooledRun& run, const SceneParameters& scene, double* share) const {
  const fs::path results = file(run.name, ".h5");
  const auto tidy = [&] {
    if (share) *share = 1.0;
    if (!options_.keep_results && finished(run.name)) fs::remove(results);
  };
  if (options_.keep_results || !finished(run.name)) set_others_aside(run.name, scene);
  if (finished(run.name)) {
    tidy();
    return kept;
  }
  std::optional<std::pair<report::Headline, RunSummary>> end;
  RunOptions options{results.string(), false, true, true};
  options.progress = [share](double done_so_far) {
    if (share) *share = done_so_far;
  };
  options.ended = [&](const report::Headline& headline, const RunSummary& summary) {
    if (!summary.interrupted) end.emplace(headline, summary);
  };
  const int code = run_to_file(scene, options);
  if (end && fs::exists(results)) write_text_file(file(run.name, ".row"), run.row(end->first, end->second, results));
  tidy();
  return code;
}

/// Waits for one of the processes, or a moment where progress is shown; the exit code of what has ended.
int RunPool::wait() {
  constexpr useconds_t moment = 100000;  // [µs]
  int status = 0;
  const pid_t process = ::waitpid(-1, &status, options_.progress ? WNOHANG : 0);
  if (process == 0) usleep(moment);
  return process > 0 ? ended(process, status) : done;  // a signal: those that go on are waited for again
}

/// Its exit code, 2 only where no run has ended otherwise.
int RunPool::ended(int process, int status) {
  const auto at = going_.find(process);
  if (at == going_.end()) return done;
  const PooledRun& run = *at->second;
  going_.erase(at);
  if (WIFEXITED(status) && WEXITSTATUS(status) == wrong_input && !one_ended_) return wrong_input;
  one_ended_ = true;
  if (WIFEXITED(status) && WEXITSTATUS(status) == kept) return done;
  const bool complete = WIFEXITED(status) && WEXITSTATUS(status) == done;
  if (!options_.quiet)
    print_formatted("{}: {}\n", run.name, complete ? "done" : finished(run.name) ? "ended early" : "not finished");
  std::fflush(stdout);
  return complete ? done : failed;
}

void make_output_folder(const fs::path& folder) {
  if (fs::is_directory(folder)) return;
  if (fs::exists(folder)) throw input_error("-o", folder.string() + ", which is a file", "a folder");
  const fs::path parent = fs::absolute(folder / "").parent_path().parent_path();
  if (!fs::is_directory(parent)) {
    throw input_error("-o", fmt::format("no folder {}", parent.string()), "a new folder in an existing one");
  }
  std::error_code failure;
  fs::create_directory(folder, failure);
  if (failure) throw input_error("-o", folder.string() + ": " + failure.message(), "a folder that can be created");
}

}  // namespace railtab::vsi
