#include "railtab/runtime/reliability/distribution.hpp"

#include <cmath>
#include <numbers>

namespace railtab {
namespace {

Probability whole_probability(const Distribution& d, double x) noexcept {
  switch (d.kind) {
    case DistributionKind::normal:
      return normal_probability((x - d.first) / d.second);
    case DistributionKind::lognormal:
      return x > 0.0 ? normal_probability(std::log(x / d.first) / d.second) : Probability{0.0, 1.0};
    case DistributionKind::uniform: {
      if (x <= d.first) return {0.0, 1.0};
      if (x >= d.second) return {1.0, 0.0};
      return {(x - d.first) / (d.second - d.first), (d.second - x) / (d.second - d.first)};
    }
    case DistributionKind::weibull: {
      if (!(x > 0.0)) return {0.0, 1.0};
      const double power = std::pow(x / d.first, d.second);
      return {-std::expm1(-power), std::exp(-power)};
    }
    case DistributionKind::gumbel:
      break;
  }
  const double rate = std::exp(-(x - d.first) / d.second);
  return {std::exp(-rate), -std::expm1(-rate)};
}

/// −ln(p), from the complement where p is near 1.
double minus_log(double p, double complement) noexcept { return p < 0.5 ? -std::log(p) : -std::log1p(-complement); }

double whole_quantile(const Distribution& d, Probability p) noexcept {
  switch (d.kind) {
    case DistributionKind::normal:
      return d.first + d.second * normal_quantile(p);
    case DistributionKind::lognormal:
      return d.first * std::exp(d.second * normal_quantile(p));
    case DistributionKind::uniform:
      return p.below < p.above ? d.first + p.below * (d.second - d.first) : d.second - p.above * (d.second - d.first);
    case DistributionKind::weibull:
      return d.first * std::pow(minus_log(p.above, p.below), 1.0 / d.second);
    case DistributionKind::gumbel:
      break;
  }
  return d.first - d.second * std::log(minus_log(p.below, p.above));
}

}  // namespace

Distribution lognormal_of_moments(double mean, double deviation) noexcept {
  const double variation = deviation / mean, square = std::log1p(variation * variation);
  return {DistributionKind::lognormal, mean * std::exp(-0.5 * square), std::sqrt(square)};
}

Distribution gumbel_of_moments(double mean, double deviation) noexcept {
  const double scale = deviation * std::sqrt(6.0) / std::numbers::pi;
  return {DistributionKind::gumbel, mean - std::numbers::egamma * scale, scale};
}

Probability probability(const Distribution& d, double x) noexcept {
  const Probability at_low = whole_probability(d, d.low), at_high = whole_probability(d, d.high);
  const double between = at_low.below < 0.5 ? at_high.below - at_low.below : at_low.above - at_high.above;
  if (x <= d.low) return {0.0, 1.0};
  if (x >= d.high) return {1.0, 0.0};
  const Probability at = whole_probability(d, x);
  return {(at.below - at_low.below) / between, (at.above - at_high.above) / between};
}

double quantile(const Distribution& d, Probability p) noexcept {
  const Probability at_low = whole_probability(d, d.low), at_high = whole_probability(d, d.high);
  const double between = at_low.below < 0.5 ? at_high.below - at_low.below : at_low.above - at_high.above;
  return whole_quantile(d, {at_low.below + p.below * between, at_high.above + p.above * between});
}

}  // namespace railtab
