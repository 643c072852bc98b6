#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "railtab/runtime/reliability/proportion.hpp"

namespace railtab {

/// Runs at one intensity, and how many of them exceeded the limit.
struct FragilityLevel {
  double intensity = 0.0;  ///< > 0: wind speed [m/s], peak ground acceleration [m/s²], …
  std::size_t runs = 0, exceeded = 0;
};

/// Probability of exceedance Φ(ln(x/median)/deviation) over the intensity x.
struct FragilityCurve {
  double median = 0.0;     ///< intensity of probability 0.5, in its unit
  double deviation = 0.0;  ///< β, of the logarithm
  [[nodiscard]] double probability(double intensity) const noexcept;
};

/// Whether some intensity with an exceedance is below some intensity without one. Levels that do not overlap have no
/// curve; levels that overlap without a curve have a probability that does not rise with the intensity.
[[nodiscard]] bool levels_overlap(const std::vector<FragilityLevel>& levels);

/// The curve of the largest likelihood Σ k·ln p + (n − k)·ln(1 − p) [Baker2015], as a probit regression on
/// ln x by Fisher scoring. None where the likelihood has no finite maximum: fewer than two intensities, or one
/// intensity divides levels without exceedance from levels with nothing else, or the probability does not rise with the
/// intensity.
/// @pre intensities > 0, exceeded <= runs
[[nodiscard]] std::optional<FragilityCurve> fit_fragility(const std::vector<FragilityLevel>& levels);

/// Runs of one sample, at every intensity: what it draws is the same at all of them, so that its outcomes depend on
/// each other.
struct FragilitySample {
  std::vector<std::size_t> runs, exceeded;  ///< one per intensity
};

struct BootstrapOptions {
  std::size_t replicates = 1000;
  double confidence = 0.95;
  std::uint64_t seed = 1;
};

struct FragilityFit {
  std::optional<FragilityCurve> curve;
  ConfidenceInterval median, deviation;
  std::vector<ConfidenceInterval> at_levels;  ///< of the curve, one per level
  std::vector<ConfidenceInterval> observed;   ///< share of the level's runs, wilson_interval_of_share() by its samples
  std::size_t replicates = 0;  ///< those with a curve: intervals are of them alone, and none where there are under half
};

/// fit_fragility() of all samples, with percentile intervals of a bootstrap: each replicate draws as many samples
/// again, each with its runs at all intensities. A single sample has no intervals.
/// @pre intensities > 0 with runs at each; of each sample as many counts as intensities, exceeded <= runs
[[nodiscard]] FragilityFit fragility_with_bounds(const std::vector<double>& intensities,
                                                 const std::vector<FragilitySample>& samples,
                                                 const BootstrapOptions& options);

}  // namespace railtab
