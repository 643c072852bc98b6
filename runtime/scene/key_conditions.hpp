#pragma once

#include <functional>
#include <set>
#include <string>
#include <string_view>

#include "railtab/runtime/scene/scene_parameters.hpp"

namespace railtab::scene {

using KeyNames = std::set<std::string, std::less<>>;

/// What a key stands beside in a scene: all that was read, and the keys that the scene names.
struct KeySurroundings {
  const SceneParameters& scene;
  const KeyNames& named;           ///< outside the lists of sections
  const KeyNames& named_in_entry;  ///< in the key's own [[bridge]], [[load]] …
  [[nodiscard]] bool names(std::string_view path) const {
    return named.contains(path) || named_in_entry.contains(path);
  }
};

/// When a key has an effect. Where its condition does not hold, the key is a misunderstanding and is rejected.
struct Condition {
  std::string_view text;  ///< as the guide and messages say it: contact.normal = "hertz"
  /// What of the scene contradicts it: contact.normal = "rigid"; empty where the condition holds.
  std::string (*contradiction)(const KeySurroundings& at);
};

// Keys of which a scene names only one.
extern const Condition without_speed_kmh, without_speed_file, without_contact_table, without_irregularity_file,
    without_damping_type, without_friction_file, without_duration;
// Vehicles and contact.
extern const Condition without_consist, without_imported_vehicle;
extern const Condition with_imported_vehicle, with_contact_table, with_hertz_contact, with_creep_table_law,
    with_polach_law, with_built_in_rail, with_speed_file, with_automatic_contact_force, with_smooth_search;
// Loads.
extern const Condition with_aerodynamics;
// The line.
extern const Condition with_spectrum, with_turning_spans;
// Track and structure.
extern const Condition with_any_structure, with_flexible_track, with_ballast_on_deck, with_imported_structure,
    with_structure_nodes, with_imported_rails, with_deck_nodes, with_use_of_deck, with_model_nodes, with_matrices,
    with_imported_matrices, with_modes;
// Records.
extern const Condition with_deck_envelope, with_sections;
// structure.reduction; "none", written out, is a reduction that was switched off, whose keys may stay.
extern const Condition with_structure_to_reduce, with_window;

}  // namespace railtab::scene
