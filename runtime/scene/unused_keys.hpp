#pragma once

#include <filesystem>
#include <vector>

#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/scene/toml_leaves.hpp"

namespace railtab::scene {

/// Rejects the first key of a scene that has no effect there, by the conditions of the table of keys.
/// @throws InputError with file and line, what contradicts the key's condition, and the condition
void reject_unused_keys(const SceneParameters& scene, const std::filesystem::path& file,
                        const std::vector<Leaf>& leaves);

}  // namespace railtab::scene
