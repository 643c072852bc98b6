#pragma once

#include <optional>
#include <vector>

#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/vsi/simulation.hpp"

namespace railtab {

class SharedSetUp;

/// Where an interrupted run goes on: the step and the packed state of its last checkpoint.
struct RunCheckpoint {
  long step = 0;
  std::vector<double> state;
};

/// Run a scene. Wrong input throws InputError; a run that cannot go on returns a summary with complete = false and the
/// reason, everything computed so far having been passed to the observer. A resumed run passes on what comes after its
/// checkpoint, to the last bit what the uninterrupted run would have.
/// @param shared what earlier runs of this process have made, and later ones may take; or null
[[nodiscard]] RunSummary run_scene(const SceneParameters& scene, const RunObserver& observer,
                                   const std::optional<RunCheckpoint>& resume = std::nullopt,
                                   SharedSetUp* shared = nullptr);

/// The same with a model of the scene that is there already.
[[nodiscard]] RunSummary run_scene(const SceneParameters& scene, const VsiModel& model, const RunObserver& observer,
                                   const std::optional<RunCheckpoint>& resume = std::nullopt);

}  // namespace railtab
