#pragma once

#include "railtab/runtime/scene/scene_parameters.hpp"

namespace railtab {

/// Whether railtab's track lies on the deck of an imported bridge.
[[nodiscard]] bool track_on_import(const SceneParameters& scene) noexcept;

/// Whether a deck's nodes are known, so that it can be followed all over (OutputParameters::deck_envelope).
[[nodiscard]] bool has_deck_nodes(const SceneParameters& scene) noexcept;

/// The structure of a scene whose track is not rigid. @throws InputError
[[nodiscard]] StructureModel build_structure(const SceneParameters& scene);
/// The same for wheels with profiles, under which elements of built rails deflect between their nodes too: one element
/// per bay where the scene leaves their number open.
[[nodiscard]] StructureModel build_structure_under_contacts(SceneParameters scene);

}  // namespace railtab
