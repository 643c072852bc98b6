#pragma once

#include <string>

#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"

namespace railtab {

/// Why a train that has no state of rest has none, as far as it can be found out: the search is repeated without what
/// acts on the train at t = 0. @param model at rest @param time when rest was sought [s]
[[nodiscard]] std::string no_rest_message(const VsiModel& model, const EquilibriumReport& rest, double time);

/// What to say of a structure that begins at rest under a train that moves; empty where it moves.
[[nodiscard]] std::string start_warning(const EquilibriumReport& start);

/// What to say of wheelsets that train.initial_lateral_shift and initial_yaw press against their rails, so that the run
/// begins with an impact; empty where they do not.
[[nodiscard]] std::string displacement_warning(const SceneParameters& scene, const VsiModel& model,
                                               const VsiState& state);

}  // namespace railtab
