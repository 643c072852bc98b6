#pragma once

#include <functional>
#include <string>
#include <vector>

#include "railtab/runtime/profile/profile_curve.hpp"

namespace railtab {

/// One smooth piece of a profile's definition: position and its first two derivatives over a parameter u in [0, 1]
/// (lengths in m, derivatives per unit of u). Runs towards the field side.
using ProfileSegment = std::function<CurvePoint(double u)>;

struct ProfilePoint {
  double y, z;  ///< [m]
};

/// Straight line from one point to the other.
[[nodiscard]] ProfileSegment straight_segment(ProfilePoint from, ProfilePoint to);

/// Circular arc centre + radius (sin phi, cos phi); phi in rad from the +z axis towards +y, in either sense.
[[nodiscard]] ProfileSegment arc_segment(ProfilePoint centre, double radius, double phi_begin, double phi_end);

/// Value and first two derivatives of z(y); y and z in m.
struct GraphPoint {
  double z, dz, ddz;
};

/// Graph z(y) from y_begin to y_end [m].
[[nodiscard]] ProfileSegment graph_segment(std::function<GraphPoint(double y)> z, double y_begin, double y_end);

/// Splines a chain of segments, each on its own over arc length with its exact end tangents: curvature is continuous
/// within a segment and may jump at the joints, position and tangent are continuous everywhere.
/// Knots are added until the spline is within 1e-12 m of the segment and its curvature within 1e-4 relative.
/// The ends of neighbouring segments have to agree to 1e-12 m and 1e-7 rad; a joint takes their mean.
[[nodiscard]] ProfileKnots spline_segments(ProfileKind kind, std::string name,
                                           const std::vector<ProfileSegment>& segments);

}  // namespace railtab
