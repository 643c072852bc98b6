#pragma once

#ifdef __AVX__
#include <immintrin.h>
#endif

namespace railtab {

/// Four doubles side by side. Handed over by reference: by value its place depends on the instruction set.
using Pack [[gnu::vector_size(32)]] = double;

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

/// The rows of a 4 × 4 matrix from its columns.
inline void transpose(const Pack& a, const Pack& b, const Pack& c, const Pack& d, Pack* rows) noexcept {
  const Pack ab_low = __builtin_shufflevector(a, b, 0, 4, 2, 6), ab_high = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Pack cd_low = __builtin_shufflevector(c, d, 0, 4, 2, 6), cd_high = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  rows[0] = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5);
  rows[1] = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
  rows[2] = __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
  rows[3] = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
}

/// Four neighbouring floats as doubles. GCC 12 converts a vector type by halves, in twice the instructions.
inline void widen(const float* from, Pack& to) noexcept {
#ifdef __AVX__
  to = _mm256_cvtps_pd(_mm_loadu_ps(from));
#else
  for (int i = 0; i < 4; ++i) to[i] = static_cast<double>(from[i]);
#endif
}

}  // namespace railtab
