#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <optional>

#include "railtab/runtime/contact/contact_geometry.hpp"
#include "railtab/runtime/contact/creep_law.hpp"
#include "railtab/runtime/contact/friction_law.hpp"
#include "railtab/runtime/contact/patch_loads.hpp"

namespace railtab {

using Vector3 = Eigen::Vector3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Vector9 = Eigen::Matrix<double, 9, 1>;
using Matrix9 = Eigen::Matrix<double, 9, 9>;

/// Motion of a wheelset in the track frame, dof order x, y, z, roll, pitch, yaw. Displacement from the nominal position
/// (centred, centre R0 above the rail-head tops); pitch rate is the deviation from the nominal rotation -V/R0 about y.
struct WheelsetMotion {
  Vector6 displacement = Vector6::Zero();
  Vector6 velocity = Vector6::Zero();
};

/// Motion of a rail head where a wheel stands, structure and irregularity together, in the track frame.
struct RailHeadMotion {
  Vector3 displacement = Vector3::Zero();  ///< y, z [m], roll [rad]
  Vector3 velocity = Vector3::Zero();      ///< of the rail's material: y, z [m/s], roll [rad/s]
  double yaw = 0.0;                        ///< slope dy/dx of the rail head [-]
  double slope = 0.0;                      ///< slope dz/dx of the rail head [-]
  double friction = 1.0;                   ///< coefficient of friction there over WheelContactModel::friction [-]
};

/// Semi-axes of a contact patch along (a) and across (b) the rolling direction [m].
struct PatchEllipse {
  double a, b;
};

/// What the lateral component of the normal forces does: it restores a wheelset that shifts. Linear stability theory of
/// conical wheels often leaves it out [MontenegroCalcada2023, section 4.3.3, assumption g].
enum class GravitationalStiffness { included, neglected };

/// Parameters of the contact forces that every wheel shares.
struct WheelContactModel {
  const ContactGeometry* geometry = nullptr;
  NormalContactModel normal;
  CreepLaw creep_law = PolachCreep{};
  double friction = 0.3;  ///< [-]
  double damping = 0.0;   ///< F_n = K_h d^{3/2} (1 + damping·d') [s/m]
  FrictionLaw friction_law;
  double speed = 0.0;  ///< running speed V [m/s], >= 0
  /// Below this speed creepages are relative to it in place of V, so that a train can stand: creep forces at small
  /// creepage are then too small by V over it. > 0 where V can be 0 [m/s].
  double speed_floor = 0.0;
  /// Creepages count by this share, 1 but on the way to a solution (solve_contact_by_continuation).
  double creepage_share = 1.0;
  /// Ellipse of every patch, whatever its load and place (linear stability theory); else Hertz's.
  std::optional<PatchEllipse> constant_ellipse;
  GravitationalStiffness gravitational_stiffness = GravitationalStiffness::included;

  /// What creepages are relative to [m/s].
  [[nodiscard]] double creepage_speed() const noexcept { return std::max(speed, speed_floor) / creepage_share; }
};

/// Forces between one wheel and its rail, in the track frame.
struct WheelForce {
  Vector6 wheelset = Vector6::Zero();  ///< on the wheelset: force, and moment about its centre (pitch: about its axle)
  Vector3 rail = Vector3::Zero();      ///< on the rail head: y, z [N], moment about x through the head's origin [N m]
  double rail_x = 0.0;                 ///< on the rail, longitudinal [N]
  std::array<double, ContactPatches::capacity> normal{};  ///< normal force of each patch [N]
  double creep_power = 0.0;     ///< that the creep forces take from the motion, >= 0 for a law that resists slip [W]
  double pressure = 0.0;        ///< largest normal pressure of the patches [Pa]
  int outside_creep_table = 0;  ///< patches whose creep force the creep table left to Polach, wholly or in part
  /// Share of each patch in (wheelset 6, rail 3); as many as there are patches.
  std::array<Vector9, ContactPatches::capacity> patch;
};

enum class WheelSide { left, right };
inline constexpr std::array<WheelSide, 2> wheel_sides{WheelSide::left, WheelSide::right};

/// Forces of patches at the pose that relative_pose() returns.
/// Normal forces are those of patch_loads() (Eq. 11), creep forces come by the model's law from the relative velocity
/// of the wheel's and the rail's particles where each patch's force acts. Negative contact forces (tension) do not
/// occur.
[[nodiscard]] WheelForce wheel_force(const WheelContactModel& model, WheelSide side, const WheelsetMotion& wheelset,
                                     const RailHeadMotion& rail, const ContactPatches& patches) noexcept;

/// The same from loads that are known: those of patch_loads() at that pose.
[[nodiscard]] WheelForce wheel_force(const WheelContactModel& model, WheelSide side, const WheelsetMotion& wheelset,
                                     const RailHeadMotion& rail, const PatchLoads& loads) noexcept;

/// Pose of the wheelset against the rail head, as seen by a right wheel (mirrored on the left).
[[nodiscard]] WheelsetPose relative_pose(const WheelRailPair& pair, WheelSide side, const WheelsetMotion& wheelset,
                                         const RailHeadMotion& rail) noexcept;

/// The patches at a pose near the one that `patches` were found at: the same pairs moved along by the common-normal
/// Newton (in the published method: frozen pairs, penetration to first order). For derivatives of the force.
[[nodiscard]] ContactPatches moved_patches(const ContactGeometry& geometry, const ContactPatches& patches,
                                           const WheelsetPose& from, const WheelsetPose& to) noexcept;

struct ContactMemory;

/// What a time step does with a displacement: velocities follow it, and the force counts as that of an instant or as
/// the mean over the step.
struct StepRates {
  Vector6 wheelset;                      ///< dv/da per wheelset dof, gamma/(beta dt) [1/s]
  double rail;                           ///< likewise of the rail [1/s]
  const ContactMemory* start = nullptr;  ///< the contact at the start of the step: the force is mean_force()
};

/// Derivative of (wheelset force 6, rail force 3) with respect to (wheelset displacement 6, rail displacement 3) in a
/// time step. By differences of the force itself along the wheelset's motions and the rail's roll; the rail's
/// translations follow, since only relative motion matters, and so do the loads when the rail rolls.
/// @param share of the patches in the contact; those at the start of a mean force have theirs
[[nodiscard]] Matrix9 wheel_force_tangent(const WheelContactModel& model, WheelSide side,
                                          const WheelsetMotion& wheelset, const RailHeadMotion& rail,
                                          const ContactPatches& patches, const StepRates& rates,
                                          double share = 1.0) noexcept;

}  // namespace railtab
