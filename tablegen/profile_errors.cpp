#include "railtab/tablegen/profile_errors.hpp"

#include <cmath>
#include <numbers>

#include "railtab/runtime/base/parameter_range.hpp"
#include "railtab/runtime/profile/outline.hpp"
#include "railtab/runtime/profile/profile_curve.hpp"
#include "railtab/runtime/profile/profile_file.hpp"
#include "random_number.hpp"

namespace railtab {

namespace {

/// Numbered in place of the lines of a file. Both ends and, from a random first point, points at the spacing. Without
/// the ends the outline would lose up to a spacing of the gauge face.
std::vector<OutlinePoint> points_at_spacing(const ProfileCurve& curve, double spacing, std::mt19937_64& generator) {
  std::vector<OutlinePoint> points;
  const auto add = [&](double s) {
    const CurvePoint p = curve.at(s);
    points.push_back({p.y, p.z, static_cast<int>(points.size()) + 1});
  };
  const double nearest = 0.1 * spacing;  // to an end
  add(curve.s_begin());
  const double first = curve.s_begin() + spacing * uniform(generator);
  for (int k = 0; first + k * spacing < curve.s_end() - nearest; ++k) {
    const double s = first + k * spacing;
    if (s > curve.s_begin() + nearest) add(s);
  }
  add(curve.s_end());
  return points;
}

std::vector<OutlinePoint> exact_points(const ProfileKnots& exact, double spacing, std::mt19937_64& generator) {
  if (spacing > 0.0) return points_at_spacing(ProfileCurve(exact), spacing, generator);
  std::vector<OutlinePoint> points;
  for (std::size_t i = 0; i < exact.y.size(); ++i) points.push_back({exact.y[i], exact.z[i], static_cast<int>(i) + 1});
  return points;
}

/// Box and Muller's method.
double standard_normal(std::mt19937_64& generator) {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform(generator)));
  return radius * std::cos(2.0 * std::numbers::pi * uniform(generator));
}

/// Displaces and rounds one coordinate of all points.
void add_errors(std::vector<OutlinePoint>& points, double OutlinePoint::*coordinate, const ProfileErrors& errors,
                std::mt19937_64& generator) {
  const double origin = errors.grid * uniform(generator);
  for (OutlinePoint& p : points) {
    double& value = p.*coordinate;
    if (errors.deviation > 0.0) value += errors.deviation * standard_normal(generator);
    if (errors.grid > 0.0) value = origin + errors.grid * std::round((value - origin) / errors.grid);
  }
}

}  // namespace

void ProfileErrors::validate() const {
  require_between("random error of profiles", deviation, 0.0, 1e-3, "m");
  require_between("grid of profiles", grid, 0.0, 1e-3, "m");
  require_between("spacing of profile points", spacing, 0.0, 5e-3, "m");
}

ProfileKnots measured_profile(const ProfileKnots& exact, const ProfileErrors& errors, double smoothing,
                              std::mt19937_64& generator) {
  errors.validate();
  ProfilePoints measured{exact_points(exact, errors.spacing, generator), {}};
  if (errors.direction != ErrorDirection::z) add_errors(measured.points, &OutlinePoint::y, errors, generator);
  if (errors.direction != ErrorDirection::y) add_errors(measured.points, &OutlinePoint::z, errors, generator);
  const std::string name = exact.name + " with errors";
  repair_outline(name, measured);
  std::vector<double> y, z;
  for (const OutlinePoint& p : measured.points) {
    y.push_back(p.y);
    z.push_back(p.z);
  }
  return smoothing > 0.0 ? smoothing_spline(exact.kind, name, y, z, smoothing).knots
                         : spline_through_points(exact.kind, name, y, z);
}

}  // namespace railtab
