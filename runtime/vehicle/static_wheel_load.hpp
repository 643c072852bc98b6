#pragma once

#include "railtab/runtime/vehicle/vehicle_model.hpp"

namespace railtab {

/// Half of what a vehicle's wheelset carries at rest, wheelsets counted from its front [N]: Q0 of both its wheels, also
/// where a weight beside the middle loads one of them more.
[[nodiscard]] inline double static_wheel_load(const VehicleModel& vehicle, int wheelset) noexcept {
  const auto body = static_cast<std::size_t>(vehicle.wheelsets[static_cast<std::size_t>(wheelset)]);
  const int vertical = vehicle.dof[body][2];
  return vertical == held ? 0.0 : 0.5 * vehicle.static_load[vertical];
}

}  // namespace railtab
