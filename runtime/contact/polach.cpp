#include "railtab/runtime/contact/polach.hpp"

#include <cmath>
#include <numbers>

#include "railtab/runtime/contact/saturated_moment.hpp"

namespace railtab {

namespace {

using std::numbers::pi;

/// |K_M| = (1/3)(1 - δ²)^{3/2} - ε (δ³/3 - δ²/2 + 1/6), δ = (ε² - 1)/(ε² + 1), with 1 - δ factored out: no cancellation
/// at large ε, 2ε/3 at small ε (which is linear theory), at most 0.22.
double spin_saturation(double epsilon) {
  const double one_minus_delta = 2.0 / (1.0 + epsilon * epsilon);
  const double delta = 1.0 - one_minus_delta;
  const double root = epsilon * one_minus_delta;  // √(1 - δ²)
  return root * root * root / 3.0 - epsilon * one_minus_delta * one_minus_delta * (2.0 * delta + 1.0) / 6.0;
}

/// 1 - (2/π)(ε/(1+ε²) + arctan ε), as a difference of small terms at large ε.
double force_lacking(double epsilon) {
  return 2.0 / pi * (std::atan2(1.0, epsilon) - epsilon / (1.0 + epsilon * epsilon));
}

}  // namespace

CreepForce polach_creep(const PolachCreep& law, double ratio, const Creepage& creepage) noexcept {
  const KalkerCoefficients c = kalker_coefficients(ratio, law.nu);
  const double a = std::sqrt(ratio);
  const double b = 1.0 / a;
  const double x = creepage.x;
  const double y = creepage.y;
  const double y_spin = y + creepage.spin * a;
  const double y_c = std::abs(y_spin) > std::abs(y) ? y_spin : y;
  const double total = std::sqrt(x * x + y_c * y_c);  // υ_c
  if (total == 0.0) return {};

  // c_jj of the direction of the translation; in pure spin there is none, and no force of it either.
  const double translation = std::sqrt(x * x + y * y);
  double force = 0.0;
  double epsilon = 0.0;
  if (translation > 0.0) {
    const double gx = c.c11 * x / translation;
    const double gy = c.c22 * y / translation;
    epsilon = 0.25 * pi * std::sqrt(gx * gx + gy * gy) * total;
    const double adhesion = law.k_adhesion * epsilon;
    force = 2.0 / pi * (adhesion / (1.0 + adhesion * adhesion) + std::atan(law.k_slip * epsilon));
  }
  const double spin_width = 1.0 + 6.3 * (1.0 - std::exp(-ratio));
  const double spin_epsilon = 8.0 / 3.0 * b * c.c23 * std::abs(y_c) / spin_width;
  const double spin_force = 9.0 / 16.0 * a * spin_saturation(spin_epsilon) * spin_width * creepage.spin / total;

  return {-force * x / total, -force * y / total - spin_force,
          saturated_moment(c, ratio, creepage, force_lacking(epsilon))};
}

}  // namespace railtab
