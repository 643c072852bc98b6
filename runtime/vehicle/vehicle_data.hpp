#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "railtab/runtime/vehicle/coach.hpp"
#include "railtab/runtime/vehicle/provenance.hpp"
#include "railtab/runtime/vehicle/vehicle_model.hpp"

namespace railtab {

/// What a vehicle file says that its numbers must add up to.
struct StatedCheck {
  std::string quantity;  ///< "mass", "axle load of wheelset-1", or a motion as natural_modes() names it
  std::string unit;      ///< kg or Hz
  double low, high;
};

/// A vehicle as a file describes it (docs/file_formats/vehicle.md).
struct VehicleData {
  std::string place;  ///< the file, for messages
  std::string text;   ///< the TOML itself
  std::string name, description;
  Provenance provenance;                      ///< of all values without one of their own
  MotionPlane motion = MotionPlane::spatial;  ///< vertical: the data say nothing of lateral motion
  double top_speed = 0.0;                     ///< [m/s]; 0: not stated
  /// Files of the joints to neighbours in a train, by which the vehicle's ends stand or are coupled; empty: none.
  std::filesystem::path joint_front, joint_rear;
  bool stands_on_joints = false;         ///< the vehicle does not stand alone: bogies of its joints carry it
  bool is_joint = false;                 ///< these are the data of a joint (joint_file.hpp)
  std::optional<CoachParameters> coach;  ///< of the template "two-bogie"
  VehicleDescription parts;              ///< all bodies and force elements, nothing held
  /// Sentences on what is not linear: the force elements, linear elements that stand in for others in any run, and what
  /// ForceElementChoice::linear makes of the former, which it runs by stand-ins or leaves out.
  std::vector<std::string> nonlinear, stand_ins, linearised, left_out;
  SourcedValues sourced;
  std::vector<StatedCheck> checks;
};

/// Vertical data have no longitudinal stiffness: x of all bodies is then held too, and the vertical plane is z and
/// pitch.
/// @throws InputError where the data are vertical and `plane` is not
/// @param choice of force elements; natural motions are those of the linear ones
[[nodiscard]] VehicleModel build_vehicle(const VehicleData& data, MotionPlane plane, const VehicleWeight& weight = {},
                                         ForceElementChoice choice = ForceElementChoice::linear);

/// A stated check with what the vehicle has.
struct ClosingCheck {
  StatedCheck stated;
  std::optional<double> found;  ///< none: the vehicle has no such motion
  [[nodiscard]] bool holds() const noexcept { return found && *found >= stated.low && *found <= stated.high; }
};
[[nodiscard]] std::vector<ClosingCheck> closing_checks(const VehicleData& data);

/// @throws InputError naming the first check that does not hold
void require_closing(const VehicleData& data);

}  // namespace railtab
