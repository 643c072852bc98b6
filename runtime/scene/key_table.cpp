#include "railtab/runtime/scene/key_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/runtime/scene/scene_keys.hpp"

namespace railtab::scene {
namespace {

template <class... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

/// Edit distance of Levenshtein: insertions, deletions and substitutions.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({substituted, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

std::string_view leaf(std::string_view path) {
  const std::size_t dot = path.rfind('.');
  return dot == std::string_view::npos ? path : path.substr(dot + 1);
}

/// Six digits are what a reader of the guide wants to see; the members themselves keep full precision.
std::string standard_number(double value) { return fmt::format("{:.6g}", value); }

SceneKey describe(const KeyBinding& key, SceneDraft& standard) {
  SceneKey result{std::string(key.path), "", std::string(key.unit), "", "", std::string(key.meaning)};
  const auto set = [&](std::string type, std::string range, std::string value) {
    result.type = std::move(type);
    result.range = std::move(range);
    result.standard = std::move(value);
  };
  std::visit(Overloaded{
                 [&](const NumberKey& k) { set("number", k.range.text(), standard_number(k.member(standard))); },
                 [&](const OptionalNumberKey& k) { set("number", k.range.text(), ""); },
                 [&](const RatioKey& k) { set("ratio", k.range.text(), standard_number(k.member(standard))); },
                 [&](const IntegerKey& k) {
                   set("integer", fmt::format("{} to {}", k.low, k.high), std::to_string(k.member(standard)));
                 },
                 [&](const TextKey& k) { set("text", k.names ? joined(k.names()) : "any", k.member(standard)); },
                 [&](const FileKey&) { set("file", "an existing file", ""); },
                 [&](const ProfileKey& k) {
                   set("profile", joined(standard_profile_names(k.kind)) + " or a profile file", k.member(standard));
                 },
                 [&](const ContactModeKey&) { set("choice", "table, online, paper", "table"); },
                 [&](const TrackKindKey&) { set("choice", "rigid, flexible, imported", "flexible"); },
                 [&](const NormalContactKey&) { set("choice", "hertz, rigid", "hertz"); },
                 [&](const ReductionKey&) { set("choice", "none, window", "none"); },
                 [&](const TextListKey& k) {
                   const std::vector<std::string>& list = k.member(standard);
                   set("list of texts", "any", list.empty() ? "" : fmt::format("[\"{}\"]", fmt::join(list, "\", \"")));
                 },
                 [&](const SwitchKey& k) { set("choice", "true, false", k.member(standard) ? "true" : "false"); },
                 [&](const PointKey& k) {
                   const std::optional<Point>& point = k.member(standard);
                   set("point", "any", point ? fmt::format("{}", fmt::join(*point, ", ")) : "");
                 },
                 [&](const NumberListKey&) { set("numbers", "any", ""); },
                 [&](const FileFormatKey&) { set("choice", "matrix-market, calculix, ansys", "matrix-market"); },
                 [&](const ContactForceKey&) { set("choice", "automatic, endpoint, energy", "automatic"); },
             },
             key.value);
  return result;
}

}  // namespace

bool Range::accepts(double value) const noexcept {
  return std::isfinite(value) && (open_low ? value > low : value >= low) && value <= high;
}

std::string Range::text() const {
  const bool bounded_low = std::isfinite(low), bounded_high = std::isfinite(high);
  if (!bounded_low && !bounded_high) return "any";
  if (!bounded_high) return fmt::format("{} {:.6g}", open_low ? ">" : ">=", low);
  if (!bounded_low) return fmt::format("<= {:.6g}", high);
  return open_low ? fmt::format("> {:.6g}, <= {:.6g}", low, high) : fmt::format("{:.6g} to {:.6g}", low, high);
}

const std::vector<KeyBinding>& all_keys() {
  static const std::vector<KeyBinding> keys = [] {
    std::vector<KeyBinding> all = run_keys();
    const auto contact =
        std::find_if(all.begin(), all.end(), [](const KeyBinding& k) { return k.path == "contact.mode"; });
    all.insert(contact, vehicle_keys().begin(), vehicle_keys().end());
    // the guide goes from the train down to the bridge, then to the numerics
    const auto numerics =
        std::find_if(all.begin(), all.end(), [](const KeyBinding& k) { return k.path == "irregularity.file"; });
    all.insert(numerics, structure_keys().begin(), structure_keys().end());
    const auto integration =
        std::find_if(all.begin(), all.end(), [](const KeyBinding& k) { return k.path == "integration.time_step"; });
    all.insert(integration, load_keys().begin(), load_keys().end());
    return all;
  }();
  return keys;
}

std::string joined(const std::vector<std::string>& names) { return fmt::format("{}", fmt::join(names, ", ")); }

std::string nearest_key(std::string_view path) {
  // in hundredths of an edit, so that the heading decides between equal names
  constexpr std::size_t one = 100;
  std::string_view best;
  std::size_t best_distance = one * (std::max<std::size_t>(2, path.size() / 3) + 1);
  for (const KeyBinding& key : all_keys()) {
    const std::size_t edits = edit_distance(path, key.path);
    // a key that stands under the wrong heading is nearer than any misspelling
    const std::size_t distance = leaf(key.path) == leaf(path) ? one + edits : one * edits;
    if (distance < best_distance) {
      best_distance = distance;
      best = key.path;
    }
  }
  return std::string(best);
}

}  // namespace railtab::scene

namespace railtab {

std::vector<SceneKey> scene_keys() {
  scene::SceneDraft standard;
  std::vector<SceneKey> result;
  for (const scene::KeyBinding& key : scene::all_keys()) result.push_back(scene::describe(key, standard));
  return result;
}

}  // namespace railtab
