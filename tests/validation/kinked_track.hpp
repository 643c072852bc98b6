#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "railtab/runtime/line/irregularity.hpp"

namespace railtab {

/// z [m] of both rails at count + 1 points from `begin` on [m]; y is zero.
template <class Height>
Irregularity both_rails(double begin, double spacing, int count, const Height& z_at) {
  std::vector<double> x, z;
  for (int i = 0; i <= count; ++i) {
    x.push_back(begin + spacing * i);
    z.push_back(z_at(x.back()));
  }
  const std::vector<double> none(x.size(), 0.0);
  return {x, none, z, none, z};
}

/// A hump of 8 mm from x = 1 m to 4 m: wheels at 300 km/h leave it.
inline Irregularity hump() {
  return both_rails(0.5, 0.0125, 400, [](double x) {
    constexpr double begin = 1.0, length = 3.0, height = 8e-3;
    const double along = (x - begin) / length;
    return along > 0.0 && along < 1.0 ? -0.5 * height * (1.0 - std::cos(2.0 * std::numbers::pi * along)) : 0.0;
  });
}

}  // namespace railtab
