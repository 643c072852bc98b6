#include "railtab/runtime/vsi/contact_state.hpp"

#include <algorithm>
#include <cmath>

namespace railtab {

std::vector<ContactState> contact_states(const ContactSolution& contact) {
  constexpr double flange_angle = 0.2;  // rad: steeper than any tread
  std::vector<ContactState> result;
  result.reserve(contact.patches.size());
  for (std::size_t wheel = 0; wheel < contact.patches.size(); ++wheel) {
    const ContactPatches& patches = contact.patches[wheel];
    ContactState state = ContactState::separated;
    for (std::size_t i = 0; i < static_cast<std::size_t>(patches.count); ++i) {
      if (contact.normal[wheel][i] <= 0.0) continue;
      const bool flange = std::abs(patches.patch[i].angle) > flange_angle;
      state = std::max(state, flange ? ContactState::flange : ContactState::tread);
    }
    result.push_back(state);
  }
  return result;
}

ContactChange contact_change(const ContactSolution& before, const ContactSolution& after) {
  const std::vector<ContactState> was = contact_states(before), is = contact_states(after);
  ContactChange change = ContactChange::none;
  for (std::size_t wheel = 0; wheel < is.size(); ++wheel) {
    if (is[wheel] > was[wheel]) return ContactChange::gained;
    if (is[wheel] < was[wheel]) change = ContactChange::lost;
  }
  return change;
}

double largest_force_change(const ContactSolution& before, const ContactSolution& after) {
  double largest = 0.0;
  for (int wheel = 0; wheel < static_cast<int>(after.patches.size()); ++wheel) {
    const int vertical = rail_unknown(wheel) + 1;
    largest = std::max(largest, std::abs(after.end_force[vertical] - before.end_force[vertical]));
  }
  return largest;
}

}  // namespace railtab
