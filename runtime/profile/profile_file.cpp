#include "railtab/runtime/profile/profile_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <optional>
#include <string_view>

#include "outline.hpp"
#include "profile_text.hpp"
#include "railtab/runtime/profile/profile_curve.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/tables/input_error.hpp"
#include "simpack_profile.hpp"

namespace railtab {

namespace {

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Metres per unit of a comment "units: mm" or "units: m"; nothing where the comment is about something else.
std::optional<double> units_of(std::string_view comment, const std::string& place) {
  const std::string text = lower_case(std::string(trimmed(comment)));
  if (!text.starts_with("units")) return std::nullopt;
  const std::size_t colon = text.find(':');
  const std::string_view unit = colon == std::string::npos ? "" : trimmed(std::string_view(text).substr(colon + 1));
  if (unit == "mm") return 1e-3;
  if (unit == "m") return 1.0;
  throw input_error(place, fmt::format("\"{}\"", trimmed(comment)), "\"units: mm\" or \"units: m\"");
}

/// Two columns y z; comments from # or ! to the end of the line, one of them the units, before the first point.
std::vector<OutlinePoint> read_two_columns(std::istream& in, const std::string& file) {
  ProfileText text{in, file, 0};
  std::optional<double> unit;
  std::vector<OutlinePoint> points;
  while (const std::optional<std::string> line = text.next()) {
    const std::size_t comment = line->find_first_of("#!");
    if (comment != std::string::npos && !unit)
      unit = units_of(std::string_view(*line).substr(comment + 1), text.place());
    const std::string_view content = trimmed(std::string_view(*line).substr(0, comment));
    if (content.empty()) continue;
    const std::vector<std::string_view> field = fields(content);
    const std::string place = text.place();
    if (field.size() != 2) throw input_error(place, fmt::format("\"{}\"", content), "two numbers y z");
    const double y = number(field[0], place, "a number for y");
    const double z = number(field[1], place, "a number for z");
    if (!unit) throw input_error(place, "a point before any units", "a line \"# units: mm\" or \"# units: m\" first");
    points.push_back({y * *unit, z * *unit, text.line});
  }
  return points;
}

/// The axes cannot be told from the numbers alone, but two mistakes show: z up, and y towards the track centre.
void check_wheel_axes(const std::string& file, const ProfileKnots& k) {
  const auto by_z = std::minmax_element(k.z.begin(), k.z.end());
  const auto highest = static_cast<std::size_t>(by_z.first - k.z.begin());
  const auto lowest = static_cast<std::size_t>(by_z.second - k.z.begin());
  if (!(k.y.front() < 0.0 && k.y.back() > 0.0)) {
    throw input_error(file, fmt::format("a wheel profile from y = {:.6g} m to {:.6g} m", k.y.front(), k.y.back()),
                      "one around the tape circle at y = 0");
  }
  // A chamfer or a worn tread rises some millimetres, only a flange is this high.
  constexpr double flange = 0.015;
  if (std::max(k.z[lowest], -k.z[highest]) < flange) return;
  const std::size_t tip = k.z[lowest] > -k.z[highest] ? lowest : highest;
  if (k.z[tip] < 0.0) {
    throw input_error(file, fmt::format("a flange that reaches z = {:.6g} m", k.z[tip]), "z positive downwards");
  }
  if (k.y[tip] > 0.0) {
    throw input_error(file, fmt::format("a flange at y = {:.6g} m", k.y[tip]),
                      "a right wheel with y to the field side, its flange at y < 0");
  }
}

/// Moves the origin to the highest point, where rail profiles have it.
void centre_rail(const std::string& file, ProfileKnots& k) {
  const ProfileCurve curve(k);
  const double s = curve.s_at_highest_point();
  if (!(s > curve.s_begin() && s < curve.s_end())) {
    throw input_error(file, "a rail profile whose highest point is one of its ends",
                      "z positive downwards and points on both sides of the head's top");
  }
  const CurvePoint top = curve.at(s);
  for (double& y : k.y) y -= top.y;
  for (double& z : k.z) z -= top.z;
}

}  // namespace

ProfileKnots read_profile_file(const std::filesystem::path& file, ProfileKind kind) {
  const std::string name = file.string();
  std::ifstream in(file);
  if (!in || std::filesystem::is_directory(file)) throw input_error(name, "no readable file", "a profile file");
  const std::string extension = lower_case(file.extension().string());
  const bool wheel = kind == ProfileKind::wheel;
  if (extension == (wheel ? ".prr" : ".prw")) {
    throw input_error(name, fmt::format("the extension {}", extension), wheel ? ".prw for a wheel" : ".prr for a rail");
  }
  const bool simpack = extension == ".prw" || extension == ".prr";
  std::vector<OutlinePoint> points = simpack ? read_simpack_points(in, name, kind) : read_two_columns(in, name);
  check_outline(name, points);
  // Some programs list wheels from the field side, so that the material lies on the right: both ways are the same
  // curve.
  if (points.front().y > points.back().y) std::reverse(points.begin(), points.end());
  std::vector<double> y, z;
  for (const OutlinePoint& p : points) {
    y.push_back(p.y);
    z.push_back(p.z);
  }
  ProfileKnots knots = spline_through_points(kind, file.filename().string(), y, z);
  if (wheel) {
    check_wheel_axes(name, knots);
  } else {
    centre_rail(name, knots);
  }
  return knots;
}

ProfileKnots load_profile(const std::string& name_or_file, ProfileKind kind, double rail_inclination) {
  const std::vector<std::string> names = standard_profile_names(kind);
  const bool known = std::any_of(names.begin(), names.end(),
                                 [&](const std::string& n) { return lower_case(n) == lower_case(name_or_file); });
  if (known) return standard_profile(kind, name_or_file, rail_inclination);
  if (std::filesystem::exists(name_or_file)) return read_profile_file(name_or_file, kind);
  throw input_error(kind == ProfileKind::wheel ? "wheel profile" : "rail profile",
                    fmt::format("\"{}\", neither a built-in name nor a file", name_or_file),
                    fmt::format("one of {}, or a profile file", fmt::join(names, ", ")));
}

}  // namespace railtab
