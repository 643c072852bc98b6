#pragma once

#include <array>
#include <cstddef>

#include "railtab/runtime/base/stopwatch.hpp"

namespace railtab {

/// What a run's time is spent on; `contact` is all that the contact solution does besides looking up the geometry.
enum class Phase { setup, lookup, contact, structure, vehicle, output };

/// Wall time of a run by phase [s].
class StepTimes {
 public:
  /// Adds the time of the watch's scope.
  [[nodiscard]] Stopwatch measure(Phase phase) { return Stopwatch(seconds(phase)); }
  [[nodiscard]] double& seconds(Phase phase) { return seconds_[static_cast<std::size_t>(phase)]; }
  [[nodiscard]] double seconds(Phase phase) const { return seconds_[static_cast<std::size_t>(phase)]; }
  StepTimes& operator+=(const StepTimes& more) {
    for (std::size_t i = 0; i < seconds_.size(); ++i) seconds_[i] += more.seconds_[i];
    return *this;
  }

 private:
  std::array<double, 6> seconds_{};
};

}  // namespace railtab
