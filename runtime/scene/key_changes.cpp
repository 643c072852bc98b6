#include "railtab/runtime/scene/key_changes.hpp"

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <string_view>

#include "railtab/runtime/base/text_lines.hpp"
#include "railtab/runtime/base/toml_text.hpp"
#include "railtab/runtime/scene/toml_leaves.hpp"

namespace railtab::scene {
namespace {

std::string change_text(const KeyChange& change) {
  if (change.value.empty()) return fmt::format("without {}", change.key);
  return fmt::format("{} = {}", change.key, change.value);
}

std::optional<std::size_t> whole_number(std::string_view text) {
  std::size_t value = 0;
  const auto [stop, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (status != std::errc() || stop != text.data() + text.size()) return std::nullopt;
  return value;
}

/// The entry of a [[section]] that a key names; the only one where it names none.
toml::table& entry_of(const KeyChange& change, toml::table& root, std::vector<std::string_view>& parts) {
  const std::string_view section = parts.front();
  toml::array* const list = root.contains(section) ? root.get(section)->as_array() : nullptr;
  const std::size_t count = list ? list->size() : 0;
  parts.erase(parts.begin());
  const std::optional<std::size_t> named = parts.empty() ? std::nullopt : whole_number(parts.front());
  if (named && parts.front().size() > 1 && parts.front().starts_with('0')) {  // each key has one spelling
    throw input_error(change.key, fmt::format("the number {}", parts.front()),
                      fmt::format("{}, without a zero before it", *named));
  }
  if (named) parts.erase(parts.begin());
  const std::size_t number = named.value_or(1);
  if (parts.empty() || number < 1 || number > count || (!named && count > 1)) {
    throw input_error(change.key, fmt::format("{} [[{}]] in the scene", count, section),
                      fmt::format("{0}.1.KEY for a key of the first [[{0}]], and so on", section));
  }
  toml::table* const entry = list->get(number - 1)->as_table();
  if (!entry) throw input_error(change.key, fmt::format("no [[{}]]", section), "a scene whose sections are tables");
  return *entry;
}

/// The value that a change's text stands for.
toml::table parsed(const KeyChange& change) {
  const std::string text = fmt::format("value = {}", change.value);
  try {
    check_toml_bounds(text, change.key);
    toml::table table = toml::parse(text);
    if (table.size() == 1) return table;
  } catch (const toml::parse_error&) {  // said below
  }
  throw input_error(change.key, fmt::format("the value {}", change.value),
                    "a value as TOML writes it: 50.0, \"table\", true, [1, 2]");
}

void change_key(const KeyChange& change, toml::table& root) {
  std::vector<std::string_view> parts;  // of "bridge.2.length"
  cut(change.key, '.', parts);
  toml::table* table = is_list_section(parts.front()) ? &entry_of(change, root, parts) : &root;
  toml::source_region place = table->source();  // of keys that the scene does not have
  for (; parts.size() > 1; parts.erase(parts.begin())) {
    const std::string_view name = parts.front();
    if (!table->contains(name)) {
      if (change.value.empty()) return;
      table->insert(toml::key(name, toml::source_region(place)), toml::table{});
    } else {
      place = table->get(name)->source();
    }
    table = table->get(name)->as_table();
    if (!table) throw input_error(change.key, fmt::format("{}, which is no section", name), "SECTION.KEY");
  }
  const std::string_view name = parts.front();
  if (change.value.empty()) {
    table->erase(name);
    return;
  }
  const toml::table value = parsed(change);
  value.begin()->second.visit([&](const auto& node) {
    if (table->contains(name)) {
      table->insert_or_assign(name, node);  // the key keeps its line
    } else {
      table->insert(toml::key(name, toml::source_region(place)), node);
    }
  });
}

}  // namespace

void change_keys(const std::vector<KeyChange>& changes, toml::table& root) {
  for (const KeyChange& change : changes) change_key(change, root);
}

std::string changes_text(const std::vector<KeyChange>& changes) {
  std::string text;
  for (const KeyChange& change : changes) text += fmt::format("{}{}", text.empty() ? "" : ", ", change_text(change));
  return text;
}

}  // namespace railtab::scene
