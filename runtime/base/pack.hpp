#pragma once

#ifdef __AVX__
#include <immintrin.h>
#endif

namespace railtab {

/// Four doubles side by side. Handed over by reference: by value its place depends on the instruction set.
using Pack [[gnu::vector_size(32)]] = double;

/// Eight doubles side by side, of eight things alike. Handed over by reference, as Pack.
using Lanes [[gnu::vector_size(64)]] = double;

/// Four neighbouring floats as doubles. GCC 12 converts a vector type by halves, in twice the instructions.
inline void widen(const float* from, Pack& to) noexcept {
#ifdef __AVX__
  to = _mm256_cvtps_pd(_mm_loadu_ps(from));
#else
  for (int i = 0; i < 4; ++i) to[i] = static_cast<double>(from[i]);
#endif
}

}  // namespace railtab
