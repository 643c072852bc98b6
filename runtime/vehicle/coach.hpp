#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "railtab/runtime/vehicle/vehicle_model.hpp"

namespace railtab {

/// Mass and moments of inertia about x, y, z through the centre of gravity.
struct BodyInertia {
  double mass;        ///< [kg]
  double Jx, Jy, Jz;  ///< [kg m²]
};

/// Linear stiffness and damping of one suspension unit along x, y, z.
struct SuspensionUnit {
  double kx, ky, kz;  ///< [N/m]
  double cx, cy, cz;  ///< [N s/m]
};

/// A two-bogie coach: seven rigid bodies. "Per box" = per axle box, "per side" = per bogie side. The defaults are the
/// passenger coach of the Manchester benchmarks [Iwnicki1998]; its lateral stop, traction rod and the series stiffness
/// of its dampers are left out (docs/theory/vehicle.md). Heights are above the rail-head tops.
struct CoachParameters {
  std::string name = "manchester-coach";
  BodyInertia wheelset{1813.0, 1120.0, 112.0, 1120.0};
  BodyInertia bogie{2615.0, 1722.0, 1476.0, 3067.0};
  BodyInertia car_body{32000.0, 56800.0, 1.97e6, 1.97e6};
  SuspensionUnit primary{31.391e6, 3.884e6, 1.220e6, 15e3, 2e3, 4e3};    ///< per box
  SuspensionUnit secondary{0.160e6, 0.160e6, 0.430e6, 0.0, 32e3, 20e3};  ///< per side
  double secondary_bending = 10.5e3;     ///< per side, about x and about y [N m/rad], >= 0
  double roll_bar = 0.94e6;              ///< per bogie, about x [N m/rad], >= 0
  double half_wheelbase = 1.28;          ///< of a bogie [m]
  double half_bogie_distance = 9.5;      ///< [m]
  double primary_half_distance = 1.0;    ///< track centre to axle box spring [m]
  double secondary_half_distance = 1.0;  ///< track centre to secondary spring [m]
  double car_body_height = 1.8;          ///< of the centre of gravity [m]
  double secondary_height = 0.8275;      ///< of the middle of the secondary spring [m]
  double bogie_height = 0.6;             ///< of the centre of gravity [m]
  double nominal_radius = 0.46;          ///< wheel radius, and height of the axle [m]
  double length = 26.4;                  ///< over couplers [m]
  void validate() const;                 ///< @throws InputError
};

/// Names of the published vehicles, and a vehicle by name. @throws InputError with the known names.
[[nodiscard]] std::vector<std::string> vehicle_names();
[[nodiscard]] CoachParameters coach_parameters(std::string_view name);

/// Bodies in the order car-body, bogie-1, bogie-2 (front first), wheelset-1 … wheelset-4. The car body's x is held:
/// 41 dofs, or 16 where only the vertical plane is built: x, z and pitch, the wheelsets' rotation left out, which no
/// spring and no rail turns there. Its vertical motion is that of the 41 while nothing acts out of the plane.
/// @throws InputError
[[nodiscard]] VehicleModel build_coach(const CoachParameters& parameters, MotionPlane plane = MotionPlane::spatial,
                                       const VehicleWeight& weight = {});

}  // namespace railtab
