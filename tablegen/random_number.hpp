#pragma once

#include <random>

namespace railtab {

/// Uniform in [0, 1), the same on every platform.
inline double uniform(std::mt19937_64& generator) { return static_cast<double>(generator() >> 11) * 0x1p-53; }

}  // namespace railtab
