#pragma once

#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

/// build_model() before structure.reduction, for a plan that counts and does not solve. @throws InputError
[[nodiscard]] VsiModel build_unreduced_model(const SceneParameters& scene);

}  // namespace railtab
