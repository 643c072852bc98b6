#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "railtab/runtime/vehicle/vehicle_model.hpp"

namespace railtab {

/// A two-bogie coach: seven rigid bodies. "Per box" = per axle box, "per side" = per bogie side.
struct CoachParameters {
  // implementer: one member per published quantity of FACTS section 6, unit and source in its comment
  std::string name = "manchester-coach";
  void validate() const;  ///< @throws InputError
};

/// Names of the published vehicles, and a vehicle by name. @throws InputError with the known names.
[[nodiscard]] std::vector<std::string> vehicle_names();
[[nodiscard]] CoachParameters coach_parameters(std::string_view name);

[[nodiscard]] VehicleModel build_coach(const CoachParameters& parameters);

}  // namespace railtab
