#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace railtab {

/// The n-th of points that fill the unit cube in four dimensions evenly: an additive recurrence.
/// @param origin all coordinates of the point before the first, 0..1
inline std::array<double, 4> even_point(double origin, std::int64_t n) noexcept {
  constexpr std::array<double, 4> step{0.8566748838545029, 0.7338918566271260, 0.6287067210378087, 0.5385972572236101};
  std::array<double, 4> point{};
  for (std::size_t a = 0; a < point.size(); ++a) point[a] = std::fmod(origin + step[a] * static_cast<double>(n), 1.0);
  return point;
}

}  // namespace railtab
