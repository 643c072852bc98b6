#pragma once

#include <optional>
#include <string>
#include <vector>

#include "railtab/runtime/line/irregularity.hpp"

namespace railtab {

/// One-sided power spectral densities over the angular wave number Ω [rad/m].
struct TrackSpectrum {
  double vertical = 0.0, alignment = 0.0;  ///< of the track's centre line [m²/(rad/m)]
  double cross_level = 0.0;                ///< of the angle between the rails [rad²/(rad/m)]
  double gauge = 0.0;                      ///< [m²/(rad/m)]
};

/// A random track.
struct SpectrumParameters {
  std::string name = "german-low";  ///< one of spectrum_names()
  int seed = 1;                     ///< of the random phases
  double shortest = 3.0;            ///< wavelength [m]; EN 13848-1, range D1
  double longest = 70.0;            ///< wavelength [m]; EN 13848-1, end of range D2
  std::optional<double> fade_in{};  ///< length over which deviations rise from zero [m]; empty: longest
  double half_base = 0.75;          ///< half the distance of the rail heads [m]
  [[nodiscard]] double fade_length() const noexcept { return fade_in.value_or(longest); }
  void validate() const;  ///< @throws InputError
};

/// german-low, german-high [ERRI B 176]; fra-4, fra-5, fra-6: classes of the Federal Railroad Administration in the
/// form of [Hamid1983].
[[nodiscard]] std::vector<std::string> spectrum_names();
/// @pre `name` is one of them, omega > 0
[[nodiscard]] TrackSpectrum track_spectrum(const std::string& name, double omega, double half_base) noexcept;

/// Deviations of both rails from `from` to `to` [m]: r(x) = Σ √(2 S(Ω_n) ΔΩ) cos(Ω_n x + φ_n) for each of the four
/// quantities, with equally wide bands ΔΩ, a wave number at random in each of them (so that the track does not repeat
/// itself) and random phases; vertical ± half_base × cross level, alignment ± gauge / 2. The same seed gives the same
/// deviation at a position, whatever the ends are. With `fade_from` [m] it is zero up to there and rises over
/// fade_length() by s²(3 − 2s).
/// @throws InputError as validate()
[[nodiscard]] Irregularity random_irregularity(const SpectrumParameters& parameters, double from, double to,
                                               std::optional<double> fade_from = std::nullopt);

}  // namespace railtab
