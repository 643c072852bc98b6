#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <concepts>

#ifdef __SSE2__
#include <immintrin.h>
#endif

namespace railtab {

/// Doubles side by side, of so many things alike, in the registers that the instruction set has: GCC carries a vector
/// type that is wider than a register through memory. `SideBySide<n> x;` is not initialised, `SideBySide<n>{}` is zero.
template <int n>
struct alignas(sizeof(double) * n) SideBySide {
#if defined(__AVX512F__)
  static constexpr int widest = 8;
#elif defined(__AVX__)
  static constexpr int widest = 4;
#else
  static constexpr int widest = 2;
#endif
  static constexpr int count = n, width = n < widest ? n : widest, registers = n / width;
  static_assert(n % width == 0);
  using Register [[gnu::vector_size(sizeof(double) * width)]] = double;

  Register part[registers];

  [[nodiscard]] double& operator[](int i) noexcept { return reinterpret_cast<double*>(part)[i]; }  // NOLINT
  [[nodiscard]] double operator[](int i) const noexcept { return part[i / width][i % width]; }

  SideBySide& operator+=(const SideBySide& other) noexcept {
    for (int r = 0; r < registers; ++r) part[r] += other.part[r];
    return *this;
  }
  SideBySide& operator-=(const SideBySide& other) noexcept {
    for (int r = 0; r < registers; ++r) part[r] -= other.part[r];
    return *this;
  }
  SideBySide& operator*=(const SideBySide& other) noexcept {
    for (int r = 0; r < registers; ++r) part[r] *= other.part[r];
    return *this;
  }
  SideBySide& operator*=(double factor) noexcept {
    for (Register& r : part) r *= factor;
    return *this;
  }
  friend SideBySide operator+(SideBySide a, const SideBySide& b) noexcept { return a += b; }
  friend SideBySide operator-(SideBySide a, const SideBySide& b) noexcept { return a -= b; }
  friend SideBySide operator*(SideBySide a, const SideBySide& b) noexcept { return a *= b; }
  friend SideBySide operator*(double a, SideBySide b) noexcept { return b *= a; }
  friend SideBySide operator+(SideBySide a, double b) noexcept {
    for (Register& r : a.part) r += b;
    return a;
  }
  friend SideBySide operator/(double a, SideBySide b) noexcept {
    for (Register& r : b.part) r = a / r;
    return b;
  }
  [[nodiscard]] friend SideBySide abs(SideBySide a) noexcept {
    for (Register& r : a.part) r = r < 0.0 ? -r : r;
    return a;
  }
  [[nodiscard]] friend SideBySide min(SideBySide a, const SideBySide& b) noexcept {
    for (int r = 0; r < registers; ++r) a.part[r] = b.part[r] < a.part[r] ? b.part[r] : a.part[r];
    return a;
  }
};
using Lanes = SideBySide<8>;
/// Of wheels: four where registers are narrower than eight doubles. The contact of eight would take two registers for
/// each number, more than a processor has.
using WheelLanes = SideBySide<(Lanes::width == 8 ? 8 : 4)>;

/// Neighbouring floats as doubles (see widen() of a Pack).
template <int n>
void widen(const float* from, SideBySide<n>& to) noexcept {
  constexpr int width = SideBySide<n>::width;
  for (int r = 0; r < SideBySide<n>::registers; ++r, from += width) {
#if defined(__AVX512F__)
    if constexpr (width == 8) to.part[r] = _mm512_cvtps_pd(_mm256_loadu_ps(from));
#endif
#if defined(__AVX__)
    if constexpr (width == 4) to.part[r] = _mm256_cvtps_pd(_mm_loadu_ps(from));
#endif
    if constexpr (width == 2) to.part[r] = typename SideBySide<n>::Register{double{from[0]}, double{from[1]}};
  }
}

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
  auto bits = mask.part[0];
  for (int r = 1; r < SideBySide<n>::registers; ++r) bits |= mask.part[r];
#if defined(__AVX512F__)
  if constexpr (sizeof bits == 64) {
    return _mm512_test_epi64_mask(std::bit_cast<__m512i>(bits), std::bit_cast<__m512i>(bits)) != 0;
  }
#endif
#if defined(__AVX__)
  if constexpr (sizeof bits == 32) {
    return _mm256_testz_si256(std::bit_cast<__m256i>(bits), std::bit_cast<__m256i>(bits)) == 0;
  }
#endif
  long some = 0;
  for (int i = 0; i < SideBySide<n>::width; ++i) some |= bits[i];
  return some != 0;
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

/// Sine and cosine to rounding, of an angle or of angles side by side; of small ones by their series, in a tenth of the
/// library's time.
template <class V>
struct SineCosineOf {
  V sine, cosine;

  explicit SineCosineOf(const V& angle) noexcept {
    if constexpr (std::same_as<V, double>) {
      constexpr double series_limit = 0.1;  // the first terms left out are 3e-18 of the sine, 3e-17 of the cosine
      const double x = angle * angle;
      if (angle == 0.0) {  // most tracks have no cross-level
        sine = 0.0;
        cosine = 1.0;
      } else if (x <= series_limit * series_limit) {
        sine = angle + angle * x * (-1.0 / 6 + x * (1.0 / 120 + x * (-1.0 / 5040 + x * (1.0 / 362880))));
        cosine = 1.0 + x * (-0.5 + x * (1.0 / 24 + x * (-1.0 / 720 + x * (1.0 / 40320))));
      } else {
        sine = std::sin(angle);
        cosine = std::cos(angle);
      }
    } else {
      constexpr double series_limit = 1.6;  // contact angles; the first terms left out are below 1e-18
      constexpr double small_limit = 0.1;   // roll and yaw; below 1e-20
      constexpr int terms = 24, small_terms = 10;
      const V size = abs(angle);
      if (!all(size < series_limit)) {
        for (int i = 0; i < lanes_of<V>; ++i) {
          lane(sine, i) = std::sin(lane(angle, i));
          lane(cosine, i) = std::cos(lane(angle, i));
        }
        return;
      }
      const V x = angle * angle;
      sine = cosine = broadcast<V>(1.0);
      const auto add = [&](int k) {
        sine = 1.0 - (1.0 / (k * (k + 1))) * x * sine;
        cosine = 1.0 - (1.0 / (k * (k - 1))) * x * cosine;
      };
      if (!all(size < small_limit)) {
        for (int k = terms; k > small_terms; k -= 2) add(k);
      }
      for (int k = small_terms; k > 0; k -= 2) add(k);
      sine = sine * angle;
    }
  }
};
using SineCosine = SineCosineOf<double>;

}  // namespace railtab
