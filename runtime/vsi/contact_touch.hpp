#pragma once

#include <vector>

#include "railtab/runtime/vsi/contact_newton.hpp"
#include "railtab/runtime/vsi/step.hpp"

namespace railtab {

/// How a wheel touches its rail: one that comes down, or meets the rail with its flange, begins an impact.
enum class Touch { none, tread, flange };

/// An impact lasts no longer: 1 to 3 ms of a wheel on its tread, 6 to 7 ms of a flange [s].
inline constexpr double longest_impact = 10e-3;

/// The first period of the contact's vibration at about 1 kHz, in which a wheel that comes down has its peak [s], takes
/// the steps of IntegrationParameters::impact_step; the rest of an impact takes steps so many times as long.
inline constexpr double longest_landing = 1e-3;
inline constexpr double impact_to_landing = 8.0;

/// A wheel whose vertical force changes by more of the static wheel load in one step has hit something.
inline constexpr double hit = 0.25;

/// Of every wheel, by the patches that bear load.
[[nodiscard]] std::vector<Touch> touches(const ContactSolution& contact);
[[nodiscard]] TouchChange touch_change(const ContactSolution& before, const ContactSolution& after);

}  // namespace railtab
