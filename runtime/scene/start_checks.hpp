#pragma once

#include <string>

#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"

namespace railtab {

/// Why a train has no static equilibrium: the search is repeated without what acts on the train at t = 0.
/// @param rest the search that failed @param time at which equilibrium was sought [s]
[[nodiscard]] std::string no_equilibrium_message(const VsiModel& model, const EquilibriumReport& rest, double time);

/// Warning of a structure that begins at rest under a train that moves; empty where it moves with the train.
[[nodiscard]] std::string steady_start_warning(const EquilibriumReport& start);

/// Warning of wheelsets that train.initial_lateral_shift and initial_yaw press against their rails, so that the run
/// begins with an impact; empty where they do not.
[[nodiscard]] std::string displacement_warning(const SceneParameters& scene, const VsiModel& model,
                                               const VsiState& state);

}  // namespace railtab
