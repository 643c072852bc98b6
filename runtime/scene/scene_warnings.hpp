#pragma once

#include <string>
#include <vector>

#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

/// Warnings of the table of keys, a sentence for each: loads, motions and deviations of the scene that act nowhere and
/// at no time of its run, most likely a slip in a time or a position; those that time steps may miss or cannot follow;
/// values that no railway has. @throws InputError as the readers of their files
[[nodiscard]] std::vector<std::string> scene_warnings(const SceneParameters& scene, const VsiModel& model);

/// Warnings of the table of keys that need the state at the begin of the run.
[[nodiscard]] std::vector<std::string> start_warnings(const SceneParameters& scene, const VsiModel& model,
                                                      const VsiState& start);

}  // namespace railtab
