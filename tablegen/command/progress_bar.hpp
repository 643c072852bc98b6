#pragma once

#include <chrono>
#include <string>

namespace railtab {

/// One line on stderr with the share done and the time left; only on a terminal, only after two seconds of work.
class ProgressBar {
 public:
  /// @param wanted false keeps it silent (--quiet)
  ProgressBar(std::string title, bool wanted);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Share done, 0..1; a smaller share than before starts a new pass.
  void show(double share);

 private:
  using Clock = std::chrono::steady_clock;
  std::string title_;
  bool enabled_;
  bool drawn_ = false;
  double last_share_ = 0.0;
  Clock::time_point start_, pass_start_, last_drawn_;
};

}  // namespace railtab
