#pragma once

#include "railtab/runtime/profile/profile_curve.hpp"

namespace railtab {

/// Dimensions that place a wheelset on a track. All lengths in m.
struct PairDimensions {
  double track_gauge = 1.435;     ///< between the gauge points, range (0.5, 2)
  double gauge_height = 0.014;    ///< depth of the gauge points below the rail-head tops, range [0, 0.05)
  double flange_back = 1.360;     ///< between the wheels' flange backs, range (0.4, 2)
  double nominal_radius = 0.460;  ///< wheel radius at the tape circle, range (0.1, 1)

  /// Distance of the flange back from the tape circle: wheel profiles have their flange back at y = -0.070.
  static constexpr double tape_circle_to_flange_back = 0.070;

  /// @throws InputError naming the first member out of its range.
  void validate() const;
};

/// Track gauge at which the origin of the rail profile lies at rail_offset from the track centre [m].
/// @throws InputError where the rail has no gauge point at the gauge height
[[nodiscard]] double track_gauge(const ProfileCurve& rail, double rail_offset, double gauge_height);

/// A right wheel on a right rail: the pair of contact search and tables. The left side is its mirror image.
class WheelRailPair {
 public:
  /// @throws InputError where a dimension is out of range, a profile has the wrong kind, or the rail has no
  ///         gauge point at the gauge height.
  WheelRailPair(ProfileCurve wheel, ProfileCurve rail, PairDimensions dimensions);

  [[nodiscard]] const ProfileCurve& wheel() const noexcept { return wheel_; }
  [[nodiscard]] const ProfileCurve& rail() const noexcept { return rail_; }
  [[nodiscard]] const PairDimensions& dimensions() const noexcept { return dimensions_; }
  [[nodiscard]] double nominal_radius() const noexcept { return dimensions_.nominal_radius; }

  /// Axial distance of the tape circle from the wheelset centre [m].
  [[nodiscard]] double tape_circle_offset() const noexcept { return tape_circle_offset_; }
  /// Lateral distance of the rail-head origin from the track centre [m]: half the gauge plus the distance
  /// of the gauge point from the rail origin.
  [[nodiscard]] double rail_offset() const noexcept { return rail_offset_; }

 private:
  ProfileCurve wheel_;
  ProfileCurve rail_;
  PairDimensions dimensions_;
  double tape_circle_offset_ = 0.0;
  double rail_offset_ = 0.0;
};

}  // namespace railtab
