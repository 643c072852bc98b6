#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "railtab/tables/input_error.hpp"

namespace railtab::scene {

/// A value of the TOML tree with its full key. `span` numbers the [[bridge]] it stands in, -1 elsewhere; the heading
/// of each [[bridge]] is a leaf too, with the path "bridge", since a span of the standard kind has no keys.
struct Leaf {
  std::string path;
  const toml::node* node;
  unsigned line;
  int span;
};

/// All leaves in the order of the file, so that messages name its first wrong line. The nodes stay owned by `root`.
/// @throws InputError where bridge is not a list of tables.
[[nodiscard]] std::vector<Leaf> leaves_of(const toml::table& root, const std::filesystem::path& file);

/// "scene.toml:12: train.speed: found …, expected …"
[[nodiscard]] InputError leaf_error(const std::filesystem::path& file, const Leaf& leaf, std::string_view found,
                                    std::string_view expected);

/// What a message shows of a value.
[[nodiscard]] std::string found_text(const toml::node& node);

}  // namespace railtab::scene
