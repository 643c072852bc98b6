#pragma once

#include <cmath>

namespace railtab {

/// Friction that falls with the slip velocity w between the surfaces [Polach2005, Eq. 8],
///     μ(w) = μ_0 ((1 − A) e^{−B w} + A),
/// and a layer between them that is softer than steel (third body): creepages count by the share that it leaves of the
/// initial slope of creep force over creepage. Any creep law serves, an exact table too, since μ enters by its scaling.
struct FrictionLaw {
  double limit = 1.0;          ///< A = μ_∞/μ_0, 0..1; 1: constant
  double decay = 0.0;          ///< B [s/m], >= 0
  double initial_slope = 1.0;  ///< over that of clean surfaces, above 0, at most 1

  [[nodiscard]] bool falls() const noexcept { return limit < 1.0 && decay > 0.0; }
  /// μ/μ_0. @param velocity w >= 0 [m/s], a number or a dual number
  template <class T>
  [[nodiscard]] T share(const T& velocity) const {
    using std::exp;
    return (1.0 - limit) * exp(-decay * velocity) + limit;
  }
};

}  // namespace railtab
