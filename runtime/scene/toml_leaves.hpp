#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab::scene {

/// Sections that a scene may have several of: [[bridge]], [[load]], [[ground_motion]].
[[nodiscard]] bool is_list_section(std::string_view name) noexcept;

/// A value of the TOML tree with its full key. `entry` numbers the [[bridge]] (or other such section) it stands in, -1
/// elsewhere; the heading of each is a leaf too, with the path "bridge", since a span of the standard kind has no keys.
struct Leaf {
  std::string path;
  const toml::node* node;
  unsigned line;
  int entry;
  /// "bridge" of "bridge.length".
  [[nodiscard]] std::string_view section() const noexcept { return std::string_view(path).substr(0, path.find('.')); }
};

/// All leaves in the order of the file, so that messages name its first wrong line. The nodes stay owned by `root`.
/// @throws InputError where a section of that kind is not a list of tables.
[[nodiscard]] std::vector<Leaf> leaves_of(const toml::table& root, const std::filesystem::path& file);

/// "scene.toml:12: train.speed: found …, expected …"
[[nodiscard]] InputError leaf_error(const std::filesystem::path& file, const Leaf& leaf, std::string_view found,
                                    std::string_view expected);

/// Key, with its section, of what stands at a place of a text that is no TOML, for its messages; empty where no key
/// stands before it on its line.
[[nodiscard]] std::string key_before(std::string_view text, toml::source_position place);

}  // namespace railtab::scene
