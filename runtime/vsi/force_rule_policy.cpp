#include "railtab/runtime/vsi/force_rule_policy.hpp"

#include <algorithm>

namespace railtab {

ForceRulePolicy::ForceRulePolicy(const VsiModel& model, const IntegrationParameters& parameters, double wheel_load)
    : fixed_(parameters.contact_force), wheel_load_(wheel_load) {
  // The contact points of the published method jump and keep no energy; a constraint has none.
  const bool springs = model.normal_contact == NormalContact::hertz;
  if (!springs || (!fixed_ && model.contact.geometry->is_paper())) fixed_ = ContactForceRule::endpoint;
}

ContactForceRule ForceRulePolicy::rule(const VsiState& state) const noexcept {
  return fixed_.value_or(state.time < state.energy_until ? ContactForceRule::energy : ContactForceRule::endpoint);
}

void ForceRulePolicy::after_step(ContactChange change, ContactForceRule used, double time_step,
                                 VsiState& state) const noexcept {
  if (!automatic()) return;
  if (change != ContactChange::none) state.energy_until = state.time + longest_impact;
  if (used == ContactForceRule::energy && alternates(state)) {
    state.energy_until = std::max(state.energy_until, state.time + 0.5 * time_step);
  }
}

bool ForceRulePolicy::alternates(const VsiState& state) const noexcept {
  constexpr double share = 1e-3;  // of the static wheel load
  double largest = 0.0;
  for (int wheel = 0; wheel < static_cast<int>(state.contact.contact.size()); ++wheel) {
    const auto force = [wheel](const Eigen::VectorXd& f) { return f.segment<2>(rail_unknown(wheel)); };
    largest =
        std::max(largest, (force(state.contact.step_load) - force(state.contact.end_force)).cwiseAbs().maxCoeff());
  }
  return largest > share * wheel_load_;
}

}  // namespace railtab
