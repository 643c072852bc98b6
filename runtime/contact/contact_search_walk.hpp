#pragma once

#include "railtab/runtime/contact/contact_pair.hpp"

namespace railtab {

/// Which point of the rail stands opposite a wheel point.
enum class Opposite {
  nearest,   ///< the foot of the common-normal distance: minima of the signed distance
  vertical,  ///< the point below: minima of the vertical gap
};

/// The derivative of the gap along the wheel, but for positive factors, at one wheel point: the tangents' cross product
/// with the opposite rail point. A minimum of the gap is where it rises through zero.
struct GapSlope {
  double s_wheel = 0.0, s_rail = 0.0;
  double s_rail_ds = 0.0;  ///< d s_rail / d s_wheel
  double slope = 0.0;      ///< t_w x t_r
  double slope_ds = 0.0;   ///< d/ds_wheel of it, the opposite point following [1/m]
  bool exists = false;     ///< false where there is no silhouette point or no opposite point on the rail
};

/// A place between two wheel points where the gap's slope rises through zero.
struct GapBracket {
  GapSlope left, right;
  bool found = false;
};

/// The gap's slope along the silhouette of one wheel at one pose.
class GapWalk {
 public:
  GapWalk(const WheelRailPair& pair, const WheelsetPose& pose, const PoseTrigonometry& trig, Opposite opposite) noexcept
      : pair_(pair), trig_(trig), centre_(wheelset_centre(pair, pose)), opposite_(opposite) {}

  [[nodiscard]] SilhouettePoint wheel_point(double s_wheel) const noexcept {
    const CurvePoint wheel = pair_.wheel().at(s_wheel);
    return placed(silhouette_point(wheel, pair_.tape_circle_offset(), pair_.nominal_radius(), trig_), centre_, trig_);
  }

  /// @param S wheel_point(s_wheel)
  /// @param s_rail start of Newton for the opposite point
  [[nodiscard]] GapSlope at(const SilhouettePoint& S, double s_wheel, double s_rail) const noexcept;

  /// A minimum between two neighbours: by the signs of the slope, or, where they are equal, by an extremum of the slope
  /// in between that crosses zero (a minimum and a maximum shortly after their birth).
  [[nodiscard]] GapBracket bracket(const GapSlope& left, const GapSlope& right) const noexcept;

  /// The zero in a bracket by the Illinois method: slow and safe, for where Newton fails.
  [[nodiscard]] GapSlope solve(GapBracket bracket) const noexcept;

 private:
  const WheelRailPair& pair_;
  const PoseTrigonometry& trig_;
  WheelsetCentre centre_;
  Opposite opposite_;
};

}  // namespace railtab
