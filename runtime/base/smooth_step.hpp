#pragma once

#include <algorithm>

namespace railtab {

/// 0 at and below 0, 1 at and above 1, continuous slope.
[[nodiscard]] inline double smooth_step(double x) noexcept {
  const double s = std::clamp(x, 0.0, 1.0);
  return s * s * (3.0 - 2.0 * s);
}

}  // namespace railtab
