#pragma once

#include "railtab/runtime/scene/scene_parameters.hpp"

namespace railtab::scene {

/// Holds a scene that a program has put together against the ranges of the table of keys. Track and spans are left to
/// their own validate(), which asks for what their equations need: the table's ranges for them are narrower, so that a
/// file in other units is noticed. @throws InputError naming the key, the value and the range
void require_ranges(const SceneParameters& scene);

}  // namespace railtab::scene
