#pragma once

#include <vector>

#include "profile_segments.hpp"

namespace railtab {

/// Head of the right rail 60E1 (UIC 60) leaning to the track centre by atan(inclination), origin at its highest point:
/// R300 - R80 - R13 - flank 1:20 on both sides, tangent at every joint [EN13674-1], flanks down to 37.5 mm below the
/// crown. The R300 ends 10.500 mm and the R80 ends 25.988 mm from the head's axis: the variant of the Manchester
/// contact benchmark and of UIC 519. (The values 10.228 and 26.0265 differ from it by at most 0.039 mm.)
/// @param inclination tangent [-], from 0 to 0.1
[[nodiscard]] std::vector<ProfileSegment> rail_60e1_segments(double inclination);

}  // namespace railtab
