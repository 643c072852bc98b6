#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "railtab/runtime/scene/plan_memory.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

/// What a model has been built of and what was left out because nothing in the scene needs it.
struct ModelParts {
  std::vector<std::string> built, left_out;
};
[[nodiscard]] ModelParts model_parts(const SceneParameters& scene, const VsiModel& model);

/// What a scene will build and what it leaves out, for `vsi run --plan`.
struct RunPlan : ModelParts {
  long structure_dofs = 0, vehicle_dofs = 0;
  int wheels = 0;
  long steps = 0, pre_roll_steps = 0;  ///< recorded from t = 0 on; before
  double time_step = 0, duration = 0;  ///< [s]
  PlannedMemory memory;
  std::vector<std::string> warnings;  ///< as RunObserver::warning
};

/// @param setup every part of it as it begins; may be empty
/// @throws InputError as run_scene() does before its first step, but for a train that has no state of rest
[[nodiscard]] RunPlan plan_run(const SceneParameters& scene,
                               const std::function<void(std::string_view part)>& setup = {});

}  // namespace railtab
