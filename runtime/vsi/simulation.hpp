#pragma once

#include <functional>
#include <span>
#include <string_view>

#include "railtab/runtime/vsi/energy_account.hpp"
#include "railtab/runtime/vsi/integration_parameters.hpp"
#include "railtab/runtime/vsi/operator_levels.hpp"
#include "railtab/runtime/vsi/step_record.hpp"
#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

/// Who listens to a run. Every member may be empty.
struct RunObserver {
  std::function<void(std::string_view part)> setup;  ///< every part of the set-up as it begins
  std::function<void(std::string_view note)> note;   ///< what was repaired in measured profiles, sentence by sentence
  /// What the scene names and nothing of its run meets, and a start with an impact, sentence by sentence.
  std::function<void(std::string_view warning)> warning;
  std::function<void(const ResultHeader&)> start;  ///< once, before the first record
  std::function<void()> ready;                     ///< once, when the set-up is over and the first step begins
  /// The initial state, then every output.every steps, and the last step in any case. The listener may change it.
  std::function<void(StepRecord&)> record;
  bool contact_points = true;                  ///< whether records have the wheels' patches
  std::function<void(const VsiState&)> state;  ///< the initial state and that after every step, not of halved ones
  /// After every step, halved ones too: the energy account, kept only where somebody listens. Not for wheels that
  /// follow the rails.
  std::function<void(const EnergyBalance&)> energy;
  bool contact_energy = false;  ///< whether the summary shall say what the account says of the contacts
  std::function<void(double fraction)> progress;                             ///< 0..1
  std::function<void(long step, std::span<const double> state)> checkpoint;  ///< where the iteration begins anew
  std::function<bool()> stop;  ///< asked after every step: true ends the run there, with a checkpoint
};

/// Time integration of a model from time 0 to `duration` [s], with steps halved where Newton fails: the core of
/// run_scene, for models built in code. The first step begins at state.time, a multiple of the time step.
[[nodiscard]] RunSummary simulate(const VsiModel& model, const IntegrationParameters& integration, double duration,
                                  int record_every, VsiState& state, const RunObserver& observer);
/// The same with operators that runs share. @pre they have the integration's time step and α
[[nodiscard]] RunSummary simulate(OperatorLevels& operators, const IntegrationParameters& integration, double duration,
                                  int record_every, VsiState& state, const RunObserver& observer);

/// The record of a state. @param contact_points where false, wheels have no patches and no word on the table's part
void fill_record(const VsiModel& model, const VsiState& state, StepRecord& record, bool contact_points = true);

}  // namespace railtab
