#pragma once

#ifdef __AVX__
#include <immintrin.h>
#endif

namespace railtab {

/// Four doubles side by side. Handed over by reference: by value its place depends on the instruction set.
using Pack [[gnu::vector_size(32)]] = double;

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
