#pragma once

#include <vector>

#include "railtab/runtime/vehicle/vehicle_model.hpp"

namespace railtab {

/// What to compare with the program that a vehicle comes from.
struct VehicleSummary {
  double mass = 0;                  ///< that the wheelsets carry, their own included [kg]
  std::vector<double> wheel_load;   ///< static_wheel_load() of each wheelset, front first [N]
  std::vector<double> frequencies;  ///< lowest natural frequencies while the wheelsets and the car body's x rest [Hz]
};

/// @param modes at most, >= 0
[[nodiscard]] VehicleSummary summarise(const VehicleModel& vehicle, int modes);

}  // namespace railtab
