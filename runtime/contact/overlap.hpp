#pragma once

#include <Eigen/Core>

#include "railtab/runtime/contact/contact_pair.hpp"

namespace railtab {

/// A point of the wheel's silhouette held against the rail.
struct OverlapPoint {
  double s_wheel;      ///< arc length on the wheel profile [m]
  double s_rail;       ///< of the rail point whose normal passes through it [m]
  double penetration;  ///< depth below the rail along that normal [m]
  double slope;        ///< d penetration / d s_wheel [-]
  double y, z;         ///< of the silhouette, rail-head frame [m]
};

/// Area between the profiles above a level of penetration, seen along the rail.
struct OverlapArea {
  double area = 0.0;    ///< integral of penetration - level across the contact [m²]
  double moment = 0.0;  ///< the same, times the distance from the patch along the wheel profile [m³]
};

/// One side of an overlap on which a level of penetration is looked for.
struct OverlapFlank {
  const ContactPatch* patch;  ///< from here outward penetration falls
  double limit;               ///< arc length on the wheel profile at which the search ends, on that side [m]
  bool searched = true;       ///< otherwise the overlap ends at the limit, whatever it has there
};

/// Arc lengths on the wheel profile [m].
struct OverlapEnds {
  double low, high;
};

/// The overlap of one (right) wheel with its rail at a pose, seen along the wheel profile. Refers to its pair.
/// Allocation-free, thread-safe.
class Overlap {
 public:
  Overlap(const WheelRailPair& pair, const WheelsetPose& pose) noexcept
      : pair_(pair), pose_(pose), trigonometry_(pose), centre_(wheelset_centre(pair, pose)) {}

  /// @param s_rail a rail point near by, where the search for the rail's normal starts
  [[nodiscard]] OverlapPoint at(double s_wheel, double s_rail) const noexcept;

  /// The saddle between two neighbouring patches (left: smaller y_rail): where penetration along the wheel profile
  /// between them is least. Not positive penetration: the patches are apart.
  [[nodiscard]] OverlapPoint saddle(const ContactPatch& left, const ContactPatch& right) const noexcept;

  /// Where penetration has fallen to `level` [m] on either side: arc lengths on the wheel profile [m]. Where it is
  /// above the level as far as the limit, that is the limit.
  [[nodiscard]] OverlapEnds ends(double level, const OverlapFlank& low, const OverlapFlank& high) const noexcept;

  /// Area where penetration exceeds `level` [m] over s_low..s_high on the wheel profile near the patch: the integral
  /// over the arc length, times the silhouette's chord per arc length.
  [[nodiscard]] OverlapArea area(const ContactPatch& patch, double level, double s_low, double s_high) const noexcept;

  /// The geometry of the pair at wheel point s_wheel near a patch and the rail point whose normal passes through it;
  /// penetration is that of the point.
  [[nodiscard]] ContactPatch pair_at(const ContactPatch& patch, double s_wheel) const noexcept;

 private:
  struct PointLanes;
  /// The same at eight points: penetration, y and z. Where there is no silhouette, far outside the rail.
  [[nodiscard]] PointLanes at(const Eigen::Array<double, 8, 1>& s_wheel,
                              Eigen::Array<double, 8, 1> s_rail) const noexcept;

  const WheelRailPair& pair_;
  WheelsetPose pose_;
  PoseTrigonometry trigonometry_;
  WheelsetCentre centre_;
};

}  // namespace railtab
