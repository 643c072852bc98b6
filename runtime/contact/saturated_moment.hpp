#pragma once

#include "railtab/runtime/contact/creep_law.hpp"

namespace railtab {

/// Moment for laws that give a force only: that of linear theory, c23 υy - c33 φ, each part saturated. An estimate,
/// exact in the linear limit, bounded.
///
/// Lateral creepage: on a strip of simplified theory with the parabolic bound the force is 1 - q³ and the moment q³
/// times the linear one (slip from the trailing edge over 1 - q of the strip), so the factor is what the force lacks of
/// the bound. Spin: bounded by the moment of pure sliding spin, and turned away by translation.
/// @param lacking 1 - |F|/(μF_n) of the law at these creepages; must fall as fast as 1/υ
[[nodiscard]] double saturated_moment(const KalkerCoefficients& c, double ratio, const Creepage& creepage,
                                      double lacking) noexcept;

}  // namespace railtab
