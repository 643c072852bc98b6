#include "railtab/runtime/contact/linear_creep.hpp"

#include <algorithm>
#include <cmath>

#include "railtab/runtime/contact/saturated_moment.hpp"

namespace railtab {

CreepForce linear_creep(const LinearCreep& law, double ratio, const Creepage& creepage) noexcept {
  const KalkerCoefficients c = law.coefficients ? *law.coefficients : kalker_coefficients(ratio, law.nu);
  CreepForce force{-c.c11 * creepage.x, -c.c22 * creepage.y - c.c23 * creepage.spin,
                   c.c23 * creepage.y - c.c33 * creepage.spin};
  if (law.saturated) {
    const double f = std::hypot(force.x, force.y);
    // For the moment, spin that cancels the lateral force does not undo its saturation.
    const double larger = std::max(f, std::hypot(c.c11 * creepage.x, c.c22 * creepage.y));
    const double q = larger < 3.0 ? 1.0 - larger / 3.0 : 0.0;
    const double scale = f < 3.0 ? 1.0 - f / 3.0 + f * f / 27.0 : 1.0 / f;  // (1 - q³)/f
    force = {force.x * scale, force.y * scale, saturated_moment(c, ratio, creepage, q * q * q)};
  }
  return force;
}

}  // namespace railtab
