#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "railtab/runtime/fe/fe_frame.hpp"
#include "railtab/runtime/vehicle/vehicle_model.hpp"

namespace railtab {

/// A vehicle from a multibody or finite-element program: linear matrices of the free vehicle, without track, wheel-rail
/// contact, gravity and gyroscopic moments, in the nominal position.
struct VehicleImport {
  std::filesystem::path mass, damping, stiffness;  ///< Matrix Market
  std::filesystem::path dofs;                      ///< which rows are bodies' motions, and where the bodies stand
  FeFrame frame;                       ///< its origin: under the vehicle's centre, at the height of the rail-head tops
  std::vector<std::string> wheelsets;  ///< names in the table, in order from the front
  std::string car_body;                ///< name in the table; its x is held by the train
  /// Names of all car bodies of a train of several coaches, front first, the first of which is `car_body`; none: one.
  std::vector<std::string> car_bodies{};
  std::optional<double> length;  ///< over couplers [m], > 0; a train of one vehicle needs none

  /// What no file tells. @param vehicles of the train @throws InputError naming the key
  void validate(int vehicles) const;
};

/// What a scene calls the vehicle that it imports.
inline constexpr std::string_view imported_vehicle = "imported";

/// Rows that an imported vehicle may have; its matrices are dense in a run.
inline constexpr int most_vehicle_rows = 1000;

/// Reads and checks an imported vehicle. In results and loads its car body is "car-body" and its wheelsets are
/// "wheelset-1" …; other bodies keep their names. The nominal radius is the height of the axles. Static load: what the
/// wheelsets carry of M·g times a unit fall; J_y of a wheelset is the mass matrix' entry of its rotation. In the
/// vertical plane y, roll and yaw of all bodies and the wheelsets' rotation are held.
/// @param weight its geometric stiffness: `included` adds one with an assumption (geometric_stiffness.hpp); with
///        `in_matrices` the stiffness may resist roll and pitch of the whole vehicle
/// @throws InputError with file and line, row or key: what the readers of its files reject; matrices that are not
///         symmetric, not positive (semi)definite, tied to the ground or free in more than the six rigid motions and
///         the wheelsets' rotations; mass that differs between x, y and z; wheelsets or a car body without their rows
[[nodiscard]] VehicleModel import_vehicle(const VehicleImport& import, MotionPlane plane = MotionPlane::spatial,
                                          const VehicleWeight& weight = {});

}  // namespace railtab
