#include "railtab/runtime/reliability/proportion.hpp"

#include <algorithm>
#include <cmath>

#include "railtab/runtime/reliability/standard_normal.hpp"

namespace railtab {
namespace {

double two_sided(double confidence) noexcept { return normal_quantile(0.5 + 0.5 * confidence); }

}  // namespace

ConfidenceInterval wilson_interval(std::size_t hits, std::size_t count, double confidence) noexcept {
  return wilson_interval_of_share(static_cast<double>(hits) / static_cast<double>(count), count, confidence);
}

ConfidenceInterval wilson_interval_of_share(double share, std::size_t count, double confidence) noexcept {
  const double z = two_sided(confidence), n = static_cast<double>(count), p = share;
  const double centre = p + z * z / (2.0 * n), scale = 1.0 + z * z / n;
  const double half = z * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n));
  // at both ends the bound is exactly 0 or 1 but for rounding
  return {p, p == 0.0 ? 0.0 : (centre - half) / scale, p == 1.0 ? 1.0 : (centre + half) / scale};
}

ConfidenceInterval lognormal_interval(double value, double variation, double confidence) noexcept {
  const double width = std::exp(two_sided(confidence) * std::sqrt(std::log1p(variation * variation)));
  return {value, value / width, std::min(1.0, value * width)};
}

}  // namespace railtab
