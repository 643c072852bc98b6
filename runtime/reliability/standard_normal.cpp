#include "railtab/runtime/reliability/standard_normal.hpp"

#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <limits>
#include <numbers>

namespace railtab {
using std::numbers::sqrt2;

Probability normal_probability(double z) noexcept { return {0.5 * std::erfc(-z / sqrt2), 0.5 * std::erfc(z / sqrt2)}; }

double normal_quantile(Probability p) noexcept {
  const double tail = p.below < p.above ? p.below : p.above;
  const double z = tail > 0.0 ? sqrt2 * boost::math::erfc_inv(2.0 * tail) : std::numeric_limits<double>::infinity();
  return p.below < p.above ? -z : z;
}

double normal_density(double z) noexcept { return std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi); }

}  // namespace railtab
