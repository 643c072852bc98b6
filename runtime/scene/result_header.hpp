#pragma once

#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/vsi/step_record.hpp"
#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

/// What a model says of its wheels, bodies, nodes and profiles.
[[nodiscard]] ResultHeader model_header(const VsiModel& model);

/// The same with the scene and the checksums of its files. @throws InputError where one cannot be read
[[nodiscard]] ResultHeader result_header(const SceneParameters& scene, const VsiModel& model);

}  // namespace railtab
