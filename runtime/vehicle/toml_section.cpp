#include "railtab/runtime/vehicle/toml_section.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "railtab/runtime/base/edit_distance.hpp"
#include "railtab/runtime/base/toml_text.hpp"

namespace railtab {

namespace {

constexpr std::array<std::string_view, 4> provenance_keys{"source", "date", "standing", "note"};
const std::vector<std::string> standings{"verified", "assumed", "suspect"};

std::string expected_number(const NumberKind& kind) {
  return fmt::format("a number, {:.6g} to {:.6g}{}{}", kind.low, kind.high, kind.unit.empty() ? "" : " ", kind.unit);
}

std::string nearest(std::string_view key, const std::vector<std::string>& known) {
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, key.size() / 3) + 1;
  for (const std::string& name : known) {
    const std::size_t distance = edit_distance(key, name);
    if (distance >= best_distance) continue;
    best_distance = distance;
    best = name;
  }
  return best;
}

}  // namespace

toml::table parse_toml(const std::string& text, const std::filesystem::path& place) {
  check_toml_bounds(text, place);
  try {
    return toml::parse(text, place.string());
  } catch (const toml::parse_error& wrong) {
    const std::size_t line = wrong.source().begin.line;
    throw InputError(fmt::format("{}:{}: {}", place.string(), line, toml_fault(text, line, wrong.description())));
  }
}

toml::table read_toml(const std::filesystem::path& file, std::string_view what) {
  return parse_toml(read_toml_text(file, what), file);
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

std::string found_not_integer(const toml::node& node) {
  const toml::value<double>* number = node.as_floating_point();
  const bool whole = number && std::floor(number->get()) == number->get() && std::abs(number->get()) < 1e15;
  return whole ? fmt::format("{:.1f}, a number with a decimal point", number->get()) : found_text(node);
}

TomlSection::TomlSection(const std::filesystem::path& file, std::string path, const toml::table& table,
                         Provenance outer, SourcedValues& values)
    : file_(&file), path_(std::move(path)), table_(&table), provenance_(std::move(outer)), values_(&values) {
  for (const std::string_view key : provenance_keys) known_.emplace_back(key);
  if (!path_.empty()) provenance_.note.clear();  // a note is about the table that it stands in
  read_provenance(table, "", provenance_);
  if (!path_.empty()) values_->sections.emplace(path_, provenance_);
}

std::string TomlSection::key_path(std::string_view key) const {
  return path_.empty() ? std::string(key) : fmt::format("{}{}{}", path_, key.empty() ? "" : ".", key);
}

std::string TomlSection::place() const {
  return fmt::format("{}:{}: {}", file_->string(), std::max(1U, static_cast<unsigned>(table_->source().begin.line)),
                     path_);
}

InputError TomlSection::error(std::string_view key, std::string_view found, std::string_view expected) const {
  const toml::node* node = table_->get(key);
  const unsigned line = node ? node->source().begin.line : table_->source().begin.line;
  return input_error(fmt::format("{}:{}: {}", file_->string(), std::max(1U, line), key_path(key)), found, expected);
}

void TomlSection::read_provenance(const toml::table& table, std::string_view key, Provenance& provenance) const {
  for (const std::string_view name : provenance_keys) {
    const toml::node* node = table.get(name);
    if (!node) continue;
    const toml::value<std::string>* text = node->as_string();
    const std::string at = key.empty() ? std::string(name) : fmt::format("{}.{}", key, name);
    const std::string expected =
        name == "standing" ? fmt::format("one of {}", fmt::join(standings, ", ")) : std::string("a text");
    const auto standing = text ? std::find(standings.begin(), standings.end(), text->get()) : standings.end();
    if (!text || text->get().empty() || (name == "standing" && standing == standings.end())) {
      throw input_error(fmt::format("{}:{}: {}", file_->string(), node->source().begin.line, key_path(at)),
                        found_text(*node), expected);
    }
    if (name == "source") provenance.source = text->get();
    if (name == "date") provenance.date = text->get();
    if (name == "note") provenance.note = text->get();
    if (name == "standing") provenance.standing = static_cast<Standing>(standing - standings.begin());
  }
}

const toml::node* TomlSection::find(std::string_view key) {
  known_.emplace_back(key);
  return table_->get(key);
}

const toml::node& TomlSection::require(std::string_view key, std::string_view expected) {
  const toml::node* node = find(key);
  if (node) return *node;
  constexpr std::size_t telling = 6;  // letters: short names, as of inertias, are all near each other
  std::vector<std::string> names;
  for (const auto& entry : *table_) names.emplace_back(entry.first.str());
  const std::string meant = key.size() >= telling ? nearest(key, names) : "";
  throw error(key, meant.empty() ? "nothing" : fmt::format("nothing, but '{}'", key_path(meant)), expected);
}

bool TomlSection::has(std::string_view key) { return find(key) != nullptr; }

double TomlSection::checked(std::string_view key, const toml::node& node, const NumberKind& kind) const {
  Provenance provenance = provenance_;
  const toml::node* number = &node;
  if (const toml::table* sourced = node.as_table()) {
    for (const auto& [name, unused] : *sourced) {
      const bool known = name.str() == "value" ||
                         std::find(provenance_keys.begin(), provenance_keys.end(), name.str()) != provenance_keys.end();
      if (!known) {
        throw error(key, fmt::format("{{ {} = … }}", name.str()),
                    fmt::format("{}, or {{ value = …, source, date, standing, note }}", expected_number(kind)));
      }
    }
    number = sourced->get("value");
    if (!number) throw error(key, "a table without value", expected_number(kind));
    provenance.note.clear();
    read_provenance(*sourced, key, provenance);
  }
  const std::optional<double> value = number->is_number() ? number->value<double>() : std::nullopt;
  if (!value || !(*value >= kind.low && *value <= kind.high)) {
    throw error(key, found_text(*number), expected_number(kind));
  }
  values_->values.push_back({key_path(key), std::string(kind.unit), *value, std::move(provenance)});
  return *value;
}

double TomlSection::number(std::string_view key, const NumberKind& kind) {
  return checked(key, require(key, expected_number(kind)), kind);
}

double TomlSection::number(std::string_view key, const NumberKind& kind, double absent) {
  const toml::node* node = find(key);
  return node ? checked(key, *node, kind) : absent;
}

std::vector<double> TomlSection::numbers(std::string_view key, const NumberKind& kind) {
  const toml::node& node = require(key, fmt::format("a list, each {}", expected_number(kind)));
  const toml::array* list = node.as_array();
  if (!list) return {checked(key, node, kind)};
  if (list->empty()) throw error(key, "an empty list", fmt::format("a list, each {}", expected_number(kind)));
  std::vector<double> result;
  for (const toml::node& entry : *list) result.push_back(checked(key, entry, kind));
  return result;
}

std::vector<std::array<double, 2>> TomlSection::points(std::string_view key, std::string_view units) {
  const std::string expected = fmt::format("points [[a, b], [c, d], …] in {}, 0 < a < c, b and d not below 0", units);
  const toml::array* list = require(key, expected).as_array();
  if (!list || list->empty()) throw error(key, found_text(*table_->get(key)), expected);
  std::vector<std::array<double, 2>> result;
  for (const toml::node& entry : *list) {
    const toml::array* point = entry.as_array();
    std::optional<double> x, y;
    if (point && point->size() == 2) {
      x = point->get(0)->value<double>();
      y = point->get(1)->value<double>();
    }
    constexpr double largest = 1e12;
    const bool valid = x && y && *x >= 0.0 && *y >= 0.0 && *x < largest && *y < largest &&
                       (result.empty() ? *x > 0.0 : *x > result.back()[0]);
    if (!valid && x && y) {
      const std::string after =
          result.empty() ? "first" : fmt::format("after [{}, {}]", result.back()[0], result.back()[1]);
      throw error(key, fmt::format("[{}, {}] {}", *x, *y, after), expected);
    }
    if (!valid) throw error(key, found_text(entry) + " in the list", expected);
    result.push_back({*x, *y});
  }
  return result;
}

std::array<double, 2> TomlSection::interval(std::string_view key, const NumberKind& kind) {
  const std::string expected = fmt::format("[low, high], each {}", expected_number(kind));
  const toml::array* list = require(key, expected).as_array();
  if (!list || list->size() != 2) throw error(key, found_text(*table_->get(key)), expected);
  const double low = checked(key, *list->get(0), kind), high = checked(key, *list->get(1), kind);
  if (!(low < high)) throw error(key, fmt::format("[{}, {}]", low, high), expected);
  return {low, high};
}

int TomlSection::whole_number(std::string_view key, int low, int high, int absent) {
  const toml::node* node = find(key);
  if (!node) return absent;
  const toml::value<std::int64_t>* whole = node->as_integer();
  if (!whole || whole->get() < low || whole->get() > high) {
    throw error(key, found_not_integer(*node), fmt::format("an integer {} to {}", low, high));
  }
  return static_cast<int>(whole->get());
}

bool TomlSection::flag(std::string_view key) {
  const toml::node* node = find(key);
  if (!node) return false;
  if (const toml::value<bool>* value = node->as_boolean()) return value->get();
  throw error(key, found_text(*node), "true or false");
}

std::string TomlSection::text(std::string_view key) {
  const toml::node& node = require(key, "a text");
  const toml::value<std::string>* text = node.as_string();
  if (!text || text->get().empty()) throw error(key, found_text(node), "a text that is not empty");
  return text->get();
}

std::string TomlSection::text_of(std::string_view key, const std::vector<std::string>& allowed) {
  const std::string expected = fmt::format("one of {}", fmt::join(allowed, ", "));
  const toml::node& node = require(key, expected);
  const toml::value<std::string>* text = node.as_string();
  if (text && std::find(allowed.begin(), allowed.end(), text->get()) != allowed.end()) return text->get();
  throw error(key, found_text(node), expected);
}

std::vector<std::pair<std::string, std::string>> TomlSection::pairs(std::string_view key) {
  const std::string expected = "pairs of bodies, such as [[\"bogie-1\", \"car-body\"]]";
  const toml::node& node = require(key, expected);
  const toml::array* list = node.as_array();
  if (!list || list->empty()) throw error(key, found_text(node), expected);
  std::vector<std::pair<std::string, std::string>> result;
  for (const toml::node& entry : *list) {
    const toml::array* pair = entry.as_array();
    const bool two = pair && pair->size() == 2 && pair->get(0)->is_string() && pair->get(1)->is_string();
    if (!two) throw error(key, found_text(entry) + " in the list", expected);
    result.emplace_back(pair->get(0)->as_string()->get(), pair->get(1)->as_string()->get());
  }
  return result;
}

std::optional<TomlSection> TomlSection::find_section(std::string_view key) {
  const toml::node* node = find(key);
  if (!node) return std::nullopt;
  const toml::table* table = node->as_table();
  if (!table) throw error(key, found_text(*node), fmt::format("a section [{}]", key_path(key)));
  return TomlSection(*file_, key_path(key), *table, provenance_, *values_);
}

TomlSection TomlSection::section(std::string_view key) {
  std::optional<TomlSection> found = find_section(key);
  if (!found) throw error(key, "nothing", fmt::format("a section [{}]", key_path(key)));
  return std::move(*found);
}

std::vector<TomlSection> TomlSection::sections(std::string_view key) {
  const toml::node* node = find(key);
  std::vector<TomlSection> result;
  if (!node) return result;
  const toml::array* list = node->as_array();
  if (!list || list->empty() || !list->is_homogeneous(toml::node_type::table)) {
    throw error(key, node->is_table() ? fmt::format("[{}]", key_path(key)) : found_text(*node),
                fmt::format("[[{}]]", key_path(key)));
  }
  for (const toml::node& entry : *list) {
    result.emplace_back(*file_, fmt::format("{}[{}]", key_path(key), result.size() + 1), *entry.as_table(), provenance_,
                        *values_);
  }
  return result;
}

void TomlSection::without_effect(std::initializer_list<std::string_view> keys, std::string_view cause) {
  for (const std::string_view key : keys) idle_.emplace(key, cause);
}

void TomlSection::reject_others() const {
  for (const auto& [key, node] : *table_) {
    const std::string name(key.str());
    if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
    if (const auto idle = idle_.find(name); idle != idle_.end()) {
      throw error(name, fmt::format("a key that has no effect with {}", idle->second),
                  fmt::format("no {}, or no {}", key_path(name), idle->second));
    }
    const std::string meant = nearest(name, known_);
    std::vector<std::string> keys = known_;
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    const std::string suggestion = meant.empty() ? fmt::format("the keys are {}", fmt::join(keys, ", "))
                                                 : fmt::format("did you mean '{}'?", key_path(meant));
    throw InputError(fmt::format("{}:{}: unknown key '{}'; {}", file_->string(), key.source().begin.line,
                                 key_path(name), suggestion));
  }
}

}  // namespace railtab
