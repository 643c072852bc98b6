#include "railtab/runtime/profile/conic_arc_wheel.hpp"

#include <cmath>
#include <numbers>

#include "railtab/runtime/base/constants.hpp"

namespace railtab {

namespace {

using std::numbers::pi;

constexpr double cone_slope = 1.0 / 40.0;
constexpr double flank_angle = 70.0 * pi / 180.0;
constexpr ProfilePoint flank_point{-37.5 * mm, 10.0 * mm};
constexpr double root_radius = 14 * mm;
constexpr double tip_radius = 12 * mm;
constexpr double flange_height = 30 * mm;
constexpr double back = -70 * mm;
constexpr double field_side = 60 * mm;

double dot(ProfilePoint a, ProfilePoint b) { return a.y * b.y + a.z * b.z; }

}  // namespace

std::vector<ProfileSegment> conic_arc_stand_in_segments() {
  const double cone_angle = std::atan(cone_slope);
  // Directions out of the wheel, on the cone and on the flank.
  const ProfilePoint n_cone{std::sin(cone_angle), std::cos(cone_angle)};
  const ProfilePoint n_flank{std::sin(flank_angle), std::cos(flank_angle)};
  const double flank_distance = dot(flank_point, n_flank);

  // Root: centre R14 outside both lines.
  const double a = root_radius;                   // from the cone through the origin
  const double b = flank_distance + root_radius;  // from the flank
  const double determinant = n_cone.y * n_flank.z - n_cone.z * n_flank.y;
  const ProfilePoint root{(a * n_flank.z - b * n_cone.z) / determinant, (b * n_cone.y - a * n_flank.y) / determinant};
  const ProfilePoint root_on_flank{root.y - root_radius * n_flank.y, root.z - root_radius * n_flank.z};
  const ProfilePoint root_on_cone{root.y - root_radius * n_cone.y, root.z - root_radius * n_cone.z};

  // Tip: R12 inside the flank, as deep as the flange is high; from its lowest point one arc to the back.
  const double tip_z = flange_height - tip_radius;
  const ProfilePoint tip{(flank_distance - tip_radius - tip_z * n_flank.z) / n_flank.y, tip_z};
  const double back_radius = tip.y - back;
  const ProfilePoint flank_begin{tip.y + tip_radius * n_flank.y, tip.z + tip_radius * n_flank.z};
  return {arc_segment({tip.y, flange_height - back_radius}, back_radius, -0.5 * pi, 0.0),
          arc_segment(tip, tip_radius, 0.0, flank_angle), straight_segment(flank_begin, root_on_flank),
          arc_segment(root, root_radius, pi + flank_angle, pi + cone_angle),
          straight_segment(root_on_cone, {field_side, -cone_slope * field_side})};
}

}  // namespace railtab
