#pragma once

#include <optional>

#include "railtab/runtime/vsi/contact_state.hpp"
#include "railtab/runtime/vsi/integration_parameters.hpp"
#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

/// Decides which contact forces stand in Eq. 12. Under the automatic rule a step in which a wheel meets or leaves its
/// rail and those of the following 10 ms keep the contacts' energy, and further ones until the contacts' part of Eq. 12
/// no longer alternates about the force, since a change of the rule would leave an impulse behind.
class ForceRulePolicy {
 public:
  /// @param wheel_load static [N]
  ForceRulePolicy(const VsiModel& model, const IntegrationParameters& parameters, double wheel_load);

  [[nodiscard]] bool automatic() const noexcept { return !fixed_; }
  [[nodiscard]] bool may_keep_energy() const noexcept { return fixed_ != ContactForceRule::endpoint; }
  /// Of a step that begins at the state.
  [[nodiscard]] ContactForceRule rule(const VsiState& state) const noexcept;
  /// After an accepted step of the length `time_step` under `used`.
  void after_step(ContactChange change, ContactForceRule used, double time_step, VsiState& state) const noexcept;

 private:
  [[nodiscard]] bool alternates(const VsiState& state) const noexcept;

  std::optional<ContactForceRule> fixed_;  // none: automatic
  double wheel_load_;
};

}  // namespace railtab
