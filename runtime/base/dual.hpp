#pragma once

#include <cmath>
#include <cstddef>

#include "railtab/runtime/base/pack.hpp"

namespace railtab {

/// A number with its derivatives in 4·packs directions: what is computed with dual numbers carries the exact derivative
/// along. Like a double, `Dual x;` is not initialised and `Dual{}` is zero.
template <std::size_t packs>
struct Dual {
  double value;
  Pack slope[packs];

  Dual() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): constants take part as they are
  Dual(double constant) : value(constant), slope{} {}

  /// f(x) with f' at x, by the chain rule.
  [[nodiscard]] friend Dual chained(const Dual& x, double f, double slope) noexcept {
    Dual r(f);
    for (std::size_t i = 0; i < packs; ++i) r.slope[i] = slope * x.slope[i];
    return r;
  }
  Dual& operator+=(const Dual& b) noexcept {
    value += b.value;
    for (std::size_t i = 0; i < packs; ++i) slope[i] += b.slope[i];
    return *this;
  }
  Dual& operator-=(const Dual& b) noexcept {
    value -= b.value;
    for (std::size_t i = 0; i < packs; ++i) slope[i] -= b.slope[i];
    return *this;
  }
  friend Dual operator-(const Dual& a) noexcept { return chained(a, -a.value, -1.0); }
  friend Dual operator+(Dual a, const Dual& b) noexcept { return a += b; }
  friend Dual operator-(Dual a, const Dual& b) noexcept { return a -= b; }
  friend Dual operator+(Dual a, double b) noexcept { return a.value += b, a; }
  friend Dual operator-(Dual a, double b) noexcept { return a.value -= b, a; }
  friend Dual operator+(double a, Dual b) noexcept { return b.value += a, b; }
  friend Dual operator-(double a, const Dual& b) noexcept { return chained(b, a - b.value, -1.0); }
  friend Dual operator*(double a, const Dual& b) noexcept { return chained(b, a * b.value, a); }
  friend Dual operator*(const Dual& a, double b) noexcept { return chained(a, a.value * b, b); }
  friend Dual operator/(const Dual& a, double b) noexcept { return a * (1.0 / b); }
  friend Dual operator*(const Dual& a, const Dual& b) noexcept {
    Dual r(a.value * b.value);
    for (std::size_t i = 0; i < packs; ++i) r.slope[i] = a.value * b.slope[i] + b.value * a.slope[i];
    return r;
  }
  friend Dual operator/(const Dual& a, const Dual& b) noexcept {
    const double inverse = 1.0 / b.value;
    Dual r(a.value * inverse);
    for (std::size_t i = 0; i < packs; ++i) r.slope[i] = inverse * (a.slope[i] - r.value * b.slope[i]);
    return r;
  }
  friend Dual sqrt(const Dual& x) noexcept {
    const double root = std::sqrt(x.value);
    return chained(x, root, 0.5 / root);
  }
  friend Dual sin(const Dual& x) noexcept { return chained(x, std::sin(x.value), std::cos(x.value)); }
  friend Dual cos(const Dual& x) noexcept { return chained(x, std::cos(x.value), -std::sin(x.value)); }
  friend Dual tan(const Dual& x) noexcept {
    const double tangent = std::tan(x.value);
    return chained(x, tangent, 1.0 + tangent * tangent);
  }
};

}  // namespace railtab
