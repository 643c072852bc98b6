#include "railtab/runtime/scene/toml_leaves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "railtab/runtime/vehicle/toml_section.hpp"

namespace railtab::scene {
namespace {

void collect(const toml::table& table, const std::string& prefix, int entry, std::vector<Leaf>& leaves) {
  for (const auto& [key, node] : table) {
    Leaf leaf{prefix + std::string(key.str()), &node, key.source().begin.line, entry};
    const toml::table* inner = node.as_table();
    if (inner && !inner->empty()) {
      collect(*inner, leaf.path + ".", entry, leaves);
    } else {
      leaves.push_back(std::move(leaf));
    }
  }
}

void collect_list(const Leaf& heading, const std::filesystem::path& file, std::vector<Leaf>& leaves) {
  const toml::array* list = heading.node->as_array();
  if (!list || list->empty() || !list->is_homogeneous(toml::node_type::table)) {
    throw leaf_error(file, heading,
                     heading.node->is_table() ? fmt::format("[{}]", heading.path) : found_text(*heading.node),
                     heading.path == "bridge" ? "one [[bridge]] per span" : fmt::format("[[{}]]", heading.path));
  }
  int number = 0;
  for (const toml::node& entry : *list) {
    leaves.push_back({heading.path, &entry, entry.source().begin.line, number});
    collect(*entry.as_table(), heading.path + ".", number, leaves);
    ++number;
  }
}

}  // namespace

bool is_list_section(std::string_view name) noexcept {
  return name == "bridge" || name == "support" || name == "load" || name == "wheel" || name == "profiles" ||
         name == "ground_motion";
}

std::vector<Leaf> leaves_of(const toml::table& root, const std::filesystem::path& file) {
  std::vector<Leaf> leaves;
  for (const auto& [key, node] : root) {
    Leaf leaf{std::string(key.str()), &node, key.source().begin.line, -1};
    const toml::table* inner = node.as_table();
    if (is_list_section(leaf.path)) {
      collect_list(leaf, file, leaves);
    } else if (inner && !inner->empty()) {
      collect(*inner, leaf.path + ".", -1, leaves);
    } else {
      leaves.push_back(std::move(leaf));
    }
  }
  std::stable_sort(leaves.begin(), leaves.end(), [](const Leaf& a, const Leaf& b) { return a.line < b.line; });
  return leaves;
}

InputError leaf_error(const std::filesystem::path& file, const Leaf& leaf, std::string_view found,
                      std::string_view expected) {
  return input_error(fmt::format("{}:{}: {}", file.string(), leaf.line, leaf.path), found, expected);
}

std::string key_before(std::string_view text, toml::source_position place) {
  const auto trimmed = [](std::string_view words) {
    constexpr std::string_view blank = " \t\r";
    const std::size_t first = words.find_first_not_of(blank);
    return first == words.npos ? words.substr(0, 0) : words.substr(first, words.find_last_not_of(blank) - first + 1);
  };
  std::string_view section;
  for (unsigned line = 1; line < place.line; ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view words = trimmed(text.substr(0, end));
    const std::string_view inside = words.substr(std::min(words.find_first_not_of('['), words.size()));
    const std::string_view name = trimmed(inside.substr(0, inside.find(']')));
    const bool heading = words.starts_with('[') && !name.empty() && std::isalpha(static_cast<unsigned char>(name[0]));
    if (heading && name.find_first_of(",\"'") == name.npos) section = name;  // else a line of an array's
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  const std::string_view before = text.substr(0, std::min<std::size_t>(text.find('\n'), place.column - 1));
  const std::size_t equals = before.find('=');
  const std::string_view key = trimmed(before.substr(0, equals));
  if (equals == before.npos || key.empty() || key.front() == '#') return {};
  return section.empty() ? std::string(key) : fmt::format("{}.{}", section, key);
}

}  // namespace railtab::scene
