#pragma once

#include "railtab/runtime/contact/contact_patch.hpp"
#include "railtab/runtime/contact/wheel_silhouette.hpp"
#include "railtab/runtime/profile/wheel_rail_pair.hpp"

namespace railtab {

enum class PairStatus : std::uint8_t { converged, not_converged, off_profile, not_a_minimum };

/// A pair of points by their arc lengths on the profiles [m].
struct PairPosition {
  double s_wheel, s_rail;
};

/// Where Newton's method ends.
struct PairLimits {
  int iterations = 12;
  double tolerance = 1e-13;  ///< of the step [m]
};

/// How Newton's method ended.
struct PairOutcome {
  PairStatus status = PairStatus::not_converged;
  int iterations = 0;
  double residual = 0.0;  ///< size of the last step [m]
};

struct RefinedPair : PairOutcome {
  ContactPatch patch;
};

/// Newton's method for the common normal of wheel and rail at a pose (common_normal.hpp), from a starting pair. The
/// kernel that tables, online search and the contact force share. It needs first and second derivatives of the profiles
/// only and holds a step to 1 mm. Allocation-free, thread-safe. The pair returned is within the tolerance of the last
/// iterate; the penetration's error is of its square.
///
/// `not_a_minimum`: the pair found is a maximum or saddle of the distance: the relative curvature
/// kappa_r/(1 - kappa_r d) + kappa_w is not positive. `off_profile`: the pair lies beyond an end of a profile.
/// `not_converged`: no common normal within the iterations, or the silhouette does not exist there; patch is void.
[[nodiscard]] RefinedPair refine_pair(const WheelRailPair& pair, const WheelsetPose& pose, const PoseTrigonometry& trig,
                                      const PairPosition& start, const PairLimits& limits = {}) noexcept;

/// refine_pair() for a start that is nearly right already, the table's: where a Newton step is below 20 µm and stays on
/// the same pieces of both profiles, it is applied to the curves' cubics instead of being evaluated again. The pair's
/// error is of the square of that step times the relative change of curvature, a nanometre as a rule; the penetration,
/// stationary there, is exact to rounding. A step across a joint of a profile is evaluated again.
/// @param patch set where the result is `converged`, void otherwise
[[nodiscard]] PairStatus polish_pair(const WheelRailPair& pair, const WheelsetCentre& centre,
                                     const PoseTrigonometry& trig, const PairPosition& start,
                                     ContactPatch& patch) noexcept;

/// The geometry of a given pair as it stands: penetration is the wheel point's depth along the rail point's normal.
/// The silhouette must exist there.
[[nodiscard]] ContactPatch patch_of_pair(const WheelRailPair& pair, const WheelsetPose& pose,
                                         const PoseTrigonometry& trig, const PairPosition& at) noexcept;

/// A wheel that just touches the rail, on one local minimum of the vertical gap at fixed lateral shift, roll and yaw.
struct TouchPoint {
  double z_touch = 0.0;        ///< z of the pose [m]
  double s_wheel = 0.0;        ///< arc length on the wheel profile [m]
  double s_rail = 0.0;         ///< arc length on the rail profile [m]
  double z_touch_dy = 0.0;     ///< d z_touch / d pose.y = tan(contact angle), exact [-]
  double s_wheel_dy = 0.0;     ///< d s_wheel / d pose.y, by the implicit function theorem [-]
  double s_rail_dy = 0.0;      ///< d s_rail / d pose.y, likewise [-]
  double z_touch_droll = 0.0;  ///< d z_touch / d pose.roll, exact [m/rad]
};

struct RefinedTouch : PairOutcome {
  TouchPoint touch;
};

/// The geometry of a given touching pair as it stands (y_wheel = y_rail, common tangent). pose.z is not used.
[[nodiscard]] TouchPoint touch_of_pair(const WheelRailPair& pair, const WheelsetPose& pose,
                                       const PoseTrigonometry& trig, const PairPosition& at) noexcept;

/// As refine_pair(), for a touching wheel (common_tangent() in common_normal.hpp). pose.z is not used.
[[nodiscard]] RefinedTouch refine_touch(const WheelRailPair& pair, const WheelsetPose& pose,
                                        const PoseTrigonometry& trig, const PairPosition& start,
                                        const PairLimits& limits = {}) noexcept;

}  // namespace railtab
