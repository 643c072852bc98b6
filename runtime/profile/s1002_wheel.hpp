#pragma once

#include <vector>

#include "railtab/runtime/profile/profile_segments.hpp"

namespace railtab {

/// Zones H to A of the S1002 wheel profile, from the flange back (y = -70 mm) to the field side (y = 60 mm), without
/// the chamfer: [EN13715], coefficients in ten digits as in UIC 510-2. z = 0 at the tape circle.
///
/// The published constants leave steps at the joints: 37 nm and 118 nm in z at B/C and C/D, 3e-6 and 8e-6 in slope,
/// less than 0.1 nm and 1e-8 elsewhere. Left open they are local minima of the distance to a rail. Zone C is bent by
/// the cubic that takes up both its steps (at most 118 nm, 2e-4 of its curvature), zones A and E to H are shifted
/// vertically by at most 0.1 nm; B and D stand as published.
[[nodiscard]] std::vector<ProfileSegment> s1002_segments();

}  // namespace railtab
