#pragma once

#include <vector>

#include "railtab/runtime/vsi/contact_newton.hpp"

namespace railtab {

/// How a wheel touches its rail: one that comes down, or meets the rail with its flange, begins an impact.
enum class Touch { none, tread, flange };

/// An impact lasts no longer: 1 to 3 ms of a wheel on its tread, 6 to 7 ms of a flange [s].
inline constexpr double longest_impact = 10e-3;

/// Of every wheel, by the patches that bear load.
[[nodiscard]] std::vector<Touch> touches(const ContactSolution& contact);

}  // namespace railtab
