#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

namespace railtab {

/// The share done and the time left on stderr, after two seconds of work: on a terminal one line that is drawn anew,
/// elsewhere, as in the log of a batch job, a line each minute.
class ProgressBar {
 public:
  /// @param wanted false keeps it silent (--quiet)
  ProgressBar(std::string title, bool wanted);
  ~ProgressBar() { wipe(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Share done, 0..1; a much smaller share than before starts a new pass. The first one says where a pass begins, for
  /// work that is resumed.
  void show(double share);
  void wipe();

 private:
  using Clock = std::chrono::steady_clock;
  std::string title_;
  bool enabled_, terminal_;
  bool drawn_ = false, begun_ = false;
  double last_share_ = 0.0, first_share_ = 0.0;
  Clock::time_point start_, pass_start_, last_drawn_;
};

/// What the set-up of a run is at, with the time since it began, under the same conditions: a thread of its own draws
/// it, for no part of the set-up knows how far it is.
class SetupProgress {
 public:
  explicit SetupProgress(bool wanted);
  ~SetupProgress() { end(); }
  SetupProgress(const SetupProgress&) = delete;
  SetupProgress& operator=(const SetupProgress&) = delete;
  void show(std::string_view part);
  void end();

 private:
  void draw();
  std::mutex mutex_;
  std::condition_variable changed_;
  std::string part_;
  bool ended_ = false;
  std::thread thread_;
};

}  // namespace railtab
