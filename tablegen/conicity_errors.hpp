#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "railtab/runtime/contact/contact_search.hpp"
#include "railtab/runtime/contact/equivalent_conicity.hpp"
#include "railtab/tablegen/geometry_sweep.hpp"
#include "railtab/tablegen/profile_errors.hpp"

namespace railtab {

/// Both sides of a wheelset on its track, each as a right wheel on a right rail.
struct WheelsetPair {
  WheelRailPair right, left;
};

/// wheelset_contacts() by online search.
[[nodiscard]] std::vector<WheelsetContact> searched_contacts(const WheelsetPair& pair,
                                                             const WheelsetContactOptions& options);

/// The profiles that carry errors.
enum class ErrorBearer : std::uint8_t { wheels, rails, both };

/// Parameters of repeated computations with errors of the profiles.
struct ConicityErrorOptions {
  ProfileErrors errors;
  double smoothing = 0.0;  ///< noise of read_profile_file() for the profiles with errors [m]
  int runs = 20;           ///< [EN15302, 6.2] asks for 20 or more
  std::uint64_t seed = 1;
  std::vector<double> amplitudes;  ///< [m]
  WheelsetContactOptions contact;
};

/// Equivalent conicity of the wave, [run][amplitude]; NaN where a run has no wave of the amplitude.
using ConicityRuns = std::vector<std::vector<double>>;

/// Step 2 of [EN15302, 6.2]: the conicity with errors of the profiles, a new realisation in each run and independent
/// ones of the left and the right side. The profiles stay in place: the gauge that the errors give does not count. A
/// run depends on the seed, its number and the bearer alone.
/// @throws InputError naming the profile that the errors spoil
[[nodiscard]] ConicityRuns conicity_with_errors(const WheelsetPair& exact, ErrorBearer bearer,
                                                const ConicityErrorOptions& options, const Progress& progress = {});

/// Of the runs that have a wave of one amplitude. NaN without any; the standard deviation with fewer than two.
struct RunStatistics {
  int found = 0;
  double mean = 0.0, standard_deviation = 0.0, least = 0.0, greatest = 0.0;
};

[[nodiscard]] RunStatistics run_statistics(const ConicityRuns& runs, std::size_t amplitude);

}  // namespace railtab
