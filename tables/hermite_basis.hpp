#pragma once

#include <array>

#include "railtab/runtime/base/lane_numbers.hpp"

namespace railtab {

/// Cubic Hermite polynomials over a cell of width h, of its place t = 0..1: value at 0, slope at 0, value at 1, slope
/// at 1; with two derivatives with respect to the coordinate. V: a number, or numbers side by side.
template <class V>
struct HermiteBasisOf {
  std::array<V, 4> value, first, second;

  HermiteBasisOf(const V& t, const V& h) noexcept {
    const V s = 1.0 - t, inverse = 1.0 / h;
    value = {s * s * (1.0 + 2.0 * t), h * t * s * s, t * t * (3.0 - 2.0 * t), -h * t * t * s};
    const V rise = 6.0 * t * s * inverse, bend = (12.0 * t - 6.0) * inverse * inverse;
    first = {-rise, s * (1.0 - 3.0 * t), rise, t * (3.0 * t - 2.0)};
    second = {bend, (6.0 * t - 4.0) * inverse, -bend, (6.0 * t - 2.0) * inverse};
  }

  /// One of `value`, `first` and `second` times what it belongs to.
  [[nodiscard]] static V sum(const std::array<V, 4>& basis, const std::array<V, 4>& of) noexcept {
    return basis[0] * of[0] + basis[1] * of[1] + basis[2] * of[2] + basis[3] * of[3];
  }
};
using HermiteBasis = HermiteBasisOf<double>;

}  // namespace railtab
