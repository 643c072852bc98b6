#pragma once

#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

class SharedSetUp;

/// The model of a scene: reads the table, builds vehicle, structure and irregularity.
/// @param shared what earlier runs of this process have made; or null @throws InputError
[[nodiscard]] VsiModel build_model(const SceneParameters& scene, SharedSetUp* shared = nullptr);
/// The train of a scene by itself: vehicles and where they stand, without contacts and structure. @throws InputError
[[nodiscard]] VsiModel train_model(const SceneParameters& scene);
/// The first vehicle of a scene, or its train where that is one system, by itself on rigid rails, its force elements by
/// linear stand-ins: what linear_stability.hpp takes. @throws InputError
[[nodiscard]] VsiModel stability_model(const SceneParameters& scene);
/// The same with contacts of a model that is there: on the profiles of its wheelsets from `first_wheelset` on.
[[nodiscard]] VsiModel stability_model(const SceneParameters& scene, const VsiModel& model, int first_wheelset = 0);
/// The same with the force elements that its runs have: what hunting_branch.hpp takes. @throws InputError
[[nodiscard]] VsiModel limit_cycle_model(const SceneParameters& scene);
/// Time until the scene's run is over: its duration, or until the last wheelset has left the last span [s].
/// @throws InputError where a scene without a span names no duration.
[[nodiscard]] double run_duration(const SceneParameters& scene, const VsiModel& model);

}  // namespace railtab
