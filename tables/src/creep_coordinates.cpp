#include "railtab/tables/creep_coordinates.hpp"

#include <cmath>

namespace railtab {

CreepScale creep_scale(double ratio) noexcept {
  const double inverse = 1.0 / ratio;  // a² = ratio, b² = 1/ratio
  const double x = 3.3 + 0.85 * ratio, y = 2.5 + 1.04 * ratio;
  return {x, y, std::sqrt(0.2 * (x * x * inverse + y * y * ratio)), std::sqrt(0.5 * (ratio + inverse))};
}

std::array<double, 3> creepage_at(const CreepPoint& p, const CreepScale& scale, double radius_unit) noexcept {
  const double rho = radius_unit * p.t / (1.0 - p.t);
  const double across = rho * std::sin(p.alpha);
  return {rho * std::cos(p.alpha) / scale.x, across * std::cos(p.beta) / scale.y,
          across * std::sin(p.beta) / scale.spin};
}

double squeezed_ratio(double ratio, double stretch) noexcept {
  const double x = std::log(ratio) / stretch;
  return x / std::sqrt(1.0 + x * x);
}

double ratio_at(double squeezed, double stretch) noexcept {
  return std::exp(stretch * squeezed / std::sqrt(1.0 - squeezed * squeezed));
}

}  // namespace railtab
