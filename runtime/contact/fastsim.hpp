#pragma once

#include "railtab/runtime/contact/creep_law.hpp"

namespace railtab {

/// FASTSIM [Kalker1982], G = μF_n = √(ab) = 1, with the three flexibilities of linear theory
/// L1 = 8a/(3 c11), L2 = 8a/(3 c22), L3 = π a √(a/b)/(4 c23).
///
/// Strips along the rolling direction at the middles of equal steps of θ, y = b sin θ: with the strips' exact lengths
/// that quadrature is exact for the parabolic bound and for linear spin. The bound is scaled so that its sum over the
/// elements is 1: the force never exceeds friction, at any number of elements. The moment is that of the tractions.
/// @see creep_force
[[nodiscard]] CreepForce fastsim_creep(const FastsimCreep& law, double ratio, const Creepage& creepage) noexcept;

}  // namespace railtab
