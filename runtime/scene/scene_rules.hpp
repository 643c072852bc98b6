#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "railtab/runtime/scene/scene_parameters.hpp"

namespace railtab::scene {

/// What of a scene breaks a rule: where, what was found, what is allowed.
struct Violation {
  std::string place, found, expected;
};

/// A rule over several keys, which no row of the table of keys can state.
struct SceneRule {
  std::string_view name;
  std::optional<Violation> (*violation)(const SceneParameters& scene);
};

[[nodiscard]] const std::vector<SceneRule>& scene_rules();

}  // namespace railtab::scene
