#pragma once

#include "railtab/runtime/scene/scene_parameters.hpp"

namespace railtab {

/// Whether railtab's track lies on the deck of an imported bridge.
[[nodiscard]] bool track_on_import(const SceneParameters& scene) noexcept;

/// Whether a deck's nodes are known, so that it can be followed all over (OutputParameters::deck_envelope).
[[nodiscard]] bool has_deck_nodes(const SceneParameters& scene) noexcept;

/// The structure of a scene whose track is not rigid. @throws InputError
[[nodiscard]] StructureModel build_structure(const SceneParameters& scene);

}  // namespace railtab
