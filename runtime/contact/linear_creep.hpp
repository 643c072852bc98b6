#pragma once

#include "railtab/runtime/contact/creep_law.hpp"

namespace railtab {

/// Kalker's linear theory, G = μF_n = √(ab) = 1: F_x = -c11 υx, F_y = -c22 υy - c23 φ, M_z = c23 υy - c33 φ.
/// Saturated: force times (1 - f/3 + f²/27) up to f = 3 and 1/f beyond, f the linear force, to which spin counts
/// ([VermeulenJohnson1964], with spin as Shen, Hedrick & Elkins 1983), and saturated_moment(). @see creep_force
[[nodiscard]] CreepForce linear_creep(const LinearCreep& law, double ratio, const Creepage& creepage) noexcept;

}  // namespace railtab
