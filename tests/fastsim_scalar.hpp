#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "railtab/runtime/contact/creep_law.hpp"

namespace railtab::testing {

/// FASTSIM of n x n elements with the parabolic bound and scalar arithmetic [Kalker1982], with the strips of equal
/// angle and the blended flexibility of FastsimCreep. Only an element that slips pays for a root and a division;
/// neighbouring strips take turns, so that their latencies overlap. The geometry of the strips is made once, with the
/// object.
template <int n>
class ScalarFastsim {
 public:
  ScalarFastsim() {
    double along = 0.0, across = 0.0;
    for (int i = 0; i < n; ++i) {
      const double xi = 1.0 - (2 * i + 1.0) / n;
      shape_[i] = 1.0 - xi * xi;
      along += shape_[i];
      const double angle = (i + 0.5) * step - 0.5 * std::numbers::pi;
      y_[i] = std::sin(angle);
      length_[i] = std::cos(angle);
      across += std::pow(length_[i], 4);
    }
    for (double& g : shape_) g *= n / (2.0 * along * across * step);
  }

  [[nodiscard]] CreepForce operator()(double ratio, double nu, const Creepage& creepage) const {
    const double a = std::sqrt(ratio);
    const std::array<double, 3> stiffness = flexibility_inverses(ratio, nu, creepage);
    const double spin_stiffness = stiffness[2] * creepage.spin;
    std::array<Strip, n> strips;
    for (int j = 0; j < n; ++j) {
      const double l = length_[j], dx = 2.0 / n * l;
      Strip& s = strips[j];
      s.grow_x = dx * (spin_stiffness * y_[j] - a * stiffness[0] * creepage.x);
      s.grow_y = -dx * a * stiffness[1] * creepage.y;
      s.turn_y = -dx * l * ratio * spin_stiffness;
      s.x = -0.5 * s.grow_x;
      s.y = -0.5 * s.grow_y - s.turn_y * (0.5 + 0.25 / n);
    }
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) strips[j].step(1.0 - 2.0 / n * i, 1.0 / n, shape_[i] * length_[j] * length_[j]);
    }
    CreepForce total;
    for (int j = 0; j < n; ++j) {
      const double l = length_[j], area = 2.0 / n * l * l * step;
      total.x += area * strips[j].sum_x;
      total.y += area * strips[j].sum_y;
      total.moment += area * (a * l * strips[j].sum_xi_y - y_[j] * strips[j].sum_x / a);
    }
    return total;
  }

 private:
  /// Traction of a strip on its way to the trailing edge, its growth per element, and its sums.
  struct Strip {
    double x, y, grow_x, grow_y, turn_y, sum_x = 0.0, sum_y = 0.0, sum_xi_y = 0.0;

    void step(double xi, double half, double bound) {
      x += grow_x;
      y += grow_y + turn_y * xi;
      const double size = x * x + y * y;
      if (size > bound * bound) {
        const double cut = bound / std::sqrt(size);
        x *= cut;
        y *= cut;
      }
      sum_x += x;
      sum_y += y;
      sum_xi_y += (xi - half) * y;
    }
  };

  static constexpr double step = std::numbers::pi / n;

  static std::array<double, 3> flexibility_inverses(double ratio, double nu, const Creepage& u) {
    const KalkerCoefficients c = kalker_coefficients(ratio, nu);
    const double a = std::sqrt(ratio), arm = 3.0 * std::numbers::pi / 32.0 * a;
    const double x = u.x * u.x, y = u.y * u.y, spin = u.spin * u.spin, total = x + y + arm * arm * spin;
    std::array<double, 3> k{0.375 * c.c11 / a, 0.375 * c.c22 / a, 4.0 * c.c23 / (std::numbers::pi * ratio)};
    if (total == 0.0) return k;
    const double one = total / (x * k[0] + y * k[1] + arm * arm * spin * k[2]);
    const double linear = 1.0 / (c.c11 * c.c11) + 1.0 / (c.c22 * c.c22) + 1.0 / (c.c23 * c.c23);
    const double weight = std::min(std::sqrt((x + y + spin) / linear) / 3.0, 1.0);
    for (double& each : k) each = 1.0 / ((1.0 - weight) / each + weight * one);
    return k;
  }

  std::array<double, n> shape_{}, y_{}, length_{};
};

}  // namespace railtab::testing
