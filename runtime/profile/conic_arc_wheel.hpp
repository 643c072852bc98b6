#pragma once

#include <vector>

#include "railtab/runtime/profile/profile_segments.hpp"

namespace railtab {

/// Stand-in for the conic-arc wheel of Shinkansen trains, for which no drawing was at hand: cone 1:40 through the
/// tape circle, root R14, flank of 70 degrees 10 mm below the tape circle at y = -37.5 mm, flange 30 mm high with R12
/// at its tip and one arc to the vertical back at y = -70 mm, tangent at every joint; to y = 60 mm, without chamfer.
[[nodiscard]] std::vector<ProfileSegment> conic_arc_stand_in_segments();

}  // namespace railtab
