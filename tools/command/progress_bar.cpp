#include "command/progress_bar.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "railtab/runtime/base/printable_text.hpp"

namespace railtab {

namespace {

using namespace std::chrono_literals;
constexpr auto patience = 2s;       // before anything is drawn
constexpr auto log_interval = 60s;  // of lines where no terminal is

bool on_terminal() { return ::isatty(STDERR_FILENO) != 0; }

void draw_line(const std::string& text) {
  std::fputs(fmt::format("\r{}\x1b[K", printable(text)).c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace

ProgressBar::ProgressBar(std::string title, bool wanted)
    : title_(std::move(title)),
      enabled_(wanted),
      terminal_(on_terminal()),
      start_(Clock::now()),
      pass_start_(start_),
      last_drawn_(start_) {}

void ProgressBar::wipe() {
  if (drawn_) draw_line("");
  drawn_ = false;
}

void ProgressBar::show(double share) {
  if (!enabled_) return;
  const Clock::time_point now = Clock::now();
  if (!begun_ || share < last_share_ - 0.5) {
    pass_start_ = now;
    first_share_ = share;
    begun_ = true;
  }
  last_share_ = share;
  if (now - start_ < patience || now - last_drawn_ < (terminal_ ? 100ms : log_interval)) return;
  last_drawn_ = now;
  const double elapsed = std::chrono::duration<double>(now - pass_start_).count();
  const double done = share - first_share_;
  const std::string left = done > 0.0 ? fmt::format("{:.0f} s left", elapsed * (1.0 - share) / done) : "";
  if (!terminal_) {
    std::fputs(
        fmt::format("{}: {:.0f} %{}\n", printable(title_), 100.0 * share, left.empty() ? "" : ", " + left).c_str(),
        stderr);
    return;
  }
  drawn_ = true;
  constexpr int width = 40;
  const int full = static_cast<int>(std::clamp(share, 0.0, 1.0) * width);
  draw_line(fmt::format("{} [{:#<{}}{:.<{}}] {:3.0f} % {}", title_, "", full, "", width - full, 100.0 * share, left));
}

SetupProgress::SetupProgress(bool wanted) {
  if (wanted && on_terminal()) thread_ = std::thread([this] { draw(); });
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
  const auto begin = std::chrono::steady_clock::now();
  std::unique_lock lock(mutex_);
  for (bool drawn = false;; drawn = true) {
    if (changed_.wait_for(lock, drawn ? 500ms : patience, [this] { return ended_; })) {
      if (drawn) draw_line("");
      return;
    }
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
    draw_line(fmt::format("set-up: {}, {:.0f} s", part_, elapsed.count()));
  }
}

}  // namespace railtab
