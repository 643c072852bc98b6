#pragma once

#include <Eigen/SparseCore>
#include <functional>
#include <memory>
#include <optional>

#include "railtab/runtime/vsi/contact_energy_record.hpp"
#include "railtab/runtime/vsi/contact_law.hpp"
#include "railtab/runtime/vsi/contact_retry.hpp"
#include "railtab/runtime/vsi/force_rule_policy.hpp"
#include "railtab/runtime/vsi/moving_window.hpp"
#include "railtab/runtime/vsi/operator_levels.hpp"
#include "railtab/runtime/vsi/step_division.hpp"

namespace railtab {

/// Adds the wheel forces of a state to its extremes.
void record_wheel_extremes(const VsiModel& model, VsiState& state);

/// ForceElements::rows without their zeros.
using ElongationRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Adds the forces of the vehicles' bump stops to the extremes of a state.
/// @param rows of model.vehicle.elements
void record_stops(const VsiModel& model, const ElongationRows& rows, VsiState& state);

/// What an integrator has counted since it was made.
struct StepCounts {
  long newton_iterations = 0, back_substitutions = 0, halved_steps = 0, impact_steps = 0, active_dofs = 0;
  double window_error = 0.0;  ///< RunSummary
  ContactCounts contact;
};

/// Makes the time steps of a run, divided where the policies ask for it. Operators of divided steps are made when first
/// needed.
class Integrator {
 public:
  /// @param operators of the model, with the parameters' time step and α; outlives this
  /// @param energy  called with the energy account after every step; empty: nobody listens
  Integrator(OperatorLevels& operators, const IntegrationParameters& parameters,
             std::function<void(const EnergyBalance&)> energy, bool contact_energy);

  /// Makes the operators of the first step, which begins at state.time.
  void prepare(VsiState& state);
  /// One time step. False where it does not converge however it is divided.
  [[nodiscard]] bool step(VsiState& state);
  /// From here on as in a run that begins here, with the numbers of a checkpoint alone.
  void reinitialise(VsiState& state);

  [[nodiscard]] const StepCounts& counts() const noexcept { return counts_; }
  [[nodiscard]] const StepTimes& times() const noexcept { return times_; }
  [[nodiscard]] StepTimes& times() noexcept { return times_; }
  [[nodiscard]] std::optional<ContactEnergy> contact_energy() const {
    return energy_record_ ? std::optional(energy_record_->summary()) : std::nullopt;
  }

 private:
  [[nodiscard]] bool make_steps(VsiState& state);
  [[nodiscard]] StepReport attempt(int level, VsiState& state);
  [[nodiscard]] StepReport solve(int level, const StepLimits& limits, VsiState& state);
  [[nodiscard]] StepLimits limits_of(ContactForceRule rule) const;
  const StepOperators& operators(int level, double end);
  void after_step(const StepReport& report, int level, ContactForceRule rule, VsiState& state);

  const VsiModel& model_;
  IntegrationParameters parameters_;
  double wheel_load_;  // static [N]
  ForceRulePolicy force_rule_;
  StepDivision division_;
  ContactRetry retry_;
  std::unique_ptr<ContactLaw> contact_law_;
  StepWorkspace workspace_;
  std::vector<int> pending_;  // of make_steps()
  OperatorLevels& operators_;
  std::optional<MovingWindow> window_;
  DofRange active_;  // degrees of freedom of the structure
  ElongationRows elongation_rows_;
  StepCounts counts_;
  StepTimes times_;
  std::function<void(const EnergyBalance&)> energy_;
  bool contact_energy_;
  std::optional<EnergyAccount> account_;
  std::optional<ContactEnergyRecord> energy_record_;
};

}  // namespace railtab
