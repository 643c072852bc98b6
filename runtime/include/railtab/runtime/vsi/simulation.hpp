#pragma once

#include <functional>

#include "railtab/runtime/results/step_record.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"

namespace railtab {

/// What a scene will build and what it leaves out, for `vsi run --plan`.
struct RunPlan {
  long structure_dofs = 0, vehicle_dofs = 0;
  int wheels = 0;
  long steps = 0;
  double time_step = 0, duration = 0;  ///< [s]
  std::vector<std::string> built, left_out;
};

/// Called after static equilibrium (with the header) and after each recorded step.
struct RunObserver {
  std::function<void(const ResultHeader&)> start;
  std::function<void(const StepRecord&)> record;
  std::function<void(double fraction)> progress;  ///< 0..1, may be empty
};

[[nodiscard]] RunPlan plan_run(const SceneParameters& scene);

/// Run a scene. Wrong input throws InputError; a run that cannot go on returns a summary with complete = false and the
/// reason, everything computed so far having been passed to the observer.
[[nodiscard]] RunSummary run_scene(const SceneParameters& scene, const RunObserver& observer);

}  // namespace railtab
