#pragma once

#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

/// Coach and number within it, both from 1.
struct PlaceInTrain {
  int coach, wheelset;
};
/// Places of the wheelsets of the train, front first.
[[nodiscard]] std::vector<PlaceInTrain> wheelset_places(const VsiModel& model);

/// Wheels that are not round, read into a model whose vehicle and positions are there already. Entries of [[wheel]] add
/// up. @throws InputError naming the entry
void add_wheel_deviations(const SceneParameters& scene, VsiModel& model);

/// Friction along the track and the speed floor of creepages. @throws InputError with file and line
void add_friction(const SceneParameters& scene, VsiModel& model);

}  // namespace railtab
