#include "railtab/runtime/scene/step_count.hpp"

#include <fmt/format.h>

#include <algorithm>
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

long pre_roll_steps(const IntegrationParameters& integration, const VsiModel& model) {
  constexpr double enough = 0.2;  // s: the wheelsets' bouncing on the track has decayed to less than 1e-3
  const auto steps = [&](double time) { return time > 0.0 ? static_cast<long>(time / integration.time_step) : 0L; };
  if (!model.structure) return model.geometry && model.geometry->is_paper() ? steps(enough) : 0;
  const double rear = model.wheelset_x(model.wheelsets() - 1, 0.0);
  const double track = rear - std::max(model.structure->rail[0].x.front(), model.structure->rail[1].x.front());
  return steps(std::min(enough, 0.8 * track / model.speed(0.0)));
}

}  // namespace railtab
