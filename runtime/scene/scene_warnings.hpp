#pragma once

#include <string>
#include <vector>

#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

/// Loads, motions and deviations that the scene names and that act nowhere and at no time of its run: most likely a
/// slip, in a time or a place; and those that steps of time may miss or cannot follow. A sentence for each. @throws
/// InputError as the readers of their files
[[nodiscard]] std::vector<std::string> scene_warnings(const SceneParameters& scene, const VsiModel& model);

}  // namespace railtab
