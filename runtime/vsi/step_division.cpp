#include "railtab/runtime/vsi/step_division.hpp"

#include <algorithm>
#include <cmath>

namespace railtab {

namespace {

constexpr double longest_landing = 1e-3;   // s
constexpr double impact_to_landing = 8.0;  // steps of an impact over those of a landing
constexpr double touch_share = 0.05;       // of the static wheel load: a flange that touches with less makes no impact
constexpr double impact_share = 0.25;  // of the static wheel load: a force that changes by more in a step has an impact

}  // namespace

StepDivision::StepDivision(const IntegrationParameters& p, bool automatic_rule, double wheel_load)
    : automatic_(automatic_rule),
      max_halvings_(p.max_halvings),
      force_jump_(impact_share * wheel_load),
      light_touch_(touch_share * wheel_load) {
  if (!automatic_) return;
  const auto longer = [&](int level, double step) { return std::ldexp(p.time_step, -level) > step * (1.0 + 1e-9); };
  while (longer(impact_level_, impact_to_landing * p.impact_step)) ++impact_level_;
  landing_level_ = impact_level_;
  while (longer(landing_level_, p.impact_step)) ++landing_level_;
}

int StepDivision::coarsest_level(const VsiState& state) const noexcept {
  if (state.time < state.landing_until) return landing_level_;
  return state.time < state.impact_until ? impact_level_ : 0;
}

RejectedEvents StepDivision::rejected_events(int level, ContactForceRule rule) const noexcept {
  if (!automatic_) return RejectedEvents::none;
  if (level < landing_level_) return RejectedEvents::contact_change_and_force_jump;
  return rule == ContactForceRule::endpoint ? RejectedEvents::contact_change : RejectedEvents::none;
}

int StepDivision::begin_impact(const StepReport& rejected, double end, VsiState& state) const noexcept {
  if (rejected.outcome == StepOutcome::force_jumped) {
    state.landing_until = std::max(state.landing_until, end + longest_landing);
    state.impact_until = std::max(state.impact_until, end + longest_impact);
    return landing_level_;
  }
  if (rejected.contact_change == ContactChange::gained) {
    state.landing_until = std::max(state.landing_until, end);
    return landing_level_;
  }
  state.impact_until = std::max(state.impact_until, end);
  return impact_level_;
}

void StepDivision::after_step(ContactChange change, VsiState& state) const noexcept {
  if (!automatic_) return;
  if (change == ContactChange::gained) state.landing_until = state.time + longest_landing;
  if (change != ContactChange::none) state.impact_until = state.time + longest_impact;
}

}  // namespace railtab
