// The tables of keys in docs/guide/scene.md are those of the reader's own table.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "railtab/runtime/scene/scene_keys.hpp"

namespace railtab {
namespace {

using Cells = std::vector<std::string>;

std::string row(const Cells& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) line += " " + cell + " |";
  return line + "\n";
}

std::string table(const Cells& heading, const std::vector<Cells>& rows) {
  std::string text = row(heading) + row(Cells(heading.size(), "---"));
  for (const Cells& cells : rows) text += row(cells);
  return text;
}

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : "; ") + part;
  return text;
}

std::string section_of(const SceneKey& key) {
  const std::size_t dot = key.path.find('.');
  return dot == std::string::npos ? "" : key.path.substr(0, dot);
}

/// The guide's heading of a section.
std::string heading_of(const std::string& section) {
  if (section.empty()) return "### Top of the file";
  const bool list = section == "bridge" || section == "support" || section == "load" || section == "wheel" ||
                    section == "profiles" || section == "ground_motion";
  return list ? "### `[[" + section + "]]`" : "### `[" + section + "]`";
}

/// What a number accepts, with its unit: "0.001…200 m/s", "±0.02 m".
std::string interval_of(const SceneKey& key) {
  const KeyRange& bounds = *key.bounds;
  const std::string unit = key.unit.empty() || key.unit == "1" ? "" : " " + key.unit;
  const std::string sign = bounds.either_sign || bounds.low == -bounds.high ? "±" : "";
  const std::string low = bounds.low == -bounds.high ? "" : fmt::format("{:g}…", bounds.low);
  return fmt::format("{}{}{}{:g}{}", bounds.zero ? "0 or " : "", sign, low, bounds.high, unit);
}

/// What a key accepts: "integer 1…100", "table, online, paper", "file", "point -1e+09 to 1e+09".
std::string values_of(const SceneKey& key) {
  if (key.bounds) return (key.type == "number" ? "" : key.type + " ") + interval_of(key);
  if (key.type == "point" || key.type == "numbers")
    return key.type + " " + key.range + (key.unit.empty() ? "" : " " + key.unit);
  return key.type == "choice" || key.type == "profile" || key.type == "vehicle" ? key.range : key.type;
}

/// Conditions of more than half of the keys: the heading of the table names them once.
Cells shared_conditions(const std::vector<SceneKey>& keys) {
  Cells shared;
  for (const SceneKey& key : keys) {
    for (const std::string& condition : key.applies) {
      const auto holds = [&](const SceneKey& k) { return std::ranges::count(k.applies, condition) > 0; };
      const bool known = std::ranges::count(shared, condition) > 0;
      if (!known && 2 * std::ranges::count_if(keys, holds) > std::ssize(keys)) shared.push_back(condition);
    }
  }
  return shared;
}

/// Conditions of a key in brackets: those beyond the shared ones, or all of its own where it lacks a shared one.
std::string conditions_of(const SceneKey& key, const Cells& shared) {
  Cells further = key.applies;
  for (const std::string& condition : shared) {
    if (std::erase(further, condition) == 0)
      return key.applies.empty() ? " (always)" : " (only with " + joined(key.applies) + ")";
  }
  return further.empty() ? "" : " (with " + joined(further) + ")";
}

/// Keys of one row: alike but for their names and, within one group such as track.pad, their defaults.
struct KeyGroup {
  std::string names, stem, values, meaning;
  Cells defaults;
  [[nodiscard]] bool one_default() const {
    return std::ranges::count(defaults, defaults.front()) == std::ssize(defaults);
  }
  [[nodiscard]] Cells cells() const {
    std::string texts;
    for (const std::string& text : defaults) texts += (texts.empty() ? "" : ", ") + text;
    return {names, values, one_default() ? defaults.front() : texts, meaning};
  }
};

/// Adds a key to the row that it belongs to, or a row.
void add_key(std::vector<KeyGroup>& rows, const SceneKey& key, const std::string& conditions) {
  const std::size_t dot = key.path.rfind('.') == std::string::npos ? 0 : key.path.rfind('.');
  const KeyGroup own{
      "`" + key.path + "`", key.path.substr(0, dot), values_of(key), key.meaning + conditions, {key.default_value}};
  const auto found = std::ranges::find_if(rows, [&](const KeyGroup& row) {
    const bool same_default = row.one_default() && row.defaults.front() == key.default_value;
    const bool near = row.stem == own.stem && row.defaults.front().empty() == key.default_value.empty();
    return row.values == own.values && row.meaning == own.meaning && (same_default || near);
  });
  if (found == rows.end()) {
    rows.push_back(own);
    return;
  }
  found->names += ", `" + (found->stem == own.stem ? key.path.substr(dot) : key.path) + "`";
  found->stem = own.stem;
  found->defaults.push_back(key.default_value);
}

std::string keys_of(const std::string& section) {
  std::vector<SceneKey> keys = scene_keys();
  std::erase_if(keys, [&](const SceneKey& key) { return section_of(key) != section; });
  const Cells shared = shared_conditions(keys);
  std::vector<KeyGroup> groups;
  for (const SceneKey& key : keys) add_key(groups, key, conditions_of(key, shared));
  std::vector<Cells> rows;
  for (const KeyGroup& group : groups) rows.push_back(group.cells());
  const std::string condition = shared.empty() ? "" : " (with " + joined(shared) + ")";
  return table({"key", "values", "default", "meaning" + condition}, rows);
}

std::string warnings() {
  std::vector<Cells> rows;
  for (const SceneKey& key : scene_keys()) {
    if (!key.warns.empty()) rows.push_back({"`" + key.path + "`", joined(key.warns)});
  }
  return table({"key", "warning when"}, rows);
}

/// Headings of the guide with the table below each.
std::vector<std::pair<std::string, std::string>> tables_of_guide() {
  std::vector<std::pair<std::string, std::string>> tables;
  for (const SceneKey& key : scene_keys()) {
    const std::string heading = heading_of(section_of(key));
    const bool there = std::any_of(tables.begin(), tables.end(), [&](const auto& t) { return t.first == heading; });
    if (!there) tables.emplace_back(heading, keys_of(section_of(key)));
  }
  tables.emplace_back("### Warnings", warnings());
  return tables;
}

/// Place and length of the first table below a heading.
std::pair<std::size_t, std::size_t> table_below(const std::string& guide, const std::string& heading) {
  const std::size_t at = guide.find("\n" + heading + "\n");
  if (at == std::string::npos) return {guide.size(), 0};
  const std::size_t next = std::min(guide.find("\n##", at + 1), guide.size());
  const std::size_t begin = std::min(guide.find("\n|", at), next) + 1;
  std::size_t end = begin;
  while (end < guide.size() && guide[end] == '|') end = guide.find('\n', end) + 1;
  return {begin, end - begin};
}

/// With RAILTAB_UPDATE_GUIDE set, the test writes the tables (tools/regenerate guide) and passes.
TEST(SceneGuide, HasTheTablesOfTheReader) {
  const std::string file = RAILTAB_SOURCE_DIR "/docs/guide/scene.md";
  std::ifstream stream(file);
  std::string guide((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  const bool update = std::getenv("RAILTAB_UPDATE_GUIDE") != nullptr;
  for (const auto& [heading, expected] : tables_of_guide()) {
    const auto [begin, length] = table_below(guide, heading);
    if (update) {
      guide.replace(begin, length, expected);
    } else {
      EXPECT_EQ(guide.substr(begin, length), expected) << heading << ": tools/regenerate guide writes this table";
    }
  }
  if (update) std::ofstream(file) << guide;
  EXPECT_GT(scene_keys().size(), 150u);
}

/// What the table says of a key is complete.
TEST(SceneGuide, EveryKeyHasAMeaningAndEveryNumberARange) {
  for (const SceneKey& key : scene_keys()) {
    EXPECT_FALSE(key.meaning.empty()) << key.path;
    const bool number = key.type == "number" || key.type == "integer" || key.type == "ratio";
    EXPECT_EQ(number, key.bounds.has_value()) << key.path;
    for (const std::string& condition : key.applies) EXPECT_FALSE(condition.empty()) << key.path;
    for (const std::string& warning : key.warns) EXPECT_FALSE(warning.empty()) << key.path;
  }
}

}  // namespace
}  // namespace railtab
