#pragma once

namespace railtab {

/// A probability and its complement, both to full relative precision: one of them may be far below 1e-16.
struct Probability {
  double below = 0.5;  ///< P(X <= x)
  double above = 0.5;  ///< P(X > x)
};

/// Φ(z) and 1 − Φ(z) of the standard normal distribution.
[[nodiscard]] Probability normal_probability(double z) noexcept;
/// z with Φ(z) = p.below, from the smaller of both parts; ∓∞ at 0 and 1. @pre both parts are within 0 to 1
[[nodiscard]] double normal_quantile(Probability p) noexcept;
[[nodiscard]] inline double normal_quantile(double below) noexcept { return normal_quantile({below, 1.0 - below}); }
/// φ(z)
[[nodiscard]] double normal_density(double z) noexcept;

}  // namespace railtab
