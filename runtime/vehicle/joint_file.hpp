#pragma once

#include <filesystem>
#include <string>

#include "railtab/runtime/vehicle/vehicle_data.hpp"

namespace railtab {

/// Beginnings of the names by which a joint's connections name bodies of the vehicles that it joins.
inline constexpr std::string_view of_vehicle_ahead = "ahead/", of_vehicle_behind = "behind/";

/// What joins two neighbouring vehicles: couplers, dampers, a shared bogie with its wheelsets. Positions x count from
/// the middle between the vehicles, where their lengths over couplers meet. Bodies of the neighbours stand in
/// VehicleData::parts by the names "ahead/…" and "behind/…", at x = 0 and without mass.
/// @param place for messages @throws InputError with file, line and key
[[nodiscard]] VehicleData parse_joint(const std::string& text, const std::filesystem::path& place);

/// @throws InputError
[[nodiscard]] VehicleData read_joint_file(const std::filesystem::path& file);

}  // namespace railtab
