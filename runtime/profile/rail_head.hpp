#pragma once

#include <vector>

#include "railtab/runtime/profile/profile_segments.hpp"

namespace railtab {

/// A rail head of three arcs and a flank on each side of its axis, tangent at every joint: crown, shoulder, corner.
struct RailHead {
  double crown_radius, shoulder_radius, corner_radius;  ///< [m]
  double crown_end, shoulder_end;                       ///< |y| of the upright head at the joints [m]
  double flank_slope;                                   ///< dy/dz of the flank [-]
  double flank_depth;                                   ///< end of the flanks below the crown [m]
};

/// 60E1 (UIC 60) [EN13674-1]: R300 - R80 - R13 - flank 1:20, joints at 10.500 mm and 25.988 mm: the variant of the
/// Manchester contact benchmark and of UIC 519. (The values 10.228 and 26.0265 differ from it by at most 0.039 mm.)
inline constexpr RailHead rail_60e1{0.300, 0.080, 0.013, 10.500e-3, 25.988e-3, 1.0 / 20.0, 37.5e-3};

/// CHN60: the same radii, joints at 10.03 mm and 25.33 mm, head 70.8 mm wide: fitted to published points within
/// 0.0021 mm.
inline constexpr RailHead rail_chn60{0.300, 0.080, 0.013, 10.03e-3, 25.33e-3, 1.0 / 20.0, 37.5e-3};

/// Stand-in for the Japanese 60 kg rail, for which no drawing was at hand: R600 - R50 - R13 and a head 65 mm wide at
/// 14 mm below the crown; the joints at 10 mm and 23.145 mm and the flanks 1:20 are chosen so that the chain closes.
inline constexpr RailHead rail_jis60_stand_in{0.600, 0.050, 0.013, 10.0e-3, 23.145e-3, 1.0 / 20.0, 37.5e-3};

/// Head of a right rail leaning to the track centre by atan(inclination), origin at its highest point.
/// @param inclination tangent [-], from 0 to 0.1
[[nodiscard]] std::vector<ProfileSegment> rail_head_segments(const RailHead& head, double inclination);

}  // namespace railtab
