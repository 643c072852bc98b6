#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/profile/outline.hpp"

namespace railtab {

/// No profile has a corner sharper than a right angle; two swapped points turn by about 180 degrees.
inline constexpr double cosine_of_turning_back = -0.5;

/// Cosine of the angle by which the outline turns at b; the three points lie apart.
[[nodiscard]] inline double cosine_of_turn(const OutlinePoint& a, const OutlinePoint& b, const OutlinePoint& c) {
  const double length = std::hypot(b.y - a.y, b.z - a.z) * std::hypot(c.y - b.y, c.z - b.z);
  return ((b.y - a.y) * (c.y - b.y) + (b.z - a.z) * (c.z - b.z)) / length;
}

[[nodiscard]] inline InputError turning_back(const std::string& file, const OutlinePoint& p, double cosine) {
  const double degrees = std::acos(std::max(cosine, -1.0)) * 57.29577951308232;
  return input_error(
      fmt::format("{}:{}", file, p.line),
      fmt::format("an outline that turns back by {:.0f} degrees at ({:.9g}, {:.9g}) m", degrees, p.y, p.z),
      "points in order along the outline");
}

}  // namespace railtab
