#pragma once

#include <vector>

#include "railtab/runtime/vsi/contact_newton.hpp"

namespace railtab {

/// How a wheel touches its rail: one that comes down, or meets the rail with its flange, begins an impact.
enum class Touch { none, tread, flange };

/// Of every wheel, by the patches that bear load.
[[nodiscard]] std::vector<Touch> touches(const ContactSolution& contact);

}  // namespace railtab
