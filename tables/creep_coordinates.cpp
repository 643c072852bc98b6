#include "railtab/tables/creep_coordinates.hpp"

#include <cmath>

namespace railtab {

namespace {

/// √r for moderate r, bounded: a stronger spread would leave the rest of the axis without nodes.
double spread(double r) { return std::sqrt(r / (1.0 + r / 10.0)); }

}  // namespace

CreepScale creep_scale(double ratio) noexcept {
  const double a = std::sqrt(ratio), b = 1.0 / a;
  const double x = 3.3 + 0.85 * ratio, y = 2.5 + 1.04 * ratio;
  const double x_b = x * b, y_a = y * a;
  const double spin = std::sqrt(0.2 * (x_b * x_b + y_a * y_a));
  return {x, y, spin, std::sqrt(0.5 * (ratio + b * b)), spread(spin / x_b), spread(spin / y_a)};
}

std::array<double, 3> creepage_at(const CreepPoint& p, const CreepScale& scale, double radius_unit) noexcept {
  const double rho = radius_unit * p.t / (1.0 - p.t);
  // Lengths in proportion to u; then its direction.
  const double u_x = std::cos(p.alpha) / scale.alpha, across = std::sin(p.alpha);
  const double u_y = std::cos(p.beta) / scale.beta, u_spin = std::sin(p.beta);
  const double along = rho / std::sqrt(u_x * u_x + across * across);
  const double aside = along * across / std::sqrt(u_y * u_y + u_spin * u_spin);
  return {along * u_x / scale.x, aside * u_y / scale.y, aside * u_spin / scale.spin};
}

double squeezed_ratio(double ratio, double stretch) noexcept {
  const double x = std::log(ratio) / stretch;
  return x / std::sqrt(1.0 + x * x);
}

double ratio_at(double squeezed, double stretch) noexcept {
  return std::exp(stretch * squeezed / std::sqrt(1.0 - squeezed * squeezed));
}

}  // namespace railtab
