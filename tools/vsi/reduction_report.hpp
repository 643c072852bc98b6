#pragma once

#include "railtab/runtime/scene/scene_parameters.hpp"

namespace railtab::vsi {

/// Prints how far the first `seconds` of a scene with its structure.reduction are from those without.
/// @return exit code @throws InputError, ComputationError
int print_reduction_error(const SceneParameters& scene, double seconds, bool json);

}  // namespace railtab::vsi
