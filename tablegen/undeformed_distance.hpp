#pragma once

#include <optional>
#include <vector>

#include "railtab/runtime/contact/wheel_silhouette.hpp"
#include "railtab/runtime/profile/wheel_rail_pair.hpp"

namespace railtab {

/// A line along the rail, x = any, at one arc length of the rail profile, and where the wheel is deepest on it.
struct SurfaceLine {
  double s;          ///< arc length on the rail profile [m]
  double y, z;       ///< of the rail's surface, rail-head frame [m]
  double angle;      ///< rotation about x from z to the rail's normal, which points into the rail [rad]
  double x;          ///< where the wheel is deepest, relative to the wheelset centre [m]
  double overlap;    ///< there [m]
  double s_wheel;    ///< arc length on the wheel profile there [m]
  double curvature;  ///< -d²overlap/dx² there, positive [1/m]
};

/// A point of the wheel's surface on the rail's normal through (x, s).
struct OverlapDepth {
  double overlap;  ///< depth of the wheel's surface below the rail's, along the rail's normal; negative: a gap [m]
  double s_wheel;  ///< arc length on the wheel profile [m]
};

/// Undeformed distance of a (right) wheel from its rail in three dimensions: along the normal of the rail, a cylinder
/// along x, to the wheel, a surface of revolution at any pose. Exact for any yaw and roll: the point C(s) + h n(s) at x
/// lies on the wheel where its distance from the axle and its place along it are those of one wheel-profile point,
/// two equations for h and the arc length on the wheel profile, by Newton's method.
/// Refers to its pair. Thread-safe.
class UndeformedDistance {
 public:
  /// Samples the wheel's silhouette, 0.1 mm apart, for starts.
  UndeformedDistance(const WheelRailPair& pair, const WheelsetPose& pose);

  /// @returns nothing where the normal of the rail at s meets no wheel surface that faces it within 5 mm
  [[nodiscard]] std::optional<SurfaceLine> line(double s_rail) const;
  /// The same from a wheel point near by.
  [[nodiscard]] std::optional<SurfaceLine> line(double s_rail, double s_wheel) const;

  /// @param start of a neighbouring point @returns nothing where Newton's method finds no point near the start
  [[nodiscard]] std::optional<OverlapDepth> at(const SurfaceLine& line, double x,
                                               const OverlapDepth& start) const noexcept;

  /// The rail alone: s, y, z and angle; overlap and what follows from the wheel are zero.
  [[nodiscard]] SurfaceLine rail_point(double s_rail) const noexcept;

  [[nodiscard]] const WheelRailPair& pair() const noexcept { return pair_; }

 private:
  struct Sample {
    double s_wheel, y, z, ty, tz;
  };
  [[nodiscard]] std::optional<double> start(const SurfaceLine& line) const noexcept;
  [[nodiscard]] std::optional<SurfaceLine> deepest(SurfaceLine line) const noexcept;

  const WheelRailPair& pair_;
  PoseTrigonometry trigonometry_;
  WheelsetCentre centre_;
  std::vector<Sample> silhouette_;
};

}  // namespace railtab
