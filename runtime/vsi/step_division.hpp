#pragma once

#include "railtab/runtime/vsi/contact_state.hpp"
#include "railtab/runtime/vsi/integration_parameters.hpp"
#include "railtab/runtime/vsi/step.hpp"
#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

/// Decides how a time step is divided: at impacts, where the force rule is automatic, and where a step diverges. Level
/// n is the time step divided by 2ⁿ (docs/theory/time_integration.md).
///
/// In the first period of the contact's vibration, about 1 ms, a wheel that lands has its largest force: steps there
/// are no longer than IntegrationParameters::impact_step. The rest of an impact takes steps of at most eight times
/// that.
class StepDivision {
 public:
  /// @param wheel_load static [N]
  StepDivision(const IntegrationParameters& parameters, bool automatic_rule, double wheel_load);

  /// The coarsest level of a step that begins at the state.
  [[nodiscard]] int coarsest_level(const VsiState& state) const noexcept;
  /// Events that reject a step of this level under a force rule.
  [[nodiscard]] RejectedEvents rejected_events(int level, ContactForceRule rule) const noexcept;
  [[nodiscard]] double force_jump() const noexcept { return force_jump_; }
  [[nodiscard]] double light_touch() const noexcept { return light_touch_; }

  /// A step to `end` was rejected for an event: until there, and after a force jump for the time of an impact, steps
  /// take the level returned or a finer one. A wheel that runs onto a kink stays on its rail, but its force vibrates as
  /// after a landing.
  int begin_impact(const StepReport& rejected, double end, VsiState& state) const noexcept;
  /// After an accepted step: for how long steps are those of an impact.
  void after_step(ContactChange change, VsiState& state) const noexcept;

  /// Whether a step that diverged may be halved once more.
  [[nodiscard]] bool may_halve(int level, int coarsest) const noexcept { return level - coarsest < max_halvings_; }

 private:
  bool automatic_;
  int impact_level_ = 0;   // of a step of an impact
  int landing_level_ = 0;  // of one just after a wheel has met its rail
  int max_halvings_;
  double force_jump_, light_touch_;  // [N]
};

}  // namespace railtab
