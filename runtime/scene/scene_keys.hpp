#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"

namespace railtab {

/// One key that a scene may have, as the reader knows it: the source of the key list in docs/guide/scene.md.
struct SceneKey {
  std::string path;      ///< "train.speed"; keys of each [[bridge]] are "bridge.…"
  std::string type;      ///< number, integer, text, file, choice, ratio, profile
  std::string unit;      ///< "m/s", "1" for dimensionless, empty where a unit makes no sense
  std::string range;     ///< what is accepted: "> 0", "0 to 2", "table, online, paper"
  std::string standard;  ///< value where the scene does not name the key; empty: none
  std::string meaning;
};

/// All keys of a scene, in the order of the guide.
[[nodiscard]] std::vector<SceneKey> scene_keys();

/// What a model refuses in a scene, as the user has to see it: "scene: train.start: found …" becomes
/// "scene.toml:7: train.start: found …", with the line where the scene names that key once. Other messages stay.
[[nodiscard]] InputError with_scene_line(const InputError& wrong, const SceneParameters& scene,
                                         const std::filesystem::path& file);

}  // namespace railtab
