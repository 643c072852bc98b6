#include "railtab/runtime/contact/saturated_moment.hpp"

#include <cmath>
#include <numbers>

namespace railtab {

namespace {

/// Moment of pure spin in full sliding under the elliptic pressure, ∫ p r dA = (3/8) a E(1 - b²/a²), with Ramanujan's
/// first formula for the ellipse's perimeter 4 a E (0.4 % low for the slenderest).
double sliding_spin_moment(double a, double b) {
  return 3.0 * std::numbers::pi / 32.0 * (3.0 * (a + b) - std::sqrt((3.0 * a + b) * (a + 3.0 * b)));
}

}  // namespace

double saturated_moment(const KalkerCoefficients& c, double ratio, const Creepage& creepage, double lacking) noexcept {
  const double a = std::sqrt(ratio);
  const double linear_x = c.c11 * creepage.x;
  const double linear_y = c.c22 * creepage.y;
  const double spin = c.c33 * creepage.spin;
  const double relative = spin / sliding_spin_moment(a, 1.0 / a);
  const double size = std::sqrt(1.0 + relative * relative + linear_x * linear_x + linear_y * linear_y);
  return c.c23 * creepage.y * lacking - spin / size;
}

}  // namespace railtab
