#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"

namespace railtab {

/// Numbers that a key accepts: finite, and from `low` to `high`.
struct KeyRange {
  double low, high;
  bool zero = false;         ///< 0 is accepted too
  bool either_sign = false;  ///< the range is that of the magnitude
  /// False for NaN and for infinities.
  [[nodiscard]] bool accepts(double value) const noexcept;
  [[nodiscard]] std::string text() const;  ///< "0.001 to 200", "0 or 10 to 100000 of either sign"
};

/// One key that a scene may have, as the reader knows it: the source of the tables in docs/guide/scene.md.
struct SceneKey {
  std::string path;  ///< "train.speed"; keys of each [[bridge]] are "bridge.…"
  std::string type;  ///< number, integer, text, file, choice, ratio, profile, point, numbers, list of texts
  std::string unit;  ///< "m/s", "1" for dimensionless, empty where a unit makes no sense
  std::optional<KeyRange> bounds;  ///< of numbers and integers
  std::string range;               ///< what is accepted: "0.001 to 200", "table, online, paper"
  std::string default_value;       ///< where the scene does not name the key; empty: none
  std::string meaning;
  std::vector<std::string> applies;  ///< conditions without which the key is rejected: contact.normal = "hertz"
  std::vector<std::string> warns;    ///< when a run warns of the key's value
};

/// All keys of a scene, in the order of the guide.
[[nodiscard]] std::vector<SceneKey> scene_keys();

/// "train.start: found …" of an error of the model's, which begins with "scene: "; other messages as they are.
[[nodiscard]] std::string_view without_scene(std::string_view message) noexcept;

/// An error of the model's with the line of the scene: "scene: train.start: found …" becomes
/// "scene.toml:7: train.start: found …", with the line where the scene names that key once. Other messages stay.
[[nodiscard]] InputError with_scene_line(const InputError& wrong, const SceneParameters& scene,
                                         const std::filesystem::path& file);

}  // namespace railtab
