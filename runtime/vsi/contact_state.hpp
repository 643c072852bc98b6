#pragma once

#include <vector>

#include "railtab/runtime/vsi/contact_newton.hpp"

namespace railtab {

/// Where a wheel bears on its rail. A wheel that lands, or meets the rail with its flange, begins an impact.
enum class ContactState { separated, tread, flange };

/// How the contact states of a step's wheels differ from those before it; a contact gained counts first.
enum class ContactChange { none, lost, gained };

/// Longest duration of an impact: 1 to 3 ms of a wheel on its tread, 6 to 7 ms of a flange [s].
inline constexpr double longest_impact = 10e-3;

/// By the patches that bear load.
[[nodiscard]] ContactState contact_state(const ContactSolution& contact, std::size_t wheel);
/// Of every wheel.
[[nodiscard]] std::vector<ContactState> contact_states(const ContactSolution& contact);
/// A flange that touches or leaves the rail counts where the wheel's force changes by more than `light_touch` [N].
[[nodiscard]] ContactChange contact_change(const ContactSolution& before, const ContactSolution& after,
                                           double light_touch);

/// Largest change of the rails' vertical forces on wheels between two solutions [N].
[[nodiscard]] double largest_force_change(const ContactSolution& before, const ContactSolution& after);

}  // namespace railtab
