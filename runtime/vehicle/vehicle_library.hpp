#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "railtab/runtime/vehicle/vehicle_data.hpp"

namespace railtab {

/// Names of the vehicles that come with railtab, runtime/vehicle/library/NAME.toml, in alphabetical order.
[[nodiscard]] std::vector<std::string> vehicle_names();
/// One of them. @throws InputError with the known names
[[nodiscard]] VehicleData library_vehicle(std::string_view name);

/// A vehicle of the library, or, where the name ends with ".toml", that of a file. @throws InputError
[[nodiscard]] VehicleData find_vehicle(const std::string& name);

/// The parameters of a vehicle of the library that has two bogies. @throws InputError
[[nodiscard]] CoachParameters coach_parameters(std::string_view name);

/// The library as it is compiled in, in no order: file names without ".toml" and texts.
struct LibraryFile {
  std::string_view name, text;
};
[[nodiscard]] const std::vector<LibraryFile>& library_files();

}  // namespace railtab
