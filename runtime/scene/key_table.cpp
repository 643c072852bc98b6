#include "railtab/runtime/scene/key_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "railtab/runtime/base/edit_distance.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"

namespace railtab::scene {
namespace {

std::string_view leaf(std::string_view path) {
  const std::size_t dot = path.rfind('.');
  return dot == std::string_view::npos ? path : path.substr(dot + 1);
}

std::string_view heading(std::string_view path) { return path.substr(0, path.size() - leaf(path).size()); }

/// Six digits are what a reader of the guide wants to see; the members themselves keep full precision.
std::string rounded(double value) { return fmt::format("{:.6g}", value); }

SceneKey describe(const KeyRow& key, SceneDraft& draft) {
  SceneKey result{std::string(key.path), "", std::string(key.unit), {}, "", "", std::string(key.meaning), {}, {}};
  for (const Condition* condition : key.applies) result.applies.emplace_back(condition->text);
  for (const Warning* warning : key.warns) result.warns.emplace_back(warning->when);
  const auto set = [&](std::string type, std::string range, std::string value) {
    result.type = std::move(type);
    result.range = std::move(range);
    result.default_value = std::move(value);
  };
  const auto set_number = [&](std::string type, const Range& range, std::string value) {
    result.bounds = range;
    set(std::move(type), range.text(), std::move(value));
  };
  std::visit(Overloaded{
                 [&](const NumberKey& k) { set_number("number", k.range, rounded(k.member(draft))); },
                 [&](const OptionalNumberKey& k) { set_number("number", k.range, ""); },
                 [&](const RatioKey& k) { set_number("ratio", k.range, rounded(k.member(draft))); },
                 [&](const IntegerKey& k) {
                   set_number("integer", {double(k.low), double(k.high)}, std::to_string(k.member(draft)));
                   result.range = fmt::format("{} to {}", k.low, k.high);
                 },
                 [&](const TextKey& k) {
                   set(k.names ? "choice" : "text", k.names ? joined(k.names()) : "any", k.member(draft));
                 },
                 [&](const FileKey&) { set("file", "an existing file", ""); },
                 [&](const ProfileKey& k) {
                   set("profile", joined(standard_profile_names(k.kind)) + " or a profile file", k.member(draft));
                 },
                 [&](const VehicleKey& k) {
                   set("vehicle", "a name of `vsi vehicle`, a vehicle's TOML file, or imported", k.member(draft));
                 },
                 [&](const ConsistKey&) {
                   set("list of texts", "`NAME`, `NAME*N`, `-NAME`: names as for `train.vehicle`", "");
                 },
                 [&](const ChoiceKey& k) { set("choice", joined(k.names), k.names[k.get(draft)]); },
                 [&](const ReductionKey&) { set("choice", "none, window", "none"); },
                 [&](const TextListKey& k) {
                   const std::vector<std::string>& list = k.member(draft);
                   set("list of texts", "any", list.empty() ? "" : fmt::format("[\"{}\"]", fmt::join(list, "\", \"")));
                 },
                 [&](const SwitchKey& k) { set("choice", "true, false", k.member(draft) ? "true" : "false"); },
                 [&](const PointKey& k) {
                   const std::optional<Point>& point = k.member(draft);
                   set("point", k.range.text(), point ? fmt::format("{}", fmt::join(*point, ", ")) : "");
                 },
                 [&](const NumberListKey& k) { set("numbers", k.range.text(), ""); },
             },
             key.value);
  return result;
}

}  // namespace

std::vector<KeyRow> applying(const Condition& condition, std::vector<KeyRow> rows) {
  for (KeyRow& row : rows) row.applies.insert(row.applies.begin(), &condition);
  return rows;
}

std::vector<KeyRow> all_of(std::initializer_list<std::vector<KeyRow>> parts) {
  std::vector<KeyRow> all;
  for (const std::vector<KeyRow>& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

const std::vector<KeyRow>& all_keys() {
  // the guide goes from the train down to the bridge, then to the numerics
  static const std::vector<KeyRow> keys =
      all_of({train_keys(), vehicle_keys(), contact_keys(), profile_keys(), track_keys(), bridge_keys(), import_keys(),
              reduction_keys(), held_node_keys(), irregularity_keys(), wheel_keys(), load_keys(), integration_keys(),
              assessment_keys()});
  return keys;
}

const KeyRow* find_key(std::string_view path) {
  static const auto rows = [] {
    std::map<std::string_view, const KeyRow*> map;
    for (const KeyRow& row : all_keys()) map.emplace(row.path, &row);
    return map;
  }();
  const auto found = rows.find(path);
  return found == rows.end() ? nullptr : found->second;
}

std::string joined(const std::vector<std::string>& names) { return fmt::format("{}", fmt::join(names, ", ")); }

std::string expected_number(const Range& range, std::string_view unit) {
  const bool plain = unit.empty() || unit == "1";
  return fmt::format("a number, {}{}{}", range.text(), plain ? "" : " ", plain ? "" : unit);
}

std::string nearest_key(std::string_view path) {
  // in hundredths of an edit, so that the heading decides between equal names
  constexpr std::size_t one = 100;
  std::string_view best;
  std::size_t best_distance = one * (std::max<std::size_t>(2, path.size() / 3) + 1);
  for (const KeyRow& key : all_keys()) {
    const std::size_t edits = edit_distance(path, key.path);
    // a key that stands under the wrong heading is nearer than a misspelling, but for one whose end or beginning it is
    const bool part = heading(key.path) == heading(path) &&
                      (leaf(key.path).starts_with(leaf(path)) || leaf(key.path).ends_with(leaf(path)));
    const bool elsewhere = leaf(key.path) == leaf(path);
    const std::size_t distance = part ? edits : elsewhere ? one + edits : one * edits;
    if (distance < best_distance) {
      best_distance = distance;
      best = key.path;
    }
  }
  return std::string(best);
}

}  // namespace railtab::scene

namespace railtab {

bool KeyRange::accepts(double value) const noexcept {
  if (zero && value == 0.0) return true;
  const double bounded = either_sign ? std::abs(value) : value;
  return bounded >= low && bounded <= high;
}

std::string KeyRange::text() const {
  return fmt::format("{}{:.6g} to {:.6g}{}", zero ? "0 or " : "", low, high, either_sign ? " of either sign" : "");
}

std::vector<SceneKey> scene_keys() {
  scene::SceneDraft draft;
  std::vector<SceneKey> result;
  for (const scene::KeyRow& key : scene::all_keys()) result.push_back(scene::describe(key, draft));
  return result;
}

}  // namespace railtab
