#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "railtab/runtime/vehicle/vehicle_data.hpp"

namespace railtab {

/// Neighbouring vehicles of one kind in a train.
struct ConsistEntry {
  std::string vehicle;    ///< of the library, or a file
  int count = 1;          ///< 1..100
  bool reversed = false;  ///< turned by half a turn about the vertical: what is its front runs at the rear
};

/// "coach", "-power-car", "coach*8", "-power-car*2": `-` turns the vehicle round, `*` repeats it.
/// @returns none where the text has no such form
[[nodiscard]] std::optional<ConsistEntry> parse_consist_entry(std::string_view text);

/// One vehicle of a train, and the joint behind it (docs/file_formats/vehicle.md, "Joints").
struct ConsistVehicle {
  VehicleData data;
  bool reversed = false;
  std::optional<VehicleData> joint;  ///< none behind the last vehicle, and where nothing joins the neighbours
  bool joint_reversed = false;
};

/// The vehicles of a train, front first, and the joints that their files name.
/// @param joint file of the joint between neighbours whose files name none; empty: nothing joins them
/// @throws InputError where a file is wrong, or neighbours name different joints
[[nodiscard]] std::vector<ConsistVehicle> read_consist(const std::vector<ConsistEntry>& entries,
                                                       const std::filesystem::path& joint);

/// A vehicle turned by half a turn about the vertical through its centre. Bodies keep their order; their numbers and
/// sides are those of the turned vehicle, front and left first.
[[nodiscard]] VehicleDescription reversed(const VehicleDescription& parts);

/// All vehicles and joints as one system of bodies, the first vehicle's centre at x = 0. Bodies know their coach by
/// RigidBody::coach; those of a joint belong to the coach ahead of it and are named "joint-…".
/// @throws InputError where a joint names a body that its neighbours have not
[[nodiscard]] VehicleDescription describe_consist(const std::vector<ConsistVehicle>& train);

/// describe_consist() as a model. Its top speed is the lowest of those stated.
/// @throws InputError where data are vertical and `plane` is not, or joints of vertical vehicles are spatial
[[nodiscard]] VehicleModel build_consist(const std::vector<ConsistVehicle>& train, MotionPlane plane,
                                         const VehicleWeight& weight, ForceElementChoice choice);

/// "2 x power-car, 8 x coach" in the order in which they first appear.
[[nodiscard]] std::string consist_text(const std::vector<ConsistVehicle>& train);

}  // namespace railtab
