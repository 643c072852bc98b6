#pragma once

#include <vector>

#include "railtab/runtime/profile/profile_segments.hpp"

namespace railtab {

/// A wheel of the type LMA of Chinese high-speed trains: tip R12 - R15 - root R14 - R90 - R450 - 1:40 - R50 - 1:15,
/// tangent at every joint, from the vertical tangent of the flange's back to y = 60 mm, without chamfer; z = 0 at the
/// tape circle. Radii and joints are fitted to published points (residuals up to 0.003 mm on the arcs). The published
/// LMA is reported to have a flank of 70 degrees; these points have none between R14 and R15, which meet at 82.4
/// degrees: hence "type".
[[nodiscard]] std::vector<ProfileSegment> lma_type_segments();

}  // namespace railtab
