#pragma once

#include <span>
#include <vector>

#include "railtab/runtime/contact/contact_patch.hpp"
#include "railtab/runtime/profile/wheel_rail_pair.hpp"

namespace railtab {

/// One connected region in which wheel and rail overlap, in the rail-head frame.
struct OverlapRegion {
  double y_low, y_high;  ///< the outlines' points around it, along the rail head [m]
  double height;         ///< largest vertical overlap [m]
  double depth;          ///< largest overlap along the normal [m]
};

/// The regions in which the wheel's silhouette along the rail overlaps the rail: an account of contacts that shares
/// nothing with the contact search. Outlines are chains of chords, and CGAL's exact predicates say at every point of
/// both whether the wheel is below the rail's surface there: which regions exist does not depend on rounding.
///
/// Outlines are taken as functions of y, the rail's from its top outwards to where its side is vertical.
/// Const, thread-safe.
class OutlineOverlap {
 public:
  static constexpr double chord_error = 2e-9;  ///< of either outline [m]

  explicit OutlineOverlap(const WheelRailPair& pair);

  /// In increasing y, apart from each other.
  [[nodiscard]] std::vector<OverlapRegion> regions(const WheelsetPose& pose) const;

 private:
  struct Point {
    double y, z;
  };
  [[nodiscard]] bool may_overlap(const Point& a, const Point& b) const;
  void sweep(std::span<const Point> wheel, std::vector<OverlapRegion>& found) const;

  WheelRailPair pair_;
  std::vector<CurvePoint> wheel_;  ///< by arc length
  std::vector<Point> rail_;        ///< in increasing y
};

/// Regions against the patches of a search or a table at the same pose: every region holds a patch, and every patch
/// lies in a region. Regions and patches shallower than `band` are beyond the outlines' chords.
struct RegionComparison {
  static constexpr double band = 1e-8;  ///< [m]
  bool in_band = false;                 ///< only shallower ones have no partner
  bool mismatch = false;
  double height = 0.0;  ///< vertical, of the highest region or patch without a partner [m]
};
[[nodiscard]] RegionComparison compare(std::span<const OverlapRegion> regions, const ContactPatches& patches) noexcept;

}  // namespace railtab
