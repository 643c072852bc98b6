#include "railtab/runtime/scene/unused_keys.hpp"

#include <fmt/format.h>

#include <map>
#include <utility>

#include "railtab/runtime/scene/key_table.hpp"

namespace railtab::scene {

void reject_unused_keys(const SceneParameters& scene, const std::filesystem::path& file,
                        const std::vector<Leaf>& leaves) {
  // the keys named in each entry of a list of sections, and under -1 those outside
  std::map<std::pair<std::string, int>, KeyNames> named;
  const auto group = [](const Leaf& leaf) {
    return std::pair{leaf.entry < 0 ? std::string() : std::string(leaf.section()), leaf.entry};
  };
  KeyNames& outside = named[{"", -1}];
  for (const Leaf& leaf : leaves) named[group(leaf)].insert(leaf.path);
  for (const Leaf& leaf : leaves) {
    const KeyRow* row = find_key(leaf.path);
    if (!row) continue;  // a heading
    const KeySurroundings at{scene, outside, named[group(leaf)]};
    for (const Condition* condition : row->applies) {
      const std::string found = condition->contradiction(at);
      if (!found.empty()) {
        throw leaf_error(file, leaf, found, fmt::format("{}, or no {}", condition->text, leaf.path));
      }
    }
  }
}

}  // namespace railtab::scene
