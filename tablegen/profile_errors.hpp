#pragma once

#include <cstdint>
#include <random>

#include "railtab/tables/profile_knots.hpp"

namespace railtab {

/// Coordinates of a profile's points that carry errors.
enum class ErrorDirection : std::uint8_t { y, z, both };

/// Errors of a measured profile.
struct ProfileErrors {
  double deviation = 0.0;  ///< standard deviation of the normal random error of each coordinate [m], 0 to 1e-3
  double grid = 0.0;       ///< to which coordinates are rounded, its origin random [m], 0 to 1e-3; 0: no rounding
  double spacing = 0.0;  ///< of the points along the outline, the first one random [m], 0 to 5e-3; 0: the profile's own
  ErrorDirection direction = ErrorDirection::both;  ///< of random error and rounding

  /// @throws InputError naming the member out of range
  void validate() const;
};

/// The profile as measured with errors: its knots, or points at a spacing and both ends, displaced at random, rounded
/// to the grid, repaired as the points of a profile file, and interpolated or smoothed. Its origin stays where it is.
/// @param smoothing the noise of read_profile_file() [m]
/// @throws InputError where the points, displaced, are no outline any more
[[nodiscard]] ProfileKnots measured_profile(const ProfileKnots& exact, const ProfileErrors& errors, double smoothing,
                                            std::mt19937_64& generator);

}  // namespace railtab
