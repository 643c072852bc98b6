#include "railtab/runtime/profile/profile_segments.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/profile/cubic_spline.hpp"

namespace railtab {

ProfileSegment straight_segment(ProfilePoint from, ProfilePoint to) {
  const double dy = to.y - from.y;
  const double dz = to.z - from.z;
  return [=](double u) { return CurvePoint{from.y + u * dy, from.z + u * dz, dy, dz, 0, 0}; };
}

ProfileSegment arc_segment(ProfilePoint centre, double radius, double phi_begin, double phi_end) {
  const double dphi = phi_end - phi_begin;
  return [=](double u) {
    const double phi = phi_begin + u * dphi;
    const double a = radius * std::sin(phi);
    const double b = radius * std::cos(phi);
    return CurvePoint{centre.y + a, centre.z + b, b * dphi, -a * dphi, -a * dphi * dphi, -b * dphi * dphi};
  };
}

ProfileSegment graph_segment(std::function<GraphPoint(double y)> z, double y_begin, double y_end) {
  const double dy = y_end - y_begin;
  return [=, z = std::move(z)](double u) {
    const double y = y_begin + u * dy;
    const GraphPoint p = z(y);
    return CurvePoint{y, p.z, dy, p.dz * dy, 0, p.ddz * dy * dy};
  };
}

namespace {

struct Tangent {
  double dy, dz;
};

Tangent unit_tangent(const CurvePoint& p) {
  const double length = std::hypot(p.dy, p.dz);
  return {p.dy / length, p.dz / length};
}

/// Arc length between two parameters, Gauss-Legendre with 8 points. Exact to rounding for lines and arcs, and for
/// the standards' polynomials over the millimetre and less that it is used for.
double arc_length(const ProfileSegment& segment, double u0, double u1) {
  constexpr std::array<double, 4> node{0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
  constexpr std::array<double, 4> weight{0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                         0.1012285362903763};
  const double middle = 0.5 * (u0 + u1);
  const double half = 0.5 * (u1 - u0);
  double sum = 0.0;
  for (std::size_t k = 0; k < node.size(); ++k) {
    for (const double side : {-1.0, 1.0}) {
      const CurvePoint p = segment(middle + side * half * node[k]);
      sum += weight[k] * std::hypot(p.dy, p.dz);
    }
  }
  return sum * half;
}

/// Parameter at arc length h beyond u0, by Newton: the derivative of the arc length is the speed.
double advance(const ProfileSegment& segment, double u0, double h) {
  const CurvePoint start = segment(u0);
  double u = u0 + h / std::hypot(start.dy, start.dz);
  for (int iteration = 0; iteration < 20; ++iteration) {
    const CurvePoint p = segment(u);
    const double step = (h - arc_length(segment, u0, u)) / std::hypot(p.dy, p.dz);
    u += step;
    if (std::abs(step) < 1e-15) break;
  }
  return u;
}

/// A segment splined at equal arc lengths h; knots[i] at i h.
struct SplinedSegment {
  double h = 0.0;
  std::vector<double> u, s, y, z, dy, dz;
};

/// Position and tangent at a segment's two ends, after its joints were closed.
struct SegmentEnds {
  CurvePoint begin, end;
};

SplinedSegment spline_segment(const ProfileSegment& segment, const SegmentEnds& ends, double length, std::size_t n) {
  SplinedSegment r;
  r.h = length / static_cast<double>(n);
  double u = 0.0;
  for (std::size_t i = 0; i <= n; ++i) {
    if (i > 0) u = i < n ? advance(segment, u, r.h) : 1.0;
    const CurvePoint p = i == 0 ? ends.begin : i == n ? ends.end : segment(u);
    r.u.push_back(u);
    r.s.push_back(static_cast<double>(i) * r.h);
    r.y.push_back(p.y);
    r.z.push_back(p.z);
  }
  const Tangent t0 = unit_tangent(ends.begin);
  const Tangent t1 = unit_tangent(ends.end);
  r.dy = clamped_spline_slopes(r.s, r.y, t0.dy, t1.dy);
  r.dz = clamped_spline_slopes(r.s, r.z, t0.dz, t1.dz);
  return r;
}

// The chord of a contact patch is some millimetres and its pressure follows the curvature; the position goes into
// penetrations of 1e-5 m, of which tables are to keep seven digits.
constexpr double position_tolerance = 1e-12;  // [m]
constexpr double curvature_tolerance = 1e-4;  // relative
constexpr double curvature_floor = 1.0;       // [1/m], below which the tolerance is absolute
// On an arc a cubic spline over h is off by h^4/(384 R^3): 0.25 mm meets the tolerance from R = 22 mm upwards, 0.16 mm
// from 12 mm. Large radii could do with far fewer knots, but near-uniform ones keep the look-up of intervals short.
constexpr double widest_spacing = 0.25e-3;  // [m]
constexpr double spacing_ratio = 0.8;       // between one attempt and the next

/// True where the spline follows its segment at the middle of every interval.
bool follows(const SplinedSegment& spline, const ProfileSegment& segment) {
  const ProfileCurve curve({ProfileKind::wheel, "segment", spline.s, spline.y, spline.z, spline.dy, spline.dz});
  for (std::size_t i = 0; i + 1 < spline.s.size(); ++i) {
    const CurvePoint exact = segment(advance(segment, spline.u[i], 0.5 * spline.h));
    const CurvePoint found = curve.at(spline.s[i] + 0.5 * spline.h);
    const double kappa = exact.curvature();
    const double scale = std::max(std::abs(kappa), curvature_floor);
    if (std::hypot(found.y - exact.y, found.z - exact.z) > position_tolerance ||
        std::abs(found.curvature() - kappa) > curvature_tolerance * scale) {
      return false;
    }
  }
  return true;
}

SplinedSegment spline_to_tolerance(const ProfileSegment& segment, const SegmentEnds& ends) {
  constexpr int panels = 256;
  double length = 0.0;
  for (int i = 0; i < panels; ++i) {
    length += arc_length(segment, static_cast<double>(i) / panels, static_cast<double>(i + 1) / panels);
  }
  constexpr double narrowest_spacing = 1e-7;  // m
  for (double spacing = widest_spacing; spacing > narrowest_spacing; spacing *= spacing_ratio) {
    const auto n = static_cast<std::size_t>(std::ceil(length / spacing));
    SplinedSegment spline = spline_segment(segment, ends, length, n);
    if (follows(spline, segment)) return spline;
  }
  throw ComputationError("profile: a segment's definition is not smooth, no spline follows it to the tolerance");
}

/// One point and tangent for two segment ends that agree up to the rounding of their published constants.
CurvePoint joint(const CurvePoint& left, const CurvePoint& right) {
  const Tangent a = unit_tangent(left);
  const Tangent b = unit_tangent(right);
  assert(std::hypot(left.y - right.y, left.z - right.z) < 1e-12);
  assert(std::hypot(a.dy - b.dy, a.dz - b.dz) < 1e-7);
  return {0.5 * (left.y + right.y), 0.5 * (left.z + right.z), a.dy + b.dy, a.dz + b.dz, 0, 0};
}

}  // namespace

ProfileKnots spline_segments(ProfileKind kind, std::string name, const std::vector<ProfileSegment>& segments) {
  ProfileKnots knots{kind, std::move(name), {}, {}, {}, {}, {}};
  double s0 = 0.0;
  for (std::size_t k = 0; k < segments.size(); ++k) {
    const SegmentEnds ends{k == 0 ? segments[k](0) : joint(segments[k - 1](1), segments[k](0)),
                           k + 1 == segments.size() ? segments[k](1) : joint(segments[k](1), segments[k + 1](0))};
    const SplinedSegment spline = spline_to_tolerance(segments[k], ends);
    for (std::size_t i = k == 0 ? 0 : 1; i < spline.s.size(); ++i) {
      knots.s.push_back(s0 + spline.s[i]);
      knots.y.push_back(spline.y[i]);
      knots.z.push_back(spline.z[i]);
      knots.dy.push_back(spline.dy[i]);
      knots.dz.push_back(spline.dz[i]);
    }
    s0 += spline.s.back();
  }
  return knots;
}

}  // namespace railtab
