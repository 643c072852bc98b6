#include "progress_bar.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <string>

namespace railtab::vsi {

ProgressBar::ProgressBar(bool quiet) : enabled_(!quiet && isatty(STDERR_FILENO) == 1) {}

void ProgressBar::wipe() {
  if (drawn_) fmt::print(stderr, "\r\033[K");
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
  fmt::print(stderr, "\r\033[K[{}{}] {:3.0f} %  {}", std::string(static_cast<std::size_t>(done), '#'),
             std::string(static_cast<std::size_t>(width - done), ' '), 100.0 * fraction, left);
  std::fflush(stderr);
}

}  // namespace railtab::vsi
