#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "railtab/runtime/results/step_record.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/vsi/energy_account.hpp"
#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

/// What a scene will build and what it leaves out, for `vsi run --plan`.
struct RunPlan {
  long structure_dofs = 0, vehicle_dofs = 0;
  int wheels = 0;
  long steps = 0;
  double time_step = 0, duration = 0;  ///< [s]
  double memory = 0;                   ///< of what the steps work on [bytes]
  std::vector<std::string> built, left_out;
  std::vector<std::string> warnings;  ///< as RunObserver::warning
};

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
  /// After every step, halved ones too: the energy account, kept only where somebody listens. Not for wheels that
  /// follow the rails.
  std::function<void(const EnergyBalance&)> energy;
  bool contact_energy = false;  ///< whether the summary shall say what the account says of the contacts
  std::function<void(double fraction)> progress;                             ///< 0..1
  std::function<void(long step, std::span<const double> state)> checkpoint;  ///< every `checkpoint_every` steps
  long checkpoint_every = 2000;
  std::function<bool()> stop;  ///< asked after every step: true ends the run there, with a checkpoint
};

/// Where an interrupted run goes on: the step and the packed state of its last checkpoint.
struct RunCheckpoint {
  long step = 0;
  std::vector<double> state;
};

/// @param setup every part of it as it begins; may be empty
/// @throws InputError as run_scene() does before its first step, but for a train that has no state of rest
[[nodiscard]] RunPlan plan_run(const SceneParameters& scene,
                               const std::function<void(std::string_view part)>& setup = {});

/// Run a scene. Wrong input throws InputError; a run that cannot go on returns a summary with complete = false and the
/// reason, everything computed so far having been passed to the observer. A resumed run passes on what comes after its
/// checkpoint, to the last bit what the uninterrupted run would have.
[[nodiscard]] RunSummary run_scene(const SceneParameters& scene, const RunObserver& observer,
                                   const std::optional<RunCheckpoint>& resume = std::nullopt);

/// The same with a model of the scene that is there already.
[[nodiscard]] RunSummary run_scene(const SceneParameters& scene, const VsiModel& model, const RunObserver& observer,
                                   const std::optional<RunCheckpoint>& resume = std::nullopt);

/// Time integration of a model from time 0 to `duration` [s], with steps halved where Newton fails: the core of
/// run_scene, for models built in code. `state` is that of step `first_step`.
[[nodiscard]] RunSummary simulate(const VsiModel& model, const IntegrationParameters& integration, double duration,
                                  int record_every, VsiState& state, const RunObserver& observer, long first_step = 0);

/// The record of a state.
void fill_record(const VsiModel& model, const VsiState& state, StepRecord& record);

/// The model of a scene: reads the table, builds vehicle, structure and irregularity. @throws InputError
[[nodiscard]] VsiModel build_model(const SceneParameters& scene);
/// Time until the scene's run is over: its duration, or until the last wheelset has left the last span [s].
/// @throws InputError where a scene without a span names no duration.
[[nodiscard]] double run_duration(const SceneParameters& scene, const VsiModel& model);

}  // namespace railtab
