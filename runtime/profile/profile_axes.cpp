#include "railtab/runtime/profile/profile_axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
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

/// The first point of a range after which the outline is not steeper than 80 degrees over a millimetre: beyond the face
/// of a rim at its beginning, which may be higher than the flange, whose flank reaches 75 degrees.
template <class Point>
Point end_of_face(Point begin, Point end) {
  constexpr double length = 1 * mm;  // far more than points scatter by
  constexpr double tan80 = 5.671281819617709;
  for (; begin != end; ++begin) {
    const auto next = std::find_if(
        begin, end, [&](const OutlinePoint& p) { return std::hypot(p.y - begin->y, p.z - begin->z) >= length; });
    if (next == end || std::abs(next->z - begin->z) < tan80 * std::abs(next->y - begin->y)) break;
  }
  return begin;
}

bool deeper(const OutlinePoint& a, const OutlinePoint& b) { return std::abs(a.z) < std::abs(b.z); }

/// The deepest point between the faces of the rim.
OutlinePoint flange_tip(const std::vector<OutlinePoint>& points) {
  const auto begin = end_of_face(points.begin(), points.end());
  const auto end = end_of_face(points.rbegin(), std::make_reverse_iterator(begin)).base();
  return *std::max_element(begin, end, deeper);
}

/// The field side of a wheel rises, or has the lip of a hollow tread.
/// @param down 1 or -1: where z points
void reject_rail(const std::string& file, const std::vector<OutlinePoint>& points, double down) {
  constexpr double lip = 12 * mm;
  const auto higher = [&](const auto& a, const auto& b) { return down * a.z < down * b.z; };
  const double top = std::min_element(points.begin(), points.end(), higher)->z;
  const double inner = down * (points.front().z - top), outer = down * (points.back().z - top);
  if (std::min(inner, outer) <= lip) return;
  throw input_error(file,
                    fmt::format("a profile whose sides go down by {:.3g} mm and {:.3g} mm, as those of a rail do",
                                inner / mm, outer / mm),
                    "a wheel profile, with a flange on one side; are wheel and rail exchanged?");
}

/// The axes cannot be told from the numbers alone, but a flange shows where z and y point.
void orient_wheel(const std::string& file, ProfilePoints& outline) {
  std::vector<OutlinePoint>& points = outline.points;
  if (!(points.front().y < 0.0 && points.back().y > 0.0)) {
    throw input_error(file,
                      fmt::format("a wheel profile from y = {:.6g} m to {:.6g} m", points.front().y, points.back().y),
                      "one around the tape circle at y = 0");
  }
  const OutlinePoint tip = flange_tip(points);
  // A chamfer or a worn tread rises some millimetres, only a flange is this high.
  constexpr double flange = 15 * mm;
  if (std::abs(tip.z) < flange) {
    // The sides of a rail are as steep as the faces of a rim.
    reject_rail(file, points, std::max_element(points.begin(), points.end(), deeper)->z < 0.0 ? -1.0 : 1.0);
    outline.notes.push_back(
        fmt::format("{}: no flange, {:.3g} mm from the tread at most: no flange contact will be found", file,
                    std::abs(tip.z) / mm));
    return;
  }
  if (tip.z < 0.0) {
    mirror_z(outline);
    outline.notes.push_back(file + ": z mirrored, since the flange points up");
  }
  reject_rail(file, points, 1.0);
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

struct Circle {
  double y, z, radius;
};

/// The circle with the least sum of squares of (distance from the centre)² - radius²: exact for points on a circle.
std::optional<Circle> circle_through(const OutlinePoint* begin, const OutlinePoint* end) {
  const auto count = static_cast<double>(end - begin);
  double mean_y = 0.0, mean_z = 0.0;
  for (const OutlinePoint* p = begin; p != end; ++p) {
    mean_y += p->y / count;
    mean_z += p->z / count;
  }
  double yy = 0.0, yz = 0.0, zz = 0.0, y_square = 0.0, z_square = 0.0;
  for (const OutlinePoint* p = begin; p != end; ++p) {
    const double y = p->y - mean_y, z = p->z - mean_z, square = y * y + z * z;
    yy += y * y;
    yz += y * z;
    zz += z * z;
    y_square += 0.5 * y * square;
    z_square += 0.5 * z * square;
  }
  const double determinant = yy * zz - yz * yz;
  if (!(determinant > 0.0)) return std::nullopt;
  const double y = (zz * y_square - yz * z_square) / determinant;
  const double z = (yy * z_square - yz * y_square) / determinant;
  return Circle{mean_y + y, mean_z + z, std::sqrt(y * y + z * z + (yy + zz) / count)};
}

/// The circle of the gauge corner where the outline ends in it.
std::optional<Circle> gauge_corner(const std::vector<OutlinePoint>& points) {
  constexpr double length = 3 * mm;
  constexpr std::ptrdiff_t fewest = 6;  // points whose scatter evens out
  constexpr double smallest = 8 * mm, largest = 25 * mm;
  const OutlinePoint& end = points.front();
  const auto inner = std::find_if(points.begin(), points.end(),
                                  [&](const OutlinePoint& p) { return std::hypot(p.y - end.y, p.z - end.z) > length; });
  if (inner - points.begin() < fewest) return std::nullopt;
  const auto corner = circle_through(points.data(), points.data() + (inner - points.begin()));
  if (!corner || corner->radius < smallest || corner->radius > largest) return std::nullopt;
  const double above = corner->z - end.z;  // of the end over the centre, less than half the radius at 60 degrees
  if (!(corner->y > end.y && above > 0.0 && above < 0.5 * corner->radius)) return std::nullopt;
  return corner;
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
  const auto corner = gauge_corner(points);
  const auto on_corner = [&](double z) {
    const double above = std::max(corner->z - z, 0.0);  // below its centre, the face is vertical
    return corner->y - std::sqrt(corner->radius * corner->radius - above * above);
  };
  const auto face_y = [&](double z) {  // from the last point on, which is off the corner's circle by its scatter
    return end.y + (corner ? on_corner(z) - on_corner(end.z) : slope * (z - end.z));
  };
  std::vector<OutlinePoint> face;
  for (double z = top + wanted; z > end.z + 0.5 * step; z -= step) face.push_back({face_y(z), z, end.line});
  points.insert(points.begin(), face.begin(), face.end());
  const std::string course =
      corner ? fmt::format("along the corner's radius of {:.3g} mm, then vertically", corner->radius / mm) : "straight";
  outline.notes.push_back(fmt::format("{}:{}: the gauge face ends {:.3g} mm below the top, continued {} to {:.3g} mm",
                                      file, end.line, (end.z - top) / mm, course, wanted / mm));
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
