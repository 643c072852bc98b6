#include "progress_bar.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include "railtab/runtime/base/process_end.hpp"

namespace railtab {

ProgressBar::ProgressBar(std::string title, bool wanted)
    : title_(std::move(title)),
      enabled_(wanted && isatty(STDERR_FILENO) != 0),
      start_(Clock::now()),
      pass_start_(start_),
      last_drawn_(start_) {}

ProgressBar::~ProgressBar() {
  if (drawn_) std::fputs("\r\x1b[K", stderr);
}

void ProgressBar::show(double share) {
  if (!enabled_) return;
  const Clock::time_point now = Clock::now();
  if (share < last_share_ - 0.5) pass_start_ = now;
  last_share_ = share;
  if (now - start_ < std::chrono::seconds(2) || now - last_drawn_ < std::chrono::milliseconds(100)) return;
  last_drawn_ = now;
  drawn_ = true;
  const double elapsed = std::chrono::duration<double>(now - pass_start_).count();
  const double left = share > 0 ? elapsed * (1.0 - share) / share : 0.0;
  constexpr int width = 40;
  const int full = static_cast<int>(share * width);
  print_message(fmt::format("\r{} [{:#<{}}{:.<{}}] {:3.0f} % {:4.0f} s left\x1b[K", title_, "", full, "", width - full,
                            100 * share, left));
  std::fflush(stderr);
}

}  // namespace railtab
