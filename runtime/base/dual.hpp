#pragma once

#include <cmath>
#include <concepts>
#include <cstddef>

#include "railtab/runtime/base/lane_numbers.hpp"
#include "railtab/runtime/base/pack.hpp"

namespace railtab {

/// A number, or numbers side by side, with derivatives: what is computed with dual numbers carries the exact derivative
/// along. S holds a derivative in one direction, or in several. Like a double, `DualOf x;` is not initialised and
/// `DualOf{}` is zero.
template <class V, class S, std::size_t count>
struct DualOf {
  V value;
  S slope[count];

  DualOf() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): constants take part as they are
  DualOf(double constant) : value(broadcast<V>(constant)), slope{} {}
  // NOLINTNEXTLINE(google-explicit-constructor)
  DualOf(const V& constant) requires(!std::same_as<V, double>) : value(constant), slope{} {}

  /// f(x) with f' at x, by the chain rule.
  [[nodiscard]] friend DualOf chained(const DualOf& x, const V& f, const V& slope) noexcept {
    DualOf r;
    r.value = f;
    for (std::size_t i = 0; i < count; ++i) r.slope[i] = slope * x.slope[i];
    return r;
  }
  DualOf& operator+=(const DualOf& b) noexcept {
    value += b.value;
    for (std::size_t i = 0; i < count; ++i) slope[i] += b.slope[i];
    return *this;
  }
  DualOf& operator-=(const DualOf& b) noexcept {
    value -= b.value;
    for (std::size_t i = 0; i < count; ++i) slope[i] -= b.slope[i];
    return *this;
  }
  friend DualOf operator-(const DualOf& a) noexcept { return chained(a, -a.value, broadcast<V>(-1.0)); }
  friend DualOf operator+(DualOf a, const DualOf& b) noexcept { return a += b; }
  friend DualOf operator-(DualOf a, const DualOf& b) noexcept { return a -= b; }
  friend DualOf operator+(DualOf a, double b) noexcept { return a.value = a.value + b, a; }
  friend DualOf operator-(DualOf a, double b) noexcept { return a.value = a.value - b, a; }
  friend DualOf operator+(double a, DualOf b) noexcept { return b.value = a + b.value, b; }
  friend DualOf operator-(double a, const DualOf& b) noexcept { return chained(b, a - b.value, broadcast<V>(-1.0)); }
  friend DualOf operator*(double a, const DualOf& b) noexcept { return scaled(b, broadcast<V>(a)); }
  friend DualOf operator*(const DualOf& a, double b) noexcept { return scaled(a, broadcast<V>(b)); }
  friend DualOf operator/(const DualOf& a, double b) noexcept { return a * (1.0 / b); }
  /// Times a constant that differs from place to place.
  [[nodiscard]] friend DualOf scaled(const DualOf& a, const V& b) noexcept { return chained(a, a.value * b, b); }
  friend DualOf operator*(const V& a, const DualOf& b) noexcept requires(!std::same_as<V, double>) {
    return scaled(b, a);
  }
  friend DualOf operator+(const V& a, DualOf b) noexcept requires(!std::same_as<V, double>) {
    return b.value = a + b.value, b;
  }
  friend DualOf operator*(const DualOf& a, const DualOf& b) noexcept {
    DualOf r;
    r.value = a.value * b.value;
    for (std::size_t i = 0; i < count; ++i) r.slope[i] = a.value * b.slope[i] + b.value * a.slope[i];
    return r;
  }
  friend DualOf operator/(const DualOf& a, const DualOf& b) noexcept {
    const V inverse = 1.0 / b.value;
    DualOf r;
    r.value = a.value * inverse;
    for (std::size_t i = 0; i < count; ++i) r.slope[i] = inverse * (a.slope[i] - r.value * b.slope[i]);
    return r;
  }
  friend DualOf sqrt(const DualOf& x) noexcept {
    using std::sqrt;
    const V root = sqrt(x.value);
    return chained(x, root, 0.5 / root);
  }
  /// `a` where the mask is true, else `b`.
  template <class Mask>
  [[nodiscard]] friend DualOf select(const Mask& mask, const DualOf& a, const DualOf& b) noexcept {
    if constexpr (std::convertible_to<Mask, bool>) {
      return mask ? a : b;
    } else {
      DualOf r;
      r.value = select(mask, a.value, b.value);
      for (std::size_t i = 0; i < count; ++i) r.slope[i] = select(mask, a.slope[i], b.slope[i]);
      return r;
    }
  }
};

/// A number with its derivatives in 4·packs directions.
template <std::size_t packs>
using Dual = DualOf<double, Pack, packs>;

/// Numbers side by side, each with its derivatives in as many directions.
template <std::size_t directions>
using DualLanes = DualOf<WheelLanes, WheelLanes, directions>;

}  // namespace railtab
