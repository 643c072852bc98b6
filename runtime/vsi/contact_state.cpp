#include "railtab/runtime/vsi/contact_state.hpp"

#include <algorithm>
#include <cmath>

#include "railtab/runtime/base/index.hpp"

namespace railtab {

ContactState contact_state(const ContactSolution& contact, std::size_t wheel) {
  constexpr double flange_angle = 0.2;  // rad: steeper than any tread
  ContactState state = ContactState::separated;
  const auto bears = [&](std::size_t i, double angle) {
    if (contact.normal[wheel][i] <= 0.0) return;
    state = std::max(state, std::abs(angle) > flange_angle ? ContactState::flange : ContactState::tread);
  };
  const WheelContact& of_wheel = contact.contact[wheel];
  if (of_wheel.by_patches()) {
    for (std::size_t i = 0; i < index(of_wheel.patches.count); ++i) bears(i, of_wheel.patches.patch[i].angle);
  } else if (of_wheel.touches()) {
    for (std::size_t i = 0; i < of_wheel.loaded.parts; ++i) bears(i, of_wheel.loaded.part[i].angle);
  }
  return state;
}

std::vector<ContactState> contact_states(const ContactSolution& contact) {
  std::vector<ContactState> result;
  result.reserve(contact.contact.size());
  for (std::size_t wheel = 0; wheel < contact.contact.size(); ++wheel) result.push_back(contact_state(contact, wheel));
  return result;
}

ContactChange contact_change(const ContactSolution& before, const ContactSolution& after, double light_touch) {
  ContactChange change = ContactChange::none;
  for (std::size_t wheel = 0; wheel < after.contact.size(); ++wheel) {
    const ContactState was = contact_state(before, wheel), is = contact_state(after, wheel);
    const bool stays = was != ContactState::separated && is != ContactState::separated;
    const int rail = rail_unknown(static_cast<int>(wheel));
    if (stays && (after.end_force - before.end_force).segment<2>(rail).norm() <= light_touch) continue;
    if (is > was) return ContactChange::gained;
    if (is < was) change = ContactChange::lost;
  }
  return change;
}

double largest_force_change(const ContactSolution& before, const ContactSolution& after) {
  double largest = 0.0;
  for (int wheel = 0; wheel < static_cast<int>(after.contact.size()); ++wheel) {
    const int vertical = rail_unknown(wheel) + 1;
    largest = std::max(largest, std::abs(after.end_force[vertical] - before.end_force[vertical]));
  }
  return largest;
}

}  // namespace railtab
