#pragma once

#include <string>
#include <vector>

#include "railtab/runtime/base/dof_indices.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/structure/deck_channels.hpp"
#include "railtab/runtime/structure/structure_model.hpp"

namespace railtab {

/// Whether railtab's track lies on the deck of an imported bridge.
[[nodiscard]] bool track_on_import(const SceneParameters& scene) noexcept;

/// Whether a deck's nodes are known, so that it can be followed all over (OutputParameters::deck_envelope).
[[nodiscard]] bool has_deck_nodes(const SceneParameters& scene) noexcept;

/// The structure of a scene whose track is not rigid. Under wheels with profiles, elements of built rails deflect
/// between their nodes too: one per bay where the scene leaves their number open. @throws InputError
[[nodiscard]] StructureModel scene_structure(const SceneParameters& scene);

/// All that scene_structure() depends on.
struct StructureKey {
  TrackKind track_kind;
  TrackParameters track;
  std::vector<BridgeParameters> spans;
  ImportParameters import;
  std::vector<std::string> file_checksums;  ///< of the files that `import` names
  MotionPlane plane;
  DeckRecord deck;
  NormalContact normal;

  /// @throws InputError where a file cannot be read
  explicit StructureKey(const SceneParameters& scene);
  bool operator==(const StructureKey&) const = default;
};

}  // namespace railtab
