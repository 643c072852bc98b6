#pragma once

#include <limits>

#include "railtab/runtime/reliability/standard_normal.hpp"

namespace railtab {

enum class DistributionKind { normal, lognormal, uniform, weibull, gumbel };

/// A continuous distribution of one variable, with the parameters of its kind:
///
///     kind       first        second                      F(x)
///     normal     mean µ       standard deviation σ        Φ((x − µ)/σ)
///     lognormal  median m     logarithmic deviation β     Φ(ln(x/m)/β)
///     uniform    low a        high b                      (x − a)/(b − a)
///     weibull    scale λ      shape k                     1 − exp(−(x/λ)^k)
///     gumbel     mode u       scale s                     exp(−exp(−(x − u)/s))   (of largest values)
///
/// `low` and `high` cut it off and renormalise what is between them.
struct Distribution {
  DistributionKind kind = DistributionKind::normal;
  double first = 0.0, second = 1.0;
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
};

/// From mean > 0 and standard deviation. β² = ln(1 + (σ/µ)²), m = µ·exp(−β²/2)
[[nodiscard]] Distribution lognormal_of_moments(double mean, double deviation) noexcept;
/// From mean and standard deviation: s = σ√6/π, u = µ − γ·s with Euler's γ.
[[nodiscard]] Distribution gumbel_of_moments(double mean, double deviation) noexcept;

/// F(x) and 1 − F(x), cut off at low and high.
[[nodiscard]] Probability probability(const Distribution& distribution, double x) noexcept;
/// x with F(x) = p.below, precise in both tails. @pre 0 < p.below < 1, or p.above > 0 where p.below rounds to 1
[[nodiscard]] double quantile(const Distribution& distribution, Probability p) noexcept;
[[nodiscard]] inline double quantile(const Distribution& distribution, double below) noexcept {
  return quantile(distribution, {below, 1.0 - below});
}

}  // namespace railtab
