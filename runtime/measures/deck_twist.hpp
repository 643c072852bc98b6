#pragma once

#include <span>

namespace railtab {

/// Twist of a track or deck: the largest change of its cross level over a distance, per that distance.
struct Twist {
  double value = 0.0;  ///< amount of the change [m]
  double x = 0.0;      ///< where the distance begins [m]
};
/// Between x and x + base, the cross level by straight lines between its places. @param cross_level height of one edge
/// above the other over the track's width [m], at places x [m] that rise @param base 3 m [EN1990A2, A2.4.4.2.2]
/// @pre equally many, two at least; none where the places reach over less than `base`
[[nodiscard]] Twist largest_twist(std::span<const double> x, std::span<const double> cross_level, double base = 3.0);

}  // namespace railtab
