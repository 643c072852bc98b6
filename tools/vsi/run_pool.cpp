#include "run_pool.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <new>
#include <numeric>
#include <optional>
#include <utility>

#include "command/print.hpp"
#include "interrupt.hpp"
#include "railtab/runtime/base/file_checksum.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/printable_text.hpp"
#include "railtab/runtime/base/process_end.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/base/writer_lock.hpp"
#include "railtab/runtime/results/result_file.hpp"
#include "railtab/runtime/scene/recorded_run.hpp"
#include "railtab/runtime/scene/scene_keys.hpp"
#include "run_command.hpp"

namespace railtab::vsi {
namespace fs = std::filesystem;
namespace {

using exit_code::done, exit_code::failed, exit_code::wrong_input, exit_code::interrupted;
constexpr int kept = 3;  // of a run that was finished before

bool is_readable(const fs::path& results) {
  try {
    static_cast<void>(read_results(results));
    return true;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace

RunPool::RunPool(fs::path scene_file, fs::path folder, RunPoolOptions options)
    : scene_file_(std::move(scene_file)), folder_(std::move(folder)), options_(std::move(options)) {}

/// What the workers know of each other, in memory that all processes share.
struct RunPool::Board {
  static constexpr std::size_t most_workers = 1024;
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  std::atomic<std::size_t> next{0};                       ///< run that nobody has begun
  std::atomic<bool> stop{false};                          ///< no further run is begun
  std::atomic<bool> interrupted{false};                   ///< those in progress end after their step
  std::atomic<bool> one_ended{false};                     ///< otherwise than by wrong input
  std::array<std::atomic<std::size_t>, most_workers> at;  ///< run that each worker makes, or none
  double* share;                                          ///< how far each run is, 0..1, as many as there are runs

  static_assert(std::atomic<std::size_t>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);
};

namespace {

/// Of a run that has ended: its number and exit code, as a worker tells it.
struct EndOfRun {
  std::size_t run;
  int code;
  bool wrong_for_all;  ///< its input, and no run has ended otherwise
};

/// Memory that processes share, zero at first.
class SharedMemory {
 public:
  explicit SharedMemory(std::size_t bytes) : bytes_(bytes) {
    memory_ = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory_ == MAP_FAILED)
      throw ComputationError(fmt::format("no memory of {} bytes for several processes", bytes));
  }
  ~SharedMemory() { munmap(memory_, bytes_); }
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;
  [[nodiscard]] void* get() const { return memory_; }

 private:
  std::size_t bytes_;
  void* memory_;
};

/// The end of a pipe from the workers to the pool.
class ReportPipe {
 public:
  ReportPipe() {
    if (::pipe2(ends_, O_CLOEXEC) != 0) throw ComputationError("no pipe to further processes can be made");
  }
  ~ReportPipe() {
    ::close(ends_[0]);
    ::close(ends_[1]);
  }
  ReportPipe(const ReportPipe&) = delete;
  ReportPipe& operator=(const ReportPipe&) = delete;

  [[nodiscard]] int to_write() const { return ends_[1]; }
  /// Waits for a report. @param longest [ms] @return none where there was none
  [[nodiscard]] std::optional<EndOfRun> wait(int longest) const {
    pollfd wanted{ends_[0], POLLIN, 0};
    EndOfRun end{};
    // a report is shorter than what a pipe takes as a whole
    if (::poll(&wanted, 1, longest) <= 0 || ::read(ends_[0], &end, sizeof end) != sizeof end) return std::nullopt;
    return end;
  }

 private:
  int ends_[2] = {-1, -1};
};

}  // namespace

int RunPool::run(const std::vector<PooledRun>& runs, std::size_t processes) {
  if (runs.empty()) return done;
  Interrupt::listen();
  runs_ = &runs;
  const SharedMemory memory(sizeof(Board)), shares(runs.size() * sizeof(double));
  Board& board = *new (memory.get()) Board;
  board.share = new (shares.get()) double[runs.size()]();
  const ReportPipe reports;
  const std::size_t most = std::min({processes, runs.size(), Board::most_workers});
  for (std::size_t worker = 0; worker < most; ++worker) begin_worker(board, worker, reports.to_write());
  int code = done;
  std::vector<bool> told(runs.size(), false);
  const auto ended = [&](const EndOfRun& end) {
    told[end.run] = true;
    if (end.code == kept) return;
    if (!end.wrong_for_all) say_end(runs[end.run], end.code);
    if (end.code != done) code = std::max(code, end.wrong_for_all ? wrong_input : failed);
  };
  const auto hear = [&](int longest) {
    constexpr int at_once = 0;
    for (auto end = reports.wait(longest); end; end = reports.wait(at_once)) ended(*end);
  };
  while (!workers_.empty()) {
    if (Interrupt::asked()) board.stop = board.interrupted = true;
    constexpr int moment = 100;  // ms
    hear(moment);
    for (pid_t process = 0; (process = ::waitpid(-1, nullptr, WNOHANG)) > 0;) {
      const auto at = workers_.find(process);
      if (at == workers_.end()) continue;
      const std::size_t worker = at->second, lost = board.at[worker];
      workers_.erase(at);
      hear(0);
      if (lost == Board::none) continue;
      // the worker died, with its run where it had not told its end
      board.one_ended = true;
      if (!told[lost]) ended({lost, failed, false});
      if (!board.stop && board.next < runs.size()) begin_worker(board, worker, reports.to_write());
    }
    if (options_.progress) {
      options_.progress(std::accumulate(board.share, board.share + runs.size(), 0.0) /
                        static_cast<double>(runs.size()));
    }
  }
  if (!board.stop && std::find(told.begin(), told.end(), false) != told.end()) code = std::max(code, failed);
  return Interrupt::asked() ? interrupted : code;
}

bool RunPool::finished(const std::string& name) const {
  return fs::exists(file(name, ".row")) && (options_.results != PooledResults::kept || fs::exists(file(name, ".h5")));
}

fs::path RunPool::file(const std::string& name, const char* suffix) const { return folder_ / (name + suffix); }

void RunPool::begin_worker(Board& board, std::size_t worker, int report) {
  board.at[worker] = Board::none;
  std::fflush(nullptr);
  const pid_t process = fork();
  if (process < 0) throw ComputationError(options_.command + ": no more processes can be started");
  if (process == 0) {
    signal(SIGINT, SIG_DFL);
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // a parent that is killed leaves no run behind that would hold its file
    work(board, worker, report);
    std::fflush(nullptr);
    _exit(done);
  }
  workers_.emplace(process, worker);
}

void RunPool::work(Board& board, std::size_t worker, int report) const {
  SharedSetUp shared;
  while (!board.stop) {
    const std::size_t run = board.next++;
    if (run >= runs_->size()) return;
    board.at[worker] = run;
    EndOfRun end{run, make(board, run, shared), false};
    board.share[run] = 1.0;
    end.wrong_for_all = end.code == wrong_input && !board.one_ended;
    if (end.wrong_for_all) board.stop = true;
    if (end.code != wrong_input) board.one_ended = true;
    if (::write(report, &end, sizeof end) != sizeof end) _exit(failed);
    board.at[worker] = Board::none;
    if (end.code == interrupted) return;
  }
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
  std::error_code error;
  fs::rename(old, aside, error);
  if (error == std::errc::no_such_file_or_directory) return;  // taken away by another process
  if (error) throw fs::filesystem_error("cannot rename", old, aside, error);
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

namespace {

/// Held while results are judged, which another process may be writing. Not held where nobody can write them.
/// @throws FileInUse
WriterLock lock_of(const fs::path& results) {
  WriterLock lock;
  try {
    lock = WriterLock(results);
  } catch (const FileInUse&) {
    throw;
  } catch (const InputError&) {
    return lock;
  }
  if (lock.is_of(results)) return lock;
  throw FileInUse(fmt::format("{}: was replaced by another process", results.string()));
}

}  // namespace

/// Results that cannot be read, cut off by a full disk or a kill, or that are another run's would stand in the way of
/// their run for good; and a row is only believed beside its results.
void RunPool::set_others_aside(const std::string& name, const SceneParameters& scene) const {
  std::string why = "alone";
  if (fs::exists(file(name, ".h5"))) {
    const WriterLock lock = lock_of(file(name, ".h5"));
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

int RunPool::make(Board& board, std::size_t number, SharedSetUp& shared) const {
  const PooledRun& run = (*runs_)[number];
  std::optional<SceneParameters> scene;
  try {
    scene = run.scene();
    return make_row(board, number, *scene, shared);
  } catch (const FileInUse& in_use) {  // of this run alone
    print_message(fmt::format("{}: {}: {}\n", options_.command, run.name, in_use.what()));
  } catch (const InputError& wrong) {
    const InputError placed = scene ? with_scene_line(wrong, *scene, scene_file_) : wrong;
    print_message(fmt::format("{}: {}: {}\n", options_.command, run.name, placed.what()));
    return wrong_input;
  } catch (const std::bad_alloc&) {
    print_message(fmt::format("{}: {}: not enough memory: fewer --threads need less, vsi run --plan states how much\n",
                              options_.command, run.name));
  } catch (const std::exception& failure) {
    print_message(fmt::format("{}: {}: {}\n", options_.command, run.name, failure.what()));
  }
  return failed;
}

/// The run, where it is not finished, and its row.
int RunPool::make_row(Board& board, std::size_t number, const SceneParameters& scene, SharedSetUp& shared) const {
  const PooledRun& run = (*runs_)[number];
  const fs::path results = file(run.name, ".h5");
  const auto tidy = [&] {
    if (options_.results == PooledResults::removed && finished(run.name)) fs::remove(results);
  };
  if (options_.results == PooledResults::kept || !finished(run.name)) set_others_aside(run.name, scene);
  if (finished(run.name)) {
    tidy();
    return kept;
  }
  std::optional<std::pair<report::Headline, RunSummary>> end;
  RunOptions options{results.string(), false, true, true};
  options.progress = [&](double done_so_far) { board.share[number] = done_so_far; };
  options.stop = [&] { return board.interrupted.load(); };
  options.shared = &shared;
  std::string warnings;
  options.ended = [&](const report::Headline& headline, const RunSummary& summary,
                      const std::vector<std::string>& given) {
    if (summary.interrupted) return;
    for (const std::string& warning : given) warnings += printable(warning) + "\n";
    end.emplace(headline, summary);
    if (!summary.complete) say_early_end(run.name, scene, headline, summary);
  };
  const bool writes = options_.results != PooledResults::unwritten || fs::exists(results);
  const int code = writes ? run_to_file(scene, options) : run_without_results(scene, options);
  if (end && (!writes || fs::exists(results))) {
    write_warnings(run.name, warnings);
    // another process may have been faster, with another run time in the same row
    write_text_file(file(run.name, ".row"), run.row(end->first, end->second, results), run.name + ",");
  }
  tidy();
  return code;
}

void RunPool::write_warnings(const std::string& name, const std::string& warnings) const {
  const fs::path output = file(name, ".warnings");
  fs::remove(output);  // those of an earlier run of this name
  if (!warnings.empty()) write_text_file(output, warnings);
}

void RunPool::say_early_end(const std::string& name, const SceneParameters& scene, const report::Headline& headline,
                            const RunSummary& summary) const {
  const std::string when = summary.steps > 0 ? fmt::format("the run ended at t = {:.6g} s", headline.simulated_time)
                                             : std::string("no step was made");
  const std::string where = summary.steps > 0 && options_.results == PooledResults::kept
                                ? fmt::format("; everything up to there is in {}", file(name, ".h5").string())
                                : std::string();
  print_message(
      fmt::format("{}: {}: {}: {}: {}{}\n", options_.command, name, scene.name, when, summary.message, where));
}

/// @param code of the run, 0: it came to its end
void RunPool::say_end(const PooledRun& run, int code) {
  if (options_.quiet) return;
  print_formatted("{}: {}\n", run.name, code == done ? "done" : finished(run.name) ? "ended early" : "not finished");
  std::fflush(stdout);
}

void make_output_folder(const fs::path& folder) {
  if (folder.empty()) throw input_error("-o", "an empty name", "the name of a folder");
  std::error_code rejected;
  const fs::file_status there = fs::status(folder, rejected);
  if (fs::is_directory(there)) return;
  if (fs::exists(there)) throw input_error("-o", folder.string() + ", which is a file", "a folder");
  const fs::path parent = fs::absolute(folder / "").parent_path().parent_path();
  if (!fs::is_directory(parent, rejected)) {
    throw input_error("-o", fmt::format("no folder {}", parent.string()), "a new folder in an existing one");
  }
  std::error_code failure;
  fs::create_directory(folder, failure);
  if (failure) throw input_error("-o", folder.string() + ": " + failure.message(), "a folder that can be created");
}

}  // namespace railtab::vsi
