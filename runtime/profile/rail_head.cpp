#include "railtab/runtime/profile/rail_head.hpp"

#include <cmath>
#include <numbers>

namespace railtab {

namespace {

/// The upright head's field half as a tangent chain: theta is the tangent's angle below +y, so that a point of an arc
/// is its centre + R (sin theta, -cos theta). The gauge half is its mirror image.
struct UprightHead {
  double theta_crown, theta_shoulder, theta_flank;  ///< tangent angle at the end of each arc [rad]
  ProfilePoint crown, shoulder, corner;             ///< centres, field side [m]
  ProfilePoint flank_top, flank_end;                ///< upper and lower end of the flank, field side [m]
};

UprightHead upright_head(const RailHead& head) {
  UprightHead h{};
  h.crown = {0.0, head.crown_radius};
  h.theta_crown = std::asin(head.crown_end / head.crown_radius);
  // Tangent arcs have their centres on the normal at the joint.
  const double inside = head.crown_radius - head.shoulder_radius;
  h.shoulder = {inside * std::sin(h.theta_crown), h.crown.z - inside * std::cos(h.theta_crown)};
  h.theta_shoulder = std::asin((head.shoulder_end - h.shoulder.y) / head.shoulder_radius);
  const double step = head.shoulder_radius - head.corner_radius;
  h.corner = {h.shoulder.y + step * std::sin(h.theta_shoulder), h.shoulder.z - step * std::cos(h.theta_shoulder)};
  h.theta_flank = std::atan2(1.0, head.flank_slope);
  h.flank_top = {h.corner.y + head.corner_radius * std::sin(h.theta_flank),
                 h.corner.z - head.corner_radius * std::cos(h.theta_flank)};
  h.flank_end = {h.flank_top.y + head.flank_slope * (head.flank_depth - h.flank_top.z), head.flank_depth};
  return h;
}

/// Rotation of the upright right rail by alpha, the top towards the track centre (-y), then a shift of the origin.
struct Inclination {
  double alpha;         ///< [rad]
  ProfilePoint origin;  ///< rotated position of the new origin [m]

  [[nodiscard]] ProfilePoint operator()(ProfilePoint p) const {
    const double c = std::cos(alpha);
    const double s = std::sin(alpha);
    return {p.y * c + p.z * s - origin.y, -p.y * s + p.z * c - origin.z};
  }
  /// Arc from tangent angle theta_begin to theta_end on the upright head.
  [[nodiscard]] ProfileSegment arc(ProfilePoint centre, double radius, double theta_begin, double theta_end) const {
    using std::numbers::pi;
    return arc_segment((*this)(centre), radius, pi - (theta_begin - alpha), pi - (theta_end - alpha));
  }
};

ProfilePoint mirrored(ProfilePoint p) { return {-p.y, p.z}; }

/// Highest point of the rotated head: where the upright head's tangent angle is alpha.
ProfilePoint highest_point(const RailHead& head, const UprightHead& h, const Inclination& rotate) {
  const bool on_crown = rotate.alpha <= h.theta_crown;
  const ProfilePoint centre = rotate(on_crown ? h.crown : h.shoulder);
  return {centre.y, centre.z - (on_crown ? head.crown_radius : head.shoulder_radius)};
}

}  // namespace

std::vector<ProfileSegment> rail_head_segments(const RailHead& head, double inclination) {
  const UprightHead h = upright_head(head);
  Inclination place{std::atan(inclination), {0, 0}};
  place.origin = highest_point(head, h, place);
  return {straight_segment(place(mirrored(h.flank_end)), place(mirrored(h.flank_top))),
          place.arc(mirrored(h.corner), head.corner_radius, -h.theta_flank, -h.theta_shoulder),
          place.arc(mirrored(h.shoulder), head.shoulder_radius, -h.theta_shoulder, -h.theta_crown),
          place.arc(h.crown, head.crown_radius, -h.theta_crown, h.theta_crown),
          place.arc(h.shoulder, head.shoulder_radius, h.theta_crown, h.theta_shoulder),
          place.arc(h.corner, head.corner_radius, h.theta_shoulder, h.theta_flank),
          straight_segment(place(h.flank_top), place(h.flank_end))};
}

}  // namespace railtab
