#include "railtab/runtime/scene/step_count.hpp"

#include <fmt/format.h>

#include <cmath>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

long step_count(const IntegrationParameters& integration, double duration) {
  constexpr double most = 1e9;
  const double steps = duration / integration.time_step;
  if (!(steps >= 0.5 && steps <= most)) {
    throw input_error("scene: integration.time_step",
                      fmt::format("{:.3g} steps of {} s in {:.3g} s", steps, integration.time_step, duration),
                      fmt::format("1 to {:.0e} steps", most));
  }
  return std::lround(steps);
}

}  // namespace railtab
