#include "railtab/runtime/profile/profile_axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "railtab/runtime/base/constants.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/profile/profile_curve.hpp"

namespace railtab {

namespace {

void mirror_z(ProfilePoints& outline) {
  for (OutlinePoint& p : outline.points) p.z = -p.z;
}

void mirror_y(ProfilePoints& outline) {
  for (OutlinePoint& p : outline.points) p.y = -p.y;
  std::reverse(outline.points.begin(), outline.points.end());
}

std::size_t top_of(const std::vector<OutlinePoint>& points) {
  const auto higher = [](const auto& a, const auto& b) { return a.z < b.z; };
  return static_cast<std::size_t>(std::min_element(points.begin(), points.end(), higher) - points.begin());
}

/// The axes cannot be told from the numbers alone, but a flange shows where z and y point.
void orient_wheel(const std::string& file, ProfilePoints& outline) {
  std::vector<OutlinePoint>& points = outline.points;
  if (!(points.front().y < 0.0 && points.back().y > 0.0)) {
    throw input_error(file,
                      fmt::format("a wheel profile from y = {:.6g} m to {:.6g} m", points.front().y, points.back().y),
                      "one around the tape circle at y = 0");
  }
  const auto deeper = [](const auto& a, const auto& b) { return std::abs(a.z) < std::abs(b.z); };
  const OutlinePoint tip = *std::max_element(points.begin(), points.end(), deeper);
  // A chamfer or a worn tread rises some millimetres, only a flange is this high.
  constexpr double flange = 15 * mm;
  if (std::abs(tip.z) < flange) {
    outline.notes.push_back(
        fmt::format("{}: no flange, {:.3g} mm from the tread at most: no flange contact will be found", file,
                    std::abs(tip.z) / mm));
    return;
  }
  if (tip.z < 0.0) {
    mirror_z(outline);
    outline.notes.push_back(file + ": z mirrored, since the flange points up");
  }
  // The field side of a wheel rises, or has the lip of a hollow tread.
  constexpr double lip = 12 * mm;
  const double top = points[top_of(points)].z, inner = points.front().z - top, outer = points.back().z - top;
  if (std::min(inner, outer) > lip) {
    throw input_error(file,
                      fmt::format("a profile whose sides go down by {:.3g} mm and {:.3g} mm, as those of a rail do",
                                  inner / mm, outer / mm),
                      "a wheel profile, with a flange on one side; are wheel and rail exchanged?");
  }
  if (tip.y > 0.0) {
    mirror_y(outline);
    outline.notes.push_back(file + ": y mirrored, since the flange lies at y > 0");
  }
}

/// y at which an outline is `level` deep, from its top towards one end (step -1 or 1).
std::optional<double> y_at_level(const std::vector<OutlinePoint>& points, double level, int step) {
  for (auto i = static_cast<std::ptrdiff_t>(top_of(points));; i += step) {
    const std::ptrdiff_t next = i + step;
    if (next < 0 || next >= static_cast<std::ptrdiff_t>(points.size())) return std::nullopt;
    const OutlinePoint& a = points[static_cast<std::size_t>(i)];
    const OutlinePoint& b = points[static_cast<std::size_t>(next)];
    if (a.z < level && b.z >= level) return a.y + (b.y - a.y) * (level - a.z) / (b.z - a.z);
  }
}

/// Says where the head stands against its highest point, by the middle of its sides.
/// @throws InputError: the head is narrow and the outline wide, as of a wheel with its flange upwards
void note_lean(const std::string& file, ProfilePoints& outline) {
  constexpr double depth = 10 * mm;
  const OutlinePoint top = outline.points[top_of(outline.points)];
  const auto gauge = y_at_level(outline.points, top.z + depth, -1);
  const auto field = y_at_level(outline.points, top.z + depth, 1);
  if (!field) {
    outline.notes.push_back(
        fmt::format("{}: the field side ends {:.3g} mm below the top: no contact will be found beyond", file,
                    (outline.points.back().z - top.z) / mm));
  }
  if (!gauge || !field) return;
  const double head = *field - *gauge, width = outline.points.back().y - outline.points.front().y;
  constexpr double foot = 2.5;  // times the head's width: more than a rail with its foot has
  if (width > foot * head) {
    throw input_error(file,
                      fmt::format("a profile {:.3g} mm wide of which {:.3g} mm stand up, as the flange of a wheel does",
                                  width / mm, head / mm),
                      "a rail profile; are wheel and rail exchanged?");
  }
  const double middle = 0.5 * (*gauge + *field) - top.y;
  if (middle > 3 * mm) {
    outline.notes.push_back(
        fmt::format("{}: the head leans to the field side (its middle {:.1f} mm beyond its top): is y mirrored?", file,
                    middle / mm));
  } else if (std::abs(middle) < 1 * mm) {
    outline.notes.push_back(file + ": the head stands upright; a rail from a file is not inclined further");
  }
}

/// Continues a gauge face that was not measured deep enough.
void extend_gauge_face(const std::string& file, ProfilePoints& outline) {
  constexpr double least = 10 * mm;
  constexpr double wanted = 17 * mm;
  constexpr double enough = 14.1 * mm;  // the usual gauge height
  constexpr double step = 0.5 * mm;
  std::vector<OutlinePoint>& points = outline.points;
  const double top = points[top_of(points)].z;
  const OutlinePoint end = points.front();
  if (end.z - top < least || end.z - top >= enough) return;
  // Slope dy/dz at the end: that of the last millimetre's halves, extrapolated.
  const auto inwards = [&](double distance) {
    return std::find_if(points.begin() + 1, points.end(),
                        [&](const OutlinePoint& p) { return std::hypot(p.y - end.y, p.z - end.z) >= distance; });
  };
  const auto near = inwards(step);
  const auto far = inwards(2 * step);
  if (far == points.end() || !(end.z > near->z && near->z > far->z)) return;
  const double outer = (end.y - near->y) / (end.z - near->z);
  const double inner = (near->y - far->y) / (near->z - far->z);
  const double slope = 1.5 * outer - 0.5 * inner;
  constexpr double tan30 = 0.5773502691896258;
  if (std::abs(slope) > tan30) return;
  std::vector<OutlinePoint> face;
  for (double z = top + wanted; z > end.z + 0.5 * step; z -= step)
    face.push_back({end.y + slope * (z - end.z), z, end.line});
  points.insert(points.begin(), face.begin(), face.end());
  outline.notes.push_back(
      fmt::format("{}:{}: the gauge face ends {:.3g} mm below the top, continued straight to {:.3g} mm", file, end.line,
                  (end.z - top) / mm, wanted / mm));
}

bool is_tall(const std::vector<OutlinePoint>& points) {
  const auto [y0, y1] = std::minmax_element(points.begin(), points.end(), [](auto& a, auto& b) { return a.y < b.y; });
  const auto [z0, z1] = std::minmax_element(points.begin(), points.end(), [](auto& a, auto& b) { return a.z < b.z; });
  return z1->z - z0->z > y1->y - y0->y;
}

void orient_rail(const std::string& file, ProfilePoints& outline) {
  const auto interior = [&](std::size_t i) { return i > 0 && i + 1 < outline.points.size(); };
  if (!interior(top_of(outline.points))) {
    mirror_z(outline);
    const std::size_t top = top_of(outline.points);
    const double side = std::max(outline.points.front().z, outline.points.back().z) - outline.points[top].z;
    // The sides of a head go down by some millimetres at least; a piece of a crown could be either way up.
    constexpr double sides = 3 * mm;
    if (!interior(top) || side < sides) {
      throw input_error(file, "a rail profile whose highest point is one of its ends",
                        fmt::format("z positive downwards and points on both sides of the head's top{}",
                                    is_tall(outline.points) ? "; are y and z exchanged?" : ""));
    }
    outline.notes.push_back(file + ": z mirrored, since the sides of the head point up");
  }
  extend_gauge_face(file, outline);
  note_lean(file, outline);
}

}  // namespace

void orient(const std::string& file, ProfileKind kind, ProfilePoints& outline) {
  // Some programs list wheels from the field side, so that the material lies on the right: the same curve.
  if (outline.points.front().y > outline.points.back().y) std::reverse(outline.points.begin(), outline.points.end());
  kind == ProfileKind::wheel ? orient_wheel(file, outline) : orient_rail(file, outline);
}

void centre_rail(const std::string& file, ProfileKnots& knots) {
  const ProfileCurve curve(knots);
  const double s = curve.s_at_highest_point();
  if (!(s > curve.s_begin() && s < curve.s_end())) {
    throw input_error(file, "a rail profile whose highest point is one of its ends",
                      "z positive downwards and points on both sides of the head's top");
  }
  const CurvePoint top = curve.at(s);
  for (double& y : knots.y) y -= top.y;
  for (double& z : knots.z) z -= top.z;
}

}  // namespace railtab
