#pragma once

#include <vector>

#include "railtab/runtime/contact/contact_patch.hpp"
#include "railtab/runtime/profile/wheel_rail_pair.hpp"

namespace railtab {

/// One connected region in which wheel and rail overlap, in the rail-head frame.
struct OverlapRegion {
  double area;           ///< [m²]
  double y_low, y_high;  ///< extent along the rail head [m]

  [[nodiscard]] double width() const noexcept { return y_high - y_low; }
};

/// The regions in which the wheel's silhouette along the rail overlaps the rail at a pose, both outlines taken as
/// polygons of points `spacing` [m] apart, in increasing y_low. Intersected with exact arithmetic (CGAL): which regions
/// exist does not depend on rounding, on the compiler's options or on the order of the points.
///
/// Independent of the contact search: every region holds at least one of its patches, and every patch that is deeper
/// than the polygons' chords (spacing² times curvature over 8) lies in a region.
/// @throws ComputationError where an outline crosses itself, so that it bounds no body.
[[nodiscard]] std::vector<OverlapRegion> overlap_regions(const WheelRailPair& pair, const WheelsetPose& pose,
                                                         double spacing = 0.1e-3);

}  // namespace railtab
