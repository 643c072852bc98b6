#include "railtab/runtime/vsi/derailment.hpp"

#include <fmt/format.h>

#include <cmath>

namespace railtab {
namespace {

// A rail head is 72 mm wide and a wheel 135 mm: beyond, the wheel is beside its rail whatever the profiles.
constexpr double farthest_aside = 0.15;  // m
constexpr double deepest = 0.1;          // m, below the rails
// m, above the rails: higher than any flight from which runs are checked to land (tests/stability)
constexpr double highest = 1.0;

bool touches(const VsiState& state, int wheel) {
  return state.contact.contact[static_cast<std::size_t>(wheel)].touches();
}

/// Where a wheelset stands against the mean of its two rail heads, lateral and down.
Eigen::Vector2d against_rails(const ContactProblem& present, int wheelset) {
  Eigen::Vector2d distance = present.predicted.segment<2>(wheelset_unknowns * wheelset + 1);
  for (int side = 0; side < 2; ++side) {
    distance -= 0.5 * rail_motion(present, present.predicted, wheelset, side).displacement.head<2>();
  }
  return distance;
}

}  // namespace

std::string derailment(const VsiModel& model, const VsiState& state) {
  if (model.normal_contact == NormalContact::rigid) return {};
  for (int wheelset = 0; wheelset < model.wheelsets(); ++wheelset) {
    if (touches(state, 2 * wheelset) && touches(state, 2 * wheelset + 1)) continue;
    const Eigen::Vector2d distance = against_rails(present_contact(model, state), wheelset);
    const double aside = distance[0], down = distance[1];
    if (std::abs(aside) <= farthest_aside && -highest <= down && down <= deepest) continue;
    return fmt::format("wheelset {} has left the rails at t = {:.6g} s: it stands {:.3g} m to the {} and {:.3g} m {}",
                       wheelset + 1, state.time, std::abs(aside), aside < 0.0 ? "left" : "right", std::abs(down),
                       down < 0.0 ? "above" : "below");
  }
  return {};
}

}  // namespace railtab
