#pragma once

#include <vector>

#include "railtab/runtime/moving_load/modal_deck.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"

namespace railtab::vsi {

/// The spans of a scene, those that are alike once, or its imported bridge.
/// @throws InputError where the scene has no bridge
[[nodiscard]] std::vector<ModalDeck> decks_of_scene(const SceneParameters& scene, const DynamicModes& modes);

}  // namespace railtab::vsi
