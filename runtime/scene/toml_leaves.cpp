#include "toml_leaves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace railtab::scene {
namespace {

void collect(const toml::table& table, const std::string& prefix, int span, std::vector<Leaf>& leaves) {
  for (const auto& [key, node] : table) {
    Leaf leaf{prefix + std::string(key.str()), &node, key.source().begin.line, span};
    const toml::table* inner = node.as_table();
    if (inner && !inner->empty()) {
      collect(*inner, leaf.path + ".", span, leaves);
    } else {
      leaves.push_back(std::move(leaf));
    }
  }
}

void collect_spans(const Leaf& heading, const std::filesystem::path& file, std::vector<Leaf>& leaves) {
  const toml::array* list = heading.node->as_array();
  if (!list || list->empty() || !list->is_homogeneous(toml::node_type::table)) {
    throw leaf_error(file, heading, heading.node->is_table() ? "[bridge]" : found_text(*heading.node),
                     "one [[bridge]] per span");
  }
  int span = 0;
  for (const toml::node& entry : *list) {
    leaves.push_back({"bridge", &entry, entry.source().begin.line, span});
    collect(*entry.as_table(), "bridge.", span, leaves);
    ++span;
  }
}

}  // namespace

std::vector<Leaf> leaves_of(const toml::table& root, const std::filesystem::path& file) {
  std::vector<Leaf> leaves;
  for (const auto& [key, node] : root) {
    Leaf leaf{std::string(key.str()), &node, key.source().begin.line, -1};
    const toml::table* inner = node.as_table();
    if (leaf.path == "bridge") {
      collect_spans(leaf, file, leaves);
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

std::string found_text(const toml::node& node) {
  if (const toml::value<std::string>* text = node.as_string()) return fmt::format("the text \"{}\"", text->get());
  if (const toml::value<std::int64_t>* whole = node.as_integer()) return fmt::format("{}", whole->get());
  if (const toml::value<double>* number = node.as_floating_point()) return fmt::format("{}", number->get());
  if (const toml::value<bool>* flag = node.as_boolean()) return flag->get() ? "true" : "false";
  std::ostringstream type;
  type << node.type();
  return "a value of type " + type.str();
}

}  // namespace railtab::scene
