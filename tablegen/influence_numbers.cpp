#include "railtab/tablegen/influence_numbers.hpp"

#include <cmath>
#include <initializer_list>
#include <numbers>

namespace railtab {

namespace {

/// ln(u + r) with r = √(u² + v²), without cancellation for negative u.
double log_sum(double u, double v, double r) { return u > 0.0 ? std::log(u + r) : std::log(v * v / (r - u)); }

/// Antiderivatives at one corner of the element.
InfluenceNumber corner(double x, double y, double nu) {
  const double r = std::hypot(x, y);
  const double x_part = y * log_sum(x, y, r);  // ∫∫ x²/r³ = y ln(x + r)
  const double y_part = x * log_sum(y, x, r);  // ∫∫ y²/r³ = x ln(y + r); their sum is ∫∫ 1/r
  const double both = (1.0 - nu) * (x_part + y_part);
  return {both + nu * x_part, -nu * r, both + nu * y_part};
}

}  // namespace

InfluenceNumber influence_number(double x, double y, double dx, double dy, double nu) noexcept {
  InfluenceNumber sum{0.0, 0.0, 0.0};
  for (const int i : {-1, 1}) {
    for (const int j : {-1, 1}) {
      const InfluenceNumber c = corner(x + 0.5 * i * dx, y + 0.5 * j * dy, nu);
      const double weight = i * j / std::numbers::pi;
      sum.xx += weight * c.xx;
      sum.xy += weight * c.xy;
      sum.yy += weight * c.yy;
    }
  }
  return sum;
}

}  // namespace railtab
