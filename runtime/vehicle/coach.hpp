#pragma once

#include <array>
#include <string>

#include "railtab/runtime/vehicle/vehicle_model.hpp"

namespace railtab {

/// Mass and moments of inertia about x, y, z through the centre of gravity.
struct BodyInertia {
  double mass = 0;                ///< [kg]
  double Jx = 0, Jy = 0, Jz = 0;  ///< [kg m²]
};

/// Stiffness and damping of one suspension unit along x, y, z; series_k in series with the damper, 0: none;
/// couple_share of the second (upper) body in the couple of its preload (Suspension), 0 … 1.
struct SuspensionUnit {
  double kx = 0, ky = 0, kz = 0;                       ///< [N/m]
  double cx = 0, cy = 0, cz = 0;                       ///< [N s/m]
  double series_kx = 0, series_ky = 0, series_kz = 0;  ///< [N/m]
  double couple_share = Suspension{}.couple_share;
  std::array<NonlinearUnit, 3> nonlinear{};  ///< along x, y, z
};

/// A vehicle with two bogies, the template "two-bogie" of vehicle files (docs/file_formats/vehicle.md): car body, two
/// bogies and their wheelsets. "Per box" = per axle box, "per side" = per bogie side. Heights are above the rail-head
/// tops.
struct CoachParameters {
  std::string name;
  BodyInertia wheelset, bogie, car_body;
  SuspensionUnit primary;              ///< per box
  SuspensionUnit secondary;            ///< per side
  double secondary_bending = 0;        ///< per side, about x and about y [N m/rad], >= 0
  double roll_bar = 0;                 ///< per bogie, about x [N m/rad], >= 0
  int axles_per_bogie = 2;             ///< 2 or 3, the third one at the bogie's centre
  double half_wheelbase = 0;           ///< of a bogie, between its outer axles [m]
  double half_bogie_distance = 0;      ///< [m]
  double primary_half_distance = 0;    ///< track centre to axle box spring [m]
  double secondary_half_distance = 0;  ///< track centre to secondary spring [m]
  double car_body_height = 0;          ///< of the centre of gravity [m]
  double secondary_height = 0;         ///< of the middle of the secondary spring [m]
  double bogie_height = 0;             ///< of the centre of gravity [m]
  double nominal_radius = 0;           ///< wheel radius, and height of the axle [m]
  double length = 0;                   ///< over couplers [m]
  void validate() const;               ///< @throws InputError
};

/// Bodies in the order car-body, bogie-1, bogie-2 (front first), wheelset-1 …; nothing held. @throws InputError
[[nodiscard]] VehicleDescription describe_coach(const CoachParameters& parameters);

/// Which motions are degrees of freedom of a run. The car body's x is held; of car bodies that springs along x join,
/// that of the first. The vertical plane has x, z and pitch, the
/// wheelsets' rotation left out, which no spring and no rail turns there; its motion is that of all while nothing acts
/// out of the plane.
[[nodiscard]] std::vector<DofIndices> held_motions(const VehicleDescription& parts, MotionPlane plane);

/// describe_coach() as a model with linear force elements: 41 dofs with four wheelsets, or 16 in the vertical plane.
/// @throws InputError
[[nodiscard]] VehicleModel build_coach(const CoachParameters& parameters, MotionPlane plane = MotionPlane::spatial,
                                       const VehicleWeight& weight = {});

}  // namespace railtab
