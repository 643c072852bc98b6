#include "progress_bar.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <string>
#include "railtab/runtime/base/process_end.hpp"

namespace railtab::vsi {

ProgressBar::ProgressBar(bool quiet) : enabled_(!quiet && isatty(STDERR_FILENO) == 1) {}

void ProgressBar::wipe() {
  if (drawn_) print_message("\r\033[K");
  drawn_ = false;
}

void ProgressBar::show(double fraction) {
  using namespace std::chrono_literals;
  if (!enabled_) return;
  const Clock::time_point now = Clock::now();
  if (now - begin_ < 2s || now - last_ < 100ms) return;
  last_ = now;
  drawn_ = true;
  constexpr int width = 40;
  const int done = static_cast<int>(width * fraction);
  const double elapsed = std::chrono::duration<double>(now - begin_).count();
  const std::string left = fraction > 0.0 ? fmt::format("{:.0f} s left", elapsed * (1.0 - fraction) / fraction) : "";
  print_message(fmt::format("\r\033[K[{}{}] {:3.0f} %  {}", std::string(static_cast<std::size_t>(done), '#'),
                            std::string(static_cast<std::size_t>(width - done), ' '), 100.0 * fraction, left));
  std::fflush(stderr);
}

SetupProgress::SetupProgress(bool quiet) {
  if (!quiet && isatty(STDERR_FILENO) == 1) thread_ = std::thread([this] { draw(); });
}

void SetupProgress::show(std::string_view part) {
  const std::lock_guard lock(mutex_);
  part_ = part;
}

void SetupProgress::end() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void SetupProgress::draw() {
  using namespace std::chrono_literals;
  const auto begin = std::chrono::steady_clock::now();
  std::unique_lock lock(mutex_);
  for (bool drawn = false;; drawn = true) {
    if (changed_.wait_for(lock, drawn ? 500ms : 2000ms, [this] { return ended_; })) {
      if (drawn) print_message("\r\033[K");
      return;
    }
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
    print_message(fmt::format("\r\033[Kset-up: {}, {:.0f} s", part_, elapsed.count()));
    std::fflush(stderr);
  }
}

}  // namespace railtab::vsi
