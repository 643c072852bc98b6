#pragma once

#include <array>

namespace railtab {

/// Cubic Hermite polynomials over a cell of width h, of its place t = 0..1: value at 0, slope at 0, value at 1, slope
/// at 1; with two derivatives with respect to the coordinate.
struct HermiteBasis {
  std::array<double, 4> value, first, second;

  HermiteBasis(double t, double h) noexcept {
    const double s = 1.0 - t;
    value = {s * s * (1.0 + 2.0 * t), h * t * s * s, t * t * (3.0 - 2.0 * t), -h * t * t * s};
    first = {-6.0 * t * s / h, s * (1.0 - 3.0 * t), 6.0 * t * s / h, t * (3.0 * t - 2.0)};
    second = {(12.0 * t - 6.0) / (h * h), (6.0 * t - 4.0) / h, (6.0 - 12.0 * t) / (h * h), (6.0 * t - 2.0) / h};
  }

  /// One of `value`, `first` and `second` times what it belongs to.
  [[nodiscard]] static double sum(const std::array<double, 4>& basis, const std::array<double, 4>& of) noexcept {
    return basis[0] * of[0] + basis[1] * of[1] + basis[2] * of[2] + basis[3] * of[3];
  }
};

}  // namespace railtab
