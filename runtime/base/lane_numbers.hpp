#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>

#include "railtab/runtime/base/pack.hpp"

#ifdef __SSE2__
#include <immintrin.h>
#endif

namespace railtab {

// Operations that a number and numbers side by side have in common, so that one formula serves a single wheel and
// several of them.

/// True or false side by side.
template <int n>
struct LaneMask {
  using Register [[gnu::vector_size(sizeof(double) * SideBySide<n>::width)]] = long;

  Register part[SideBySide<n>::registers];

  [[nodiscard]] bool operator[](int i) const noexcept {
    return part[i / SideBySide<n>::width][i % SideBySide<n>::width] != 0;
  }
  friend LaneMask operator&(LaneMask a, const LaneMask& b) noexcept {
    for (int r = 0; r < SideBySide<n>::registers; ++r) a.part[r] &= b.part[r];
    return a;
  }
  friend LaneMask operator|(LaneMask a, const LaneMask& b) noexcept {
    for (int r = 0; r < SideBySide<n>::registers; ++r) a.part[r] |= b.part[r];
    return a;
  }
  friend LaneMask operator!(LaneMask a) noexcept {
    for (Register& r : a.part) r = ~r;
    return a;
  }
};

namespace lane_detail {

template <int n, class Compare>
LaneMask<n> compared(const SideBySide<n>& a, const SideBySide<n>& b, Compare compare) noexcept {
  LaneMask<n> mask;
  for (int r = 0; r < SideBySide<n>::registers; ++r) mask.part[r] = compare(a.part[r], b.part[r]);
  return mask;
}

}  // namespace lane_detail

/// The same number in every place.
template <class V>
[[nodiscard]] V broadcast(double x) noexcept {
  if constexpr (std::same_as<V, double>) {
    return x;
  } else {
    V v;
    for (auto& part : v.part) part = x - typename V::Register{};
    return v;
  }
}

template <int n>
[[nodiscard]] LaneMask<n> operator<(const SideBySide<n>& a, const SideBySide<n>& b) noexcept {
  return lane_detail::compared(a, b, [](const auto& x, const auto& y) { return x < y; });
}
template <int n>
[[nodiscard]] LaneMask<n> operator<=(const SideBySide<n>& a, const SideBySide<n>& b) noexcept {
  return lane_detail::compared(a, b, [](const auto& x, const auto& y) { return x <= y; });
}
template <int n>
[[nodiscard]] LaneMask<n> operator>(const SideBySide<n>& a, const SideBySide<n>& b) noexcept {
  return b < a;
}
template <int n>
[[nodiscard]] LaneMask<n> operator>=(const SideBySide<n>& a, const SideBySide<n>& b) noexcept {
  return b <= a;
}
template <int n>
[[nodiscard]] LaneMask<n> operator<(const SideBySide<n>& a, double b) noexcept {
  return a < broadcast<SideBySide<n>>(b);
}
template <int n>
[[nodiscard]] LaneMask<n> operator>(const SideBySide<n>& a, double b) noexcept {
  return broadcast<SideBySide<n>>(b) < a;
}
template <int n>
[[nodiscard]] LaneMask<n> operator>=(const SideBySide<n>& a, double b) noexcept {
  return broadcast<SideBySide<n>>(b) <= a;
}

template <int n>
[[nodiscard]] SideBySide<n> operator-(SideBySide<n> a) noexcept {
  for (auto& r : a.part) r = -r;
  return a;
}
template <int n>
[[nodiscard]] SideBySide<n> operator+(double a, const SideBySide<n>& b) noexcept {
  return b + a;
}
template <int n>
[[nodiscard]] SideBySide<n> operator-(const SideBySide<n>& a, double b) noexcept {
  return a + (-b);
}
template <int n>
[[nodiscard]] SideBySide<n> operator-(double a, SideBySide<n> b) noexcept {
  for (auto& r : b.part) r = a - r;
  return b;
}
template <int n>
[[nodiscard]] SideBySide<n> operator*(SideBySide<n> a, double b) noexcept {
  return a *= b;
}
template <int n>
[[nodiscard]] SideBySide<n> operator/(SideBySide<n> a, const SideBySide<n>& b) noexcept {
  for (int r = 0; r < SideBySide<n>::registers; ++r) a.part[r] /= b.part[r];
  return a;
}
template <int n>
[[nodiscard]] SideBySide<n> operator/(const SideBySide<n>& a, double b) noexcept {
  return a * (1.0 / b);
}

template <int n>
[[nodiscard]] SideBySide<n> sqrt(SideBySide<n> a) noexcept {
  for (auto& r : a.part) {
#if defined(__AVX512F__)
    if constexpr (sizeof r == 64) r = _mm512_sqrt_pd(r);
#endif
#if defined(__AVX__)
    if constexpr (sizeof r == 32) r = _mm256_sqrt_pd(r);
#endif
#if defined(__SSE2__)
    if constexpr (sizeof r == 16) r = _mm_sqrt_pd(r);
#else
    for (int i = 0; i < SideBySide<n>::width; ++i) r[i] = std::sqrt(r[i]);
#endif
  }
  return a;
}

/// `a` where the mask is true, else `b`.
[[nodiscard]] inline double select(bool mask, double a, double b) noexcept { return mask ? a : b; }
template <int n>
[[nodiscard]] SideBySide<n> select(const LaneMask<n>& mask, SideBySide<n> a, const SideBySide<n>& b) noexcept {
  for (int r = 0; r < SideBySide<n>::registers; ++r) a.part[r] = mask.part[r] ? a.part[r] : b.part[r];
  return a;
}

[[nodiscard]] inline bool any(bool mask) noexcept { return mask; }
[[nodiscard]] inline bool all(bool mask) noexcept { return mask; }
template <int n>
[[nodiscard]] bool any(const LaneMask<n>& mask) noexcept {
  long bits = 0;
  for (const auto& r : mask.part)
    for (int i = 0; i < SideBySide<n>::width; ++i) bits |= r[i];
  return bits != 0;
}
template <int n>
[[nodiscard]] bool all(const LaneMask<n>& mask) noexcept {
  return !any(!mask);
}

/// How many numbers a type holds, and one of them.
template <class V>
inline constexpr int lanes_of = 1;
template <int n>
inline constexpr int lanes_of<SideBySide<n>> = n;
[[nodiscard]] inline double& lane(double& x, int) noexcept { return x; }
[[nodiscard]] inline double lane(const double& x, int) noexcept { return x; }
[[nodiscard]] inline bool lane(const bool& x, int) noexcept { return x; }
template <int n>
[[nodiscard]] double& lane(SideBySide<n>& x, int i) noexcept {
  return x[i];
}
template <int n>
[[nodiscard]] double lane(const SideBySide<n>& x, int i) noexcept {
  return reinterpret_cast<const double*>(x.part)[i];  // NOLINT
}
template <int n>
[[nodiscard]] bool lane(const LaneMask<n>& x, int i) noexcept {
  return x[i];
}

[[nodiscard]] inline double at_most(double a, double b) noexcept { return std::min(a, b); }
template <int n>
[[nodiscard]] SideBySide<n> at_most(const SideBySide<n>& a, const SideBySide<n>& b) noexcept {
  return min(a, b);
}

}  // namespace railtab
