#pragma once

#include <string>
#include <vector>

#include "railtab/runtime/vehicle/vehicle_data.hpp"

namespace railtab {

/// By how much the springs of one name are compressed or extended along z under the weight.
struct StaticDeflection {
  std::string suspension;
  double deflection = 0.0;  ///< largest amount of all springs of the name [m]
};

/// Of all springs with a stiffness along z, in the order of the file, by linear stand-ins and without geometric
/// stiffness; none of a vehicle that stands on its joints. @throws InputError as build_vehicle()
[[nodiscard]] std::vector<StaticDeflection> static_deflections(const VehicleData& data);

/// Sentences on values that no vehicle has, most likely a slip in a unit or a power of ten: springs that deflect by
/// more than 0.5 m, wheels that overlap, a car body lighter than all wheelsets. @throws InputError as build_vehicle()
[[nodiscard]] std::vector<std::string> implausible_values(const VehicleData& data);

}  // namespace railtab
