#pragma once

#include <filesystem>
#include <vector>

namespace railtab {

/// Limits around a reference of the equivalent conicity.
struct ConicityLimits {
  double upper = 0.0, lower = 0.0;
};

/// Reference and tolerances of the equivalent conicity tan γe at one amplitude [EN15302, Annexes E and F].
struct ConicityBand {
  double amplitude = 0.0;  ///< [m]
  double reference = 0.0;
  ConicityLimits narrow;  ///< on tan γe alone
  ConicityLimits wide;    ///< with lateral shifts of the profiles
};

/// Read rows "amplitude [mm], reference, narrow upper, narrow lower, wide upper, wide lower", six numbers separated by
/// blanks; '#' begins a comment. Amplitudes increase, the reference lies between its limits.
/// @throws InputError with file and line
[[nodiscard]] std::vector<ConicityBand> read_conicity_bands(const std::filesystem::path& file);

/// Position of tan γe between limits: 0 at the reference, 1 at the upper and −1 at the lower limit. Infinite where a
/// limit is the reference itself and tan γe lies beyond it.
[[nodiscard]] double band_position(double tan_gamma, double reference, const ConicityLimits& limits) noexcept;

}  // namespace railtab
