#pragma once

// Outlines of wheel and rail profiles as lines of a figure.

#include <algorithm>
#include <string>
#include <vector>

#include "railtab/runtime/profile/profile_curve.hpp"
#include "railtab/runtime/report/chart.hpp"

namespace railtab {

/// An outline's points between the profile's ends, z down [m].
struct Outline {
  std::vector<double> y, z;
};

inline Outline outline_of(const ProfileCurve& curve) {
  constexpr int points = 1500;
  Outline outline;
  for (int i = 0; i <= points; ++i) {
    const CurvePoint p = curve.at(curve.s_begin() + (curve.s_end() - curve.s_begin()) * i / points);
    outline.y.push_back(p.y);
    outline.z.push_back(p.z);
  }
  return outline;
}

/// What is drawn of the right side: mm to the right, and up.
struct DrawingWindow {
  double left, right, low, high;
};

/// The part of an outline in a window. The left side is the mirror image of the right one, in which profiles are given.
/// @param mirror 1 right, -1 left
inline report::Series drawing(const std::string& label, const Outline& outline, double mirror,
                              const DrawingWindow& window) {
  report::Series line{label, {}, {}};
  for (std::size_t i = 0; i < outline.y.size(); ++i) {
    const double y = 1e3 * outline.y[i], z = -1e3 * outline.z[i];
    if (y < window.left || y > window.right || z < window.low || z > window.high) continue;
    line.x.push_back(mirror * y);
    line.y.push_back(z);
  }
  if (mirror < 0.0) {
    std::reverse(line.x.begin(), line.x.end());
    std::reverse(line.y.begin(), line.y.end());
  }
  return line;
}

}  // namespace railtab
