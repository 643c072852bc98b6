#pragma once

#include <string>
#include <vector>

#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/vehicle/toml_section.hpp"

namespace railtab::scene {

/// Changes a scene's keys before it is read. New keys stand where their section begins.
/// @throws InputError naming the key: no TOML value, no section, an entry of a list that is not there
void change_keys(const std::vector<KeyChange>& changes, toml::table& root);

/// "train.speed = 50.0, without train.speed_kmh": for messages and for the scene that results keep.
[[nodiscard]] std::string changes_text(const std::vector<KeyChange>& changes);

}  // namespace railtab::scene
