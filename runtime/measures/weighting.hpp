#pragma once

#include <complex>
#include <string_view>
#include <vector>

#include "railtab/runtime/measures/pole_sum.hpp"

namespace railtab {

/// Frequency weightings of accelerations that people feel: band limit, transition from acceleration to velocity, step
/// upward, each by corner frequencies f [Hz] and quality factors Q:
///   H = s²/(s² + s ω1/Q1 + ω1²) · ω2²/(s² + s ω2/Q2 + ω2²)
///       · (1 + s/ω3) ω4²/(s² + s ω4/Q4 + ω4²) · K (s²/ω5² + s/(Q5 ω5) + 1)/(s²/ω6² + s/(Q6 ω6) + 1)         (FM2)
struct Weighting {
  double f1, f2;          ///< band limit, Q = 1/√2
  double f3, f4, Q4;      ///< transition
  double f5, Q5, f6, Q6;  ///< step; f5 = 0: none
  double K = 1.0;
  [[nodiscard]] std::complex<double> response(double frequency) const noexcept;  ///< (FM2) at s = 2πi f
  [[nodiscard]] std::vector<PoleTerm> terms() const;
};

/// [EN12299, Annex C]: vertical and lateral acceleration of railway passengers.
inline constexpr Weighting weighting_b{0.4, 100.0, 16.0, 16.0, 0.63, 2.5, 0.8, 4.0, 0.8, 0.4};
/// [EN12299, Annex C], [ISO2631-1, Annex A]: longitudinal, at the backs of seats.
inline constexpr Weighting weighting_c{0.4, 100.0, 8.0, 8.0, 0.63, 0.0, 0.0, 0.0, 0.0};
/// [EN12299, Annex C], [ISO2631-1, Annex A]: lateral and longitudinal.
inline constexpr Weighting weighting_d{0.4, 100.0, 2.0, 2.0, 0.63, 0.0, 0.0, 0.0, 0.0};
/// [ISO2631-1, Annex A]: vertical. Its K is that of high frequencies: the step has gain (f5/f6)² at low ones.
inline constexpr Weighting weighting_k{0.4,  100.0, 12.5, 12.5, 0.63,
                                       2.37, 0.91,  3.35, 0.91, (2.37 / 3.35) * (2.37 / 3.35)};

inline constexpr double longest_weighted_step = 2e-3;  ///< between samples [s]

/// Whether samples `step` [s] apart are near enough for the weightings.
[[nodiscard]] constexpr bool samples_fast_enough_to_weight(double step) noexcept {
  constexpr double rounding = 1e-6;
  return step <= longest_weighted_step * (1.0 + rounding);
}

/// A weighted series, sample by sample, causal. Within 0.01 of the gain of (FM2) for frequencies up to 100 Hz. The
/// series counts as zero before its first sample.
/// @pre samples_fast_enough_to_weight(step): longer steps change the gain at all frequencies
class WeightedSeries {
 public:
  WeightedSeries(const Weighting& weighting, double step) : sum_(weighting.terms(), step), step_(step) {}
  double add(double acceleration) noexcept { return step_ * sum_.add(acceleration); }

 private:
  PoleSum sum_;
  double step_;
};

}  // namespace railtab
