#pragma once

#include <limits>

namespace railtab {

inline constexpr double mm = 1e-3;  ///< [m]
inline constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace railtab
