#include "railtab/runtime/vsi/contact_touch.hpp"

#include <algorithm>
#include <cmath>

namespace railtab {

std::vector<Touch> touches(const ContactSolution& contact) {
  constexpr double flange_angle = 0.2;  // rad: steeper than any tread
  std::vector<Touch> result;
  result.reserve(contact.patches.size());
  for (std::size_t wheel = 0; wheel < contact.patches.size(); ++wheel) {
    const ContactPatches& patches = contact.patches[wheel];
    Touch touch = Touch::none;
    for (std::size_t i = 0; i < static_cast<std::size_t>(patches.count); ++i) {
      if (contact.normal[wheel][i] <= 0.0) continue;
      touch = std::max(touch, std::abs(patches.patch[i].angle) > flange_angle ? Touch::flange : Touch::tread);
    }
    result.push_back(touch);
  }
  return result;
}

TouchChange touch_change(const ContactSolution& before, const ContactSolution& after) {
  const std::vector<Touch> old_touch = touches(before), new_touch = touches(after);
  TouchChange change = TouchChange::none;
  for (std::size_t wheel = 0; wheel < new_touch.size(); ++wheel) {
    if (new_touch[wheel] > old_touch[wheel]) return TouchChange::met;
    if (new_touch[wheel] < old_touch[wheel]) change = TouchChange::left;
  }
  return change;
}

}  // namespace railtab
