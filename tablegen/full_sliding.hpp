#pragma once

#include "railtab/runtime/contact/creep_law.hpp"

namespace railtab {

/// Limit of infinite creepage: everywhere the traction is the friction bound against the rigid slip
/// w = (υx - φ y, υy + φ x), so F = -∫ μp_n w/|w| and M_z = -∫ μp_n (x w_y - y w_x)/|w| over the ellipse under Hertz's
/// pressure. Quadrature with nodes of equal weight; error some 1e-5, most where the slip vanishes inside the ellipse.
/// @param direction only the proportions of the creepages count; not all zero
[[nodiscard]] CreepForce full_sliding_force(double ratio, const Creepage& direction) noexcept;

}  // namespace railtab
