#pragma once

#include "railtab/runtime/base/lane_numbers.hpp"

namespace railtab {

/// 0 at and below 0, 1 at and above 1, continuous slope.
template <class V>
[[nodiscard]] V smooth_step(const V& x) noexcept {
  const V zero{}, one = broadcast<V>(1.0);
  const V s = select(x > zero, at_most(x, one), zero);
  return s * s * (3.0 - 2.0 * s);
}

/// Derivative of smooth_step().
template <class V>
[[nodiscard]] V smooth_step_slope(const V& x) noexcept {
  const V zero{}, one = broadcast<V>(1.0);
  const V s = select(x > zero, at_most(x, one), zero);
  return 6.0 * s * (1.0 - s);
}

}  // namespace railtab
