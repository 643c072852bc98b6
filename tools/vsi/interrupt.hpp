#pragma once

#include <csignal>

namespace railtab::vsi {

/// Ctrl-C while steps are made: a first one asks the runs of this process to end after their step, a second one ends
/// the program.
class Interrupt {
 public:
  static void listen() {
    struct sigaction action {};
    action.sa_handler = [](int) { asked_ = 1; };
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    sigaction(SIGINT, &action, nullptr);
  }
  [[nodiscard]] static bool asked() { return asked_ != 0; }

 private:
  static inline volatile std::sig_atomic_t asked_ = 0;
};

}  // namespace railtab::vsi
