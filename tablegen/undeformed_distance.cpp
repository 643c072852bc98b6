#include "railtab/tablegen/undeformed_distance.hpp"

#include <cmath>

namespace railtab {

namespace {

constexpr double sample_spacing = 1e-4;  // of the wheel's silhouette [m]
constexpr double reach = 5e-3;           // of the rail's normal [m]
constexpr int max_iterations = 12;
constexpr double step_tolerance = 1e-12;  // [m] the error left is of its square

}  // namespace

UndeformedDistance::UndeformedDistance(const WheelRailPair& pair, const WheelsetPose& pose)
    : pair_(pair), trigonometry_(pose), centre_(wheelset_centre(pair, pose)) {
  const ProfileCurve& wheel = pair.wheel();
  const int count = static_cast<int>((wheel.s_end() - wheel.s_begin()) / sample_spacing);
  silhouette_.reserve(static_cast<std::size_t>(count) + 1);
  for (int i = 0; i <= count; ++i) {
    const double s = wheel.s_begin() + i * sample_spacing;
    const SilhouettePoint raw =
        silhouette_point(wheel.at(s), pair.tape_circle_offset(), pair.nominal_radius(), trigonometry_);
    if (!raw.exists || raw.speed <= 0.0) continue;
    const SilhouettePoint p = placed(raw, centre_, trigonometry_);
    silhouette_.push_back({s, p.y, p.z, p.ty, p.tz});
  }
}

SurfaceLine UndeformedDistance::rail_point(double s_rail) const noexcept {
  const CurvePoint rail = pair_.rail().at(s_rail);
  return {s_rail, rail.y, rail.z, std::atan2(rail.dz, rail.dy), 0.0, 0.0, 0.0, 0.0};
}

/// Wheel arc length at which the silhouette crosses the rail's normal, where several do the deepest one.
std::optional<double> UndeformedDistance::start(const SurfaceLine& line) const noexcept {
  const PlaneVector<double> tangent{std::cos(line.angle), std::sin(line.angle)};
  std::optional<double> found;
  double deepest = -reach, before = 0.0;
  for (std::size_t i = 0; i < silhouette_.size(); ++i) {
    const Sample& p = silhouette_[i];
    const double along = tangent.y * (p.y - line.y) + tangent.z * (p.z - line.z);
    if (i > 0 && before < 0.0 && along >= 0.0 && tangent.y * p.ty + tangent.z * p.tz > 0.0) {
      const double depth = tangent.y * (p.z - line.z) - tangent.z * (p.y - line.y);
      if (depth > deepest && depth < reach) {
        deepest = depth;
        const double share = along / (along - before);
        found = p.s_wheel - share * (p.s_wheel - silhouette_[i - 1].s_wheel);
      }
    }
    before = along;
  }
  return found;
}

std::optional<OverlapDepth> UndeformedDistance::at(const SurfaceLine& line, double x,
                                                   const OverlapDepth& start) const noexcept {
  const PoseTrigonometry& t = trigonometry_;
  const double ny = -std::sin(line.angle), nz = std::cos(line.angle);
  // in the wheelset's axes: the rail's point, and the direction of its normal
  const double dy = line.y - centre_.y, dz = line.z - centre_.z;
  const double across = t.cos_roll * dy + t.sin_roll * dz, down = t.cos_roll * dz - t.sin_roll * dy;
  const double n_across = t.cos_roll * ny + t.sin_roll * nz, n_down = t.cos_roll * nz - t.sin_roll * ny;
  const double axial0 = t.cos_yaw * across - t.sin_yaw * x, n_axial = t.cos_yaw * n_across;
  const double ahead0 = t.sin_yaw * across + t.cos_yaw * x, n_ahead = t.sin_yaw * n_across;
  OverlapDepth found = start;
  for (int i = 0; i < max_iterations; ++i) {
    const CurvePoint wheel = pair_.wheel().at(found.s_wheel);
    const double ahead = ahead0 + found.overlap * n_ahead, below = down + found.overlap * n_down;
    const double radius = std::sqrt(ahead * ahead + below * below);
    const double f = axial0 + found.overlap * n_axial - pair_.tape_circle_offset() - wheel.y;
    const double g = radius - pair_.nominal_radius() - wheel.z;
    const double n_radial = (ahead * n_ahead + below * n_down) / radius;
    const double determinant = wheel.dy * n_radial - wheel.dz * n_axial;
    if (!(determinant > 0.05)) return std::nullopt;  // the normal grazes the wheel, or leaves it
    const double step_overlap = (wheel.dz * f - wheel.dy * g) / determinant;
    const double step_wheel = (n_radial * f - n_axial * g) / determinant;
    found.overlap += step_overlap;
    found.s_wheel += step_wheel;
    if (!(std::abs(step_overlap) < 0.05) || !pair_.wheel().contains(found.s_wheel)) return std::nullopt;
    if (std::abs(step_overlap) + std::abs(step_wheel) < step_tolerance) return found;
  }
  return std::nullopt;
}

/// line.s_wheel as start: x, overlap, s_wheel and curvature where overlap is greatest along x. There the wheel's normal
/// has no component along x: the silhouette's point.
std::optional<SurfaceLine> UndeformedDistance::deepest(SurfaceLine line) const noexcept {
  OverlapDepth point{line.overlap, line.s_wheel};
  for (int i = 0; i < 3; ++i) {
    const SilhouettePoint p = silhouette_point(pair_.wheel().at(point.s_wheel), pair_.tape_circle_offset(),
                                               pair_.nominal_radius(), trigonometry_);
    if (!p.exists) return std::nullopt;
    line.x = p.x;
    const std::optional<OverlapDepth> found = at(line, p.x, point);
    if (!found) return std::nullopt;
    point = *found;
  }
  line.overlap = point.overlap;
  line.s_wheel = point.s_wheel;
  constexpr double aside = 2e-3;  // [m]
  double drop = 0.0;
  for (const double x : {line.x - aside, line.x + aside}) {
    const std::optional<OverlapDepth> found = at(line, x, point);
    if (!found) return std::nullopt;
    drop += point.overlap - found->overlap;
  }
  line.curvature = drop / (aside * aside);
  if (!(line.curvature > 0.0)) return std::nullopt;
  return line;
}

std::optional<SurfaceLine> UndeformedDistance::line(double s_rail, double s_wheel) const {
  SurfaceLine line = rail_point(s_rail);
  line.s_wheel = s_wheel;
  return deepest(line);
}

std::optional<SurfaceLine> UndeformedDistance::line(double s_rail) const {
  const std::optional<double> from = start(rail_point(s_rail));
  return from ? line(s_rail, *from) : std::nullopt;
}

}  // namespace railtab
