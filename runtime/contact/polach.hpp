#pragma once

#include "railtab/runtime/contact/creep_law.hpp"

namespace railtab {

/// Polach [Polach1999], G = μF_n = √(ab) = 1. Force by an ellipsoidal bound over the creepage at the patch's centre,
/// lateral creepage raised to υy + φ a where that is larger, plus a lateral force of spin.
///
/// The method gives no moment: saturated_moment() is returned. @see creep_force
[[nodiscard]] CreepForce polach_creep(const PolachCreep& law, double ratio, const Creepage& creepage) noexcept;

}  // namespace railtab
