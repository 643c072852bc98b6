#pragma once

#include <cmath>
#include <numbers>

namespace railtab {

/// Of the pressure on an area, about its centre of pressure and weighted with it.
struct PressureMoments {
  double xx = 0.0, xs = 0.0, ss = 0.0;  ///< ⟨x²⟩, ⟨x s⟩, ⟨s²⟩ > 0 [m²]
  double mean_pressure = 0.0;           ///< ⟨p⟩ = ∫ p² dA / ∫ p dA > 0 [Pa]
};

/// The ellipse by which a creep law takes any area under pressure. A Hertzian pressure under the force N has the second
/// moments a²/5 and b²/5, and the mean pressure 9 N/(8 π a b). For other pressures these belong to different
/// ellipses: this one has the axis ratio of the second moments and the geometric mean of the two areas. Its creep force
/// is closer to the solution on the true area than that of the second moments alone
/// (docs/validation/loaded_contact.md).
struct EllipseOfPressure {
  double a, b;  ///< semi-axes, a along x at one s [m]
  double skew;  ///< ⟨x s⟩/⟨s²⟩ [-]

  /// By the second moments alone.
  explicit EllipseOfPressure(const PressureMoments& m)
      : a(std::sqrt(5.0 * (m.xx - m.xs * m.xs / m.ss))), b(std::sqrt(5.0 * m.ss)), skew(m.xs / m.ss) {}
  EllipseOfPressure(const PressureMoments& m, double force) : EllipseOfPressure(m) {
    const double by_pressure = 1.125 * force / (std::numbers::pi * m.mean_pressure);
    const double scale = std::pow(by_pressure / (a * b), 0.25);
    a *= scale;
    b *= scale;
  }
};

}  // namespace railtab
