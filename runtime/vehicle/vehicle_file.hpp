#pragma once

#include <filesystem>
#include <string>

#include "railtab/runtime/vehicle/vehicle_data.hpp"

namespace railtab {

/// Reads a vehicle from a TOML file (docs/file_formats/vehicle.md).
/// @throws InputError with file, line and key: no such file, no TOML, a missing or unknown key, a value of a wrong type
///         or out of range, a body that is not there
[[nodiscard]] VehicleData read_vehicle_file(const std::filesystem::path& file);

/// The same from the text of a file. @param place for messages
[[nodiscard]] VehicleData parse_vehicle(const std::string& text, const std::filesystem::path& place);

}  // namespace railtab
