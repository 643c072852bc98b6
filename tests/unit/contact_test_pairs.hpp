#pragma once

#include <cmath>
#include <string>
#include <utility>

#include "railtab/runtime/profile/profile_curve.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/runtime/profile/wheel_rail_pair.hpp"

namespace railtab::contact_test {

/// Curve through f(s) -> CurvePoint at `pieces` + 1 knots; cubic pieces 0.1 mm long follow a smooth curve to rounding.
template <class F>
ProfileCurve curve(ProfileKind kind, std::string name, double s_begin, double s_end, int pieces, F f) {
  ProfileKnots k;
  k.kind = kind;
  k.name = std::move(name);
  for (int i = 0; i <= pieces; ++i) {
    const double s = s_begin + (s_end - s_begin) * i / pieces;
    const CurvePoint p = f(s);
    k.s.push_back(s - s_begin);
    k.y.push_back(p.y);
    k.z.push_back(p.z);
    k.dy.push_back(p.dy);
    k.dz.push_back(p.dz);
  }
  return ProfileCurve(std::move(k));
}

/// A cone: radius falls by `slope` towards the field side, from y = -0.03 to 0.06 m.
inline ProfileCurve cone_wheel(double slope) {
  const double c = 1.0 / std::sqrt(1.0 + slope * slope);
  return curve(ProfileKind::wheel, "cone", -0.03 / c, 0.06 / c, 10,
               [=](double s) { return CurvePoint{s * c, -s * c * slope, c, -c * slope, 0.0, 0.0}; });
}

/// A rail head of one radius r [m], up to 75 degrees on both sides.
inline ProfileCurve circle_rail(double r) {
  const double end = 75.0 * std::acos(-1.0) / 180.0 * r;
  return curve(ProfileKind::rail, "circle", -end, end, 2000, [=](double s) {
    const double t = s / r;
    return CurvePoint{r * std::sin(t), r * (1.0 - std::cos(t)), std::cos(t), std::sin(t), 0.0, 0.0};
  });
}

inline WheelRailPair cone_on_circle(double slope, double r) {
  return WheelRailPair(cone_wheel(slope), circle_rail(r), PairDimensions{});
}

inline const WheelRailPair& s1002_on_60e1() {
  static const WheelRailPair pair(ProfileCurve(standard_profile(ProfileKind::wheel, "S1002", 0.0)),
                                  ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)),
                                  PairDimensions{});
  return pair;
}

}  // namespace railtab::contact_test
