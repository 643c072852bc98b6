#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

namespace railtab::vsi {

/// A progress bar with the time left on stderr, where that is a terminal, for what takes more than two seconds.
class ProgressBar {
 public:
  explicit ProgressBar(bool quiet);
  ~ProgressBar() { wipe(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  void show(double fraction);
  void wipe();

 private:
  using Clock = std::chrono::steady_clock;
  bool enabled_;
  bool drawn_ = false;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point last_ = begin_;
};

/// What the set-up of a run is at, with the time since it began, where stderr is a terminal and it takes more than two
/// seconds: a thread of its own draws it, for no part of the set-up knows how far it is.
class SetupProgress {
 public:
  explicit SetupProgress(bool quiet);
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

}  // namespace railtab::vsi
