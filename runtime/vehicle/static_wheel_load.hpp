#pragma once

#include "railtab/runtime/base/motion_names.hpp"
#include "railtab/runtime/vehicle/vehicle_model.hpp"

namespace railtab {

/// Half of what a vehicle's wheelset carries at rest on the run's track, wheelsets counted from its front [N]: in a
/// curve under the weight normal to it.
[[nodiscard]] inline double wheel_load_at_rest(const VehicleModel& vehicle, int wheelset) noexcept {
  const auto body = static_cast<std::size_t>(vehicle.wheelsets[static_cast<std::size_t>(wheelset)]);
  const int vertical = vehicle.dof[body][z_dof];
  return vertical == held ? 0.0 : 0.5 * vehicle.static_load[vertical];
}

/// Q0 [N]: half of what a wheelset carries at rest on level track, in a curve too [EN14363]. Of both its wheels, also
/// where a weight beside the middle loads one of them more.
[[nodiscard]] inline double static_wheel_load(const VehicleModel& vehicle, int wheelset) noexcept {
  if (vehicle.gravity == 0.0) return 0.0;
  return standard_gravity / vehicle.gravity * wheel_load_at_rest(vehicle, wheelset);
}

/// Half the distance of the contact points of a wheelset on standard gauge [m], where no profiles are known.
inline constexpr double half_contact_distance = 0.75;

/// What the two wheels of a wheelset carry at rest [N]; below zero where a rail would have to pull its wheel down.
struct WheelLoads {
  double left, right;
};

/// By the static load along z and about x, N/2 ∓ M/(2b); the mean where roll is held.
/// @param wheelset counted from the vehicle's front  @param half_distance b of its contact points [m], > 0
[[nodiscard]] inline WheelLoads static_wheel_loads(const VehicleModel& vehicle, int wheelset,
                                                   double half_distance) noexcept {
  const auto body = static_cast<std::size_t>(vehicle.wheelsets[static_cast<std::size_t>(wheelset)]);
  const int roll = vehicle.dof[body][roll_dof];
  const double mean = wheel_load_at_rest(vehicle, wheelset);
  const double moved = roll == held ? 0.0 : 0.5 * vehicle.static_load[roll] / half_distance;
  return {mean - moved, mean + moved};
}

}  // namespace railtab
