#include "railtab/tablegen/full_sliding.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace railtab {

namespace {

constexpr int rings = 64, rays = 128;

/// Points of the unit circle that carry the same share of an elliptic pressure each: ∫ over a radius of
/// (3/2π) √(1 - r²) r dr is proportional to 1 - (1 - r²)^{3/2}.
struct PressureNodes {
  std::array<double, static_cast<std::size_t>(rings) * rays> x, y;

  PressureNodes() {
    std::size_t n = 0;
    for (int i = 0; i < rings; ++i) {
      const double r = std::sqrt(1.0 - std::pow(1.0 - (i + 0.5) / rings, 2.0 / 3.0));
      for (int j = 0; j < rays; ++j, ++n) {
        const double angle = 2.0 * std::numbers::pi * (j + (i % 2 == 0 ? 0.25 : 0.75)) / rays;
        x[n] = r * std::cos(angle);
        y[n] = r * std::sin(angle);
      }
    }
  }
};

}  // namespace

CreepForce full_sliding_force(double ratio, const Creepage& direction) noexcept {
  static const PressureNodes nodes;
  const double a = std::sqrt(ratio), b = 1.0 / a;
  double fx = 0.0, fy = 0.0, moment = 0.0;
  for (std::size_t n = 0; n < nodes.x.size(); ++n) {
    const double x = a * nodes.x[n], y = b * nodes.y[n];
    const double wx = direction.x - direction.spin * y, wy = direction.y + direction.spin * x;
    const double size = std::sqrt(wx * wx + wy * wy);
    const double inverse = size > 0.0 ? 1.0 / size : 0.0;
    fx += wx * inverse;
    fy += wy * inverse;
    moment += (x * wy - y * wx) * inverse;
  }
  const double weight = -1.0 / static_cast<double>(nodes.x.size());
  return {weight * fx, weight * fy, weight * moment};
}

}  // namespace railtab
