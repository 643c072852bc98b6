#include "railtab/runtime/profile/lma_type_wheel.hpp"

#include <cmath>
#include <numbers>

#include "railtab/runtime/base/constants.hpp"

namespace railtab {

namespace {

using std::numbers::pi;

// Radii from the flange's back to the field side.
constexpr double tip_arc = 12 * mm, flank = 15 * mm;                              // convex
constexpr double root_arc = 14 * mm, inner_arc = 90 * mm, middle_arc = 450 * mm;  // concave
constexpr double fillet = 50 * mm;                                                // convex, between the two cones
constexpr double cones_meet = 30.0 * mm;                                          // y at which 1:40 and 1:15 intersect
constexpr double outer_end = 60.0 * mm;

/// Direction out of the wheel at a place whose tangent falls by beta from the flange to the field side.
ProfilePoint out(double beta) { return {std::sin(beta), std::cos(beta)}; }

ProfilePoint along(ProfilePoint p, double length, ProfilePoint direction) {
  return {p.y + length * direction.y, p.z + length * direction.z};
}

/// Arc between two tangent angles about a centre inside the wheel, or outside it.
ProfileSegment convex(ProfilePoint centre, double radius, double beta_begin, double beta_end) {
  return arc_segment(centre, radius, beta_begin, beta_end);
}
ProfileSegment concave(ProfilePoint centre, double radius, double beta_begin, double beta_end) {
  return arc_segment(centre, radius, pi + beta_begin, pi + beta_end);
}

}  // namespace

std::vector<ProfileSegment> lma_type_segments() {
  // Tangent angles at the joints, from the fitted centres y = 15.50, -5.503, -24.870, -53.615 and -53.996 mm.
  const double at_cone = std::atan(1.0 / 40.0);
  const double at_edge = std::atan(1.0 / 15.0);
  const double at_middle = std::asin((15.50 + 5.503) * mm / (middle_arc - inner_arc));
  const double at_inner = std::asin((-5.503 + 24.870) * mm / (inner_arc - root_arc));
  const double at_root = std::asin((-24.870 + 53.615) * mm / (root_arc + flank));
  const double at_tip = std::asin((-53.996 + 53.615) * mm / (flank - tip_arc));

  // Centres by tangency, from the R450 to the tip; the R450 passes through the tape circle.
  ProfilePoint centre{15.50 * mm, 0.0};
  centre.z = std::sqrt(middle_arc * middle_arc - centre.y * centre.y);
  std::vector<ProfileSegment> from_field;
  const ProfilePoint cone_begin = along(centre, -middle_arc, out(at_cone));
  from_field.push_back(concave(centre, middle_arc, at_middle, at_cone));
  centre = along(centre, -(middle_arc - inner_arc), out(at_middle));
  from_field.push_back(concave(centre, inner_arc, at_inner, at_middle));
  centre = along(centre, -(inner_arc - root_arc), out(at_inner));
  from_field.push_back(concave(centre, root_arc, at_root, at_inner));
  centre = along(centre, -(root_arc + flank), out(at_root));
  from_field.push_back(convex(centre, flank, at_tip, at_root));
  centre = along(centre, flank - tip_arc, out(at_tip));
  from_field.push_back(convex(centre, tip_arc, -0.5 * pi, at_tip));

  // The two cones and the arc between them, of tangent length R tan(half the angle).
  const double tangent = fillet * std::tan(0.5 * (at_edge - at_cone));
  const ProfilePoint cone{std::cos(at_cone), -std::sin(at_cone)};
  const ProfilePoint edge{std::cos(at_edge), -std::sin(at_edge)};
  const ProfilePoint corner = along(cone_begin, (cones_meet - cone_begin.y) / cone.y, cone);
  const ProfilePoint cone_end = along(corner, -tangent, cone);
  const ProfilePoint edge_begin = along(corner, tangent, edge);
  std::vector<ProfileSegment> segments(from_field.rbegin(), from_field.rend());
  segments.push_back(straight_segment(cone_begin, cone_end));
  segments.push_back(convex(along(cone_end, -fillet, out(at_cone)), fillet, at_cone, at_edge));
  segments.push_back(straight_segment(edge_begin, along(edge_begin, (outer_end - edge_begin.y) / edge.y, edge)));
  return segments;
}

}  // namespace railtab
