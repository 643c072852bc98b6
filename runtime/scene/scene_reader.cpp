#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "railtab/runtime/base/in_file.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/base/toml_text.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/runtime/scene/key_changes.hpp"
#include "railtab/runtime/scene/key_table.hpp"
#include "railtab/runtime/scene/scene_keys.hpp"
#include "railtab/runtime/scene/toml_leaves.hpp"
#include "railtab/runtime/scene/unused_keys.hpp"
#include "railtab/runtime/structure/bridge_damping.hpp"
#include "railtab/runtime/vehicle/toml_kind.hpp"
#include "railtab/runtime/vehicle/toml_section.hpp"
#include "railtab/runtime/vehicle/vehicle_file.hpp"
#include "railtab/runtime/vehicle/vehicle_library.hpp"

namespace railtab::scene {
namespace {

/// Writes one TOML value into the member that its key is bound to.
struct Assign {
  SceneDraft& draft;
  const std::filesystem::path& file;
  const Leaf& leaf;
  std::string_view unit;
  SceneFiles needed_files;

  void operator()(const NumberKey& key) const { key.member(draft) = number_in(key.range); }
  void operator()(const OptionalNumberKey& key) const { key.member(draft) = number_in(key.range); }
  void operator()(const RatioKey& key) const { key.member(draft) = ratio(key.range); }
  void operator()(const IntegerKey& key) const {
    const toml::value<std::int64_t>* whole = leaf.node->as_integer();
    if (!whole || whole->get() < key.low || whole->get() > key.high) {
      throw leaf_error(file, leaf, found_not_integer(*leaf.node),
                       fmt::format("an integer {} to {}", key.low, key.high));
    }
    key.member(draft) = static_cast<int>(whole->get());
  }
  void operator()(const TextKey& key) const {
    key.member(draft) = key.names ? one_of(key.names()) : text("a text that is not empty");
  }
  void operator()(const FileKey& key) const {
    const std::filesystem::path named = file.parent_path() / text("a file name");
    if (is_file(named)) {
      draft.parameters.files.push_back(named);
    } else if (needed()) {
      std::error_code unreadable;
      const bool none = !std::filesystem::exists(named, unreadable);
      throw leaf_error(file, leaf, fmt::format("{} {}", none ? "no file" : what_is_at(named), named.string()),
                       "an existing file, relative to the scene");
    }
    key.member(draft) = named;
  }
  void operator()(const ProfileKey& key) const { key.member(draft) = profile(key.kind); }
  void operator()(const VehicleKey& key) const { key.member(draft) = vehicle(); }
  void operator()(const ConsistKey& key) const {
    const std::string expected =
        "a list of vehicles from the front, such as [\"power-car\", \"coach*8\", \"-power-car\"]";
    std::vector<ConsistEntry>& member = key.member(draft);
    member.clear();
    for (const std::string& text : texts(expected)) {
      std::optional<ConsistEntry> entry = parse_consist_entry(text);
      if (!entry) {
        throw leaf_error(file, leaf, fmt::format("\"{}\" in the list", text),
                         "\"NAME\", \"-NAME\" or \"NAME*N\" with N from 1 to 100, without blanks around the *");
      }
      entry->vehicle = vehicle_named(entry->vehicle, vehicle_names());
      member.push_back(*std::move(entry));
    }
    if (member.empty()) throw leaf_error(file, leaf, "an empty list", expected);
  }
  void operator()(const ChoiceKey& key) const {
    const std::string name = one_of(key.names);
    key.set(draft, static_cast<std::size_t>(std::find(key.names.begin(), key.names.end(), name) - key.names.begin()));
  }
  void operator()(const ReductionKey&) const {
    // Scenes written for earlier versions may name a reduction that no longer exists.
    const toml::value<std::string>* named = leaf.node->as_string();
    if (named && (named->get() == "modal" || named->get() == "craig-bampton")) {
      throw leaf_error(file, leaf, fmt::format("\"{}\", a reduction that has been removed", named->get()),
                       "\"none\" or \"window\": take \"window\" for a long line of built track, and \"none\" else; "
                       "remove structure.modes and structure.static_correction");
    }
    draft.parameters.reduction.kind = one_of({"none", "window"}) == "window" ? Reduction::window : Reduction::none;
  }
  void operator()(const TextListKey& key) const { key.member(draft) = texts("a list of texts, such as [\"deck-*\"]"); }
  void operator()(const SwitchKey& key) const {
    const toml::value<bool>* value = leaf.node->as_boolean();
    if (!value) throw error("true or false");
    key.member(draft) = value->get();
  }
  void operator()(const PointKey& key) const {
    const std::string expected = fmt::format("three numbers, [x, y, z], each {}", key.range.text());
    const std::vector<double> values = numbers(expected, key.range);
    if (values.size() != 3) throw error(expected);
    key.member(draft) = Point{values[0], values[1], values[2]};
  }
  void operator()(const NumberListKey& key) const {
    key.member(draft) = numbers(fmt::format("numbers, [a, b, …], each {} {}", key.range.text(), unit), key.range);
  }

 private:
  /// Whether the file that the key names has to be there.
  [[nodiscard]] bool needed() const {
    const std::string_view section = leaf.section();
    return needed_files == SceneFiles::all || section == "train" || section == "vehicle" || section == "structure";
  }

  [[nodiscard]] InputError error(std::string_view expected) const {
    return leaf_error(file, leaf, found_text(*leaf.node), expected);
  }

  [[nodiscard]] double number_in(const Range& range) const {
    const std::optional<double> value = leaf.node->value<double>();
    if (!leaf.node->is_number() || !value || !range.accepts(*value)) {
      throw error(expected_number(range, unit));
    }
    return *value;
  }

  [[nodiscard]] std::vector<double> numbers(std::string_view expected, const Range& range) const {
    const toml::array* list = leaf.node->as_array();
    if (!list) throw error(expected);
    std::vector<double> values;
    for (const toml::node& entry : *list) {
      const std::optional<double> value = entry.value<double>();
      if (!entry.is_number() || !value || !range.accepts(*value)) {
        throw leaf_error(file, leaf, found_text(entry) + " in the list", expected);
      }
      values.push_back(*value);
    }
    return values;
  }

  [[nodiscard]] std::vector<std::string> texts(std::string_view expected) const {
    const toml::array* list = leaf.node->as_array();
    if (!list) throw error(expected);
    std::vector<std::string> result;
    for (const toml::node& entry : *list) {
      const toml::value<std::string>* text = entry.as_string();
      if (!text || text->get().empty()) {
        const std::string found = text ? "an empty text" : found_text(entry);
        throw leaf_error(file, leaf, found + " in the list", expected);
      }
      result.push_back(text->get());
    }
    return result;
  }

  [[nodiscard]] std::string text(std::string_view expected) const {
    const toml::value<std::string>* value = leaf.node->as_string();
    if (!value || value->get().empty()) throw error(expected);
    return value->get();
  }

  [[nodiscard]] std::string one_of(const std::vector<std::string>& names) const {
    const std::string expected = "one of " + joined(names);
    std::string name = text(expected);
    if (std::find(names.begin(), names.end(), name) == names.end()) throw error(expected);
    return name;
  }

  [[nodiscard]] double ratio(const Range& range) const {
    if (leaf.node->is_number()) return number_in(range);
    const std::string expected = fmt::format("\"1:N\" or a number, {}", range.text());
    const std::string written = text(expected);
    const char* const end = written.data() + written.size();
    double divisor = 0.0;
    if (written.starts_with("1:")) {
      const auto [stop, status] = std::from_chars(written.data() + 2, end, divisor);
      if (status == std::errc() && stop == end && divisor > 0.0 && range.accepts(1.0 / divisor)) return 1.0 / divisor;
    }
    throw error(expected);
  }

  [[nodiscard]] std::string vehicle() const {
    std::vector<std::string> names = vehicle_names();
    names.emplace_back(imported_vehicle);
    return vehicle_named(text(expected_vehicle(names)), names);
  }

  // False where it is there already.
  bool add_file(const std::filesystem::path& named) const {
    std::vector<std::filesystem::path>& files = draft.parameters.files;
    if (std::find(files.begin(), files.end(), named) != files.end()) return false;
    files.push_back(named);
    return true;
  }

  static std::string expected_vehicle(const std::vector<std::string>& names) {
    return fmt::format("a vehicle's TOML file, relative to the scene, or one of {}", joined(names));
  }

  // A known name, or a file's path.
  [[nodiscard]] std::string vehicle_named(const std::string& name, const std::vector<std::string>& names) const {
    const std::string expected = expected_vehicle(names);
    if (std::find(names.begin(), names.end(), name) != names.end()) return name;
    const std::filesystem::path named = file.parent_path() / name;
    if (!name.ends_with(".toml")) throw leaf_error(file, leaf, fmt::format("the text \"{}\"", name), expected);
    if (!is_file(named)) throw leaf_error(file, leaf, fmt::format("no file {}", named.string()), expected);
    if (add_file(named)) {
      const VehicleData data = read_vehicle_file(named);
      for (const std::filesystem::path& joint : {data.joint_front, data.joint_rear}) {
        if (!joint.empty()) add_file(joint);
      }
    }
    return named.string();
  }

  [[nodiscard]] std::string profile(ProfileKind kind) const {
    const std::string expected =
        fmt::format("a built-in profile ({}) or an existing profile file", joined(standard_profile_names(kind)));
    const std::string name = text(expected);
    const std::filesystem::path named = file.parent_path() / name;
    if (is_file(named)) {
      draft.parameters.files.push_back(named);
      return named.string();
    }
    if (!needed()) return name;
    try {
      static_cast<void>(standard_profile(kind, name, 0.0));  // knows other spellings of the names too
    } catch (const InputError&) {
      throw error(expected);
    }
    return name;
  }
};

InputError unknown_key(const std::filesystem::path& file, const Leaf& leaf) {
  const std::string place = fmt::format("{}:{}", file.string(), leaf.line);
  const std::string nearest = nearest_key(leaf.path);
  if (nearest.empty()) {
    return InputError(fmt::format(
        "{}: unknown key '{}'; the sections are train, vehicle, contact, profiles, track, bridge, structure, "
        "support, irregularity, span_deviation, wheel, load, ground_motion, integration, output and "
        "assessment",
        place, leaf.path));
  }
  return InputError(fmt::format("{}: unknown key '{}'; did you mean '{}'?", place, leaf.path, nearest));
}

bool is_section(std::string_view path) {
  const std::string prefix = std::string(path) + ".";
  return std::any_of(all_keys().begin(), all_keys().end(),
                     [&](const KeyRow& key) { return key.path.starts_with(prefix); });
}

/// What was just read of a [[bridge]], [[support]], [[profiles]], [[wheel]], [[load]] or [[ground_motion]] goes into
/// the scene; its end is the next such heading or the end of the file.
void finish_entry(SceneDraft& draft, std::string_view section) {
  if (section == "bridge") {
    if (!draft.span_damping_type.empty()) {
      draft.span.damping_ratio = damping_lower_bound("bridge.damping_type", draft.span_damping_type, draft.span.length);
    }
    draft.parameters.spans.insert(draft.parameters.spans.end(), static_cast<std::size_t>(draft.span_count), draft.span);
    draft.span = BridgeParameters{};
    draft.span_damping_type.clear();
    draft.span_count = 1;
  } else if (section == "support") {
    draft.parameters.structure.supports.push_back(std::exchange(draft.support, {}));
  } else if (section == "load") {
    draft.parameters.loads.push_back(std::exchange(draft.load, {}));
  } else if (section == "profiles") {
    draft.parameters.profiles.push_back(std::exchange(draft.profiles, {}));
  } else if (section == "wheel") {
    draft.parameters.wheels.push_back(std::exchange(draft.wheel, {}));
  } else if (section == "ground_motion") {
    draft.parameters.ground_motion.push_back(std::exchange(draft.ground, {}));
  }
}

void assign(SceneDraft& draft, const std::filesystem::path& file, const std::vector<Leaf>& leaves, SceneFiles files) {
  const Leaf* heading = nullptr;  // of the entry being read
  for (const Leaf& leaf : leaves) {
    if (leaf.entry >= 0 && is_list_section(leaf.path)) {
      if (heading) finish_entry(draft, heading->path);
      heading = &leaf;
      continue;
    }
    if (const KeyRow* key = find_key(leaf.path)) {
      std::visit(Assign{draft, file, leaf, key->unit, files}, key->value);
    } else if (!is_section(leaf.path)) {
      throw unknown_key(file, leaf);
    } else if (!leaf.node->is_table()) {
      throw leaf_error(file, leaf, found_text(*leaf.node), fmt::format("a section [{}]", leaf.path));
    }
  }
  if (heading) finish_entry(draft, heading->path);
}

/// ":12" of what a message begins with: a key, where the scene names it once, the keys' heading, where it has some
/// ("structure.deck" of structure.deck.from), or "[[load]] 2 of 3".
std::string line_of(std::string_view message, const std::vector<Leaf>& leaves) {
  const std::string below = fmt::format("{}.", message.substr(0, message.find(':')));
  std::string line;
  for (const Leaf& leaf : leaves) {
    const bool heading = is_list_section(leaf.path);
    const std::string entry = fmt::format("[[{}]] {} of ", leaf.path, leaf.entry + 1);
    if (!message.starts_with(heading ? entry : leaf.path + ":")) continue;
    if (!line.empty()) return {};
    line = fmt::format(":{}", leaf.line);
  }
  if (!line.empty()) return line;
  const auto first =
      std::find_if(leaves.begin(), leaves.end(), [&](const Leaf& leaf) { return leaf.path.starts_with(below); });
  return first == leaves.end() || first->entry >= 0 ? "" : fmt::format(":{}", first->line);
}

/// What the order of the keys must not decide: two ways to say one thing, and rules over several keys.
SceneParameters settle(SceneDraft draft, const std::filesystem::path& file, const std::vector<Leaf>& leaves) {
  const auto named = [&](std::string_view key) {
    return std::any_of(leaves.begin(), leaves.end(), [&](const Leaf& leaf) { return leaf.path.starts_with(key); });
  };
  if (named("vehicle.") && !named("train.vehicle")) draft.parameters.train.vehicle = imported_vehicle;
  if (!draft.parameters.vehicle.car_bodies.empty()) {
    draft.parameters.vehicle.car_body = draft.parameters.vehicle.car_bodies.front();
  }
  if (draft.speed_kmh) draft.parameters.train.speed = *draft.speed_kmh / 3.6;
  if (draft.deviation_shape) {
    draft.parameters.span_deviation = draft.deviation;
    draft.parameters.span_deviation->shape = *draft.deviation_shape;
  }
  if (!draft.spectrum_name.empty()) {
    draft.parameters.spectrum = draft.spectrum;
    draft.parameters.spectrum->name = draft.spectrum_name;
  }
  if (!draft.irregularity.empty()) draft.parameters.irregularity = draft.irregularity;
  if (draft.parameters.name.empty()) draft.parameters.name = file.stem().string();
  reject_unused_keys(draft.parameters, file, leaves);
  try {
    draft.parameters.validate();
  } catch (const InputError& wrong) {
    throw InputError(fmt::format("{}{}: {}", file.string(), line_of(wrong.what(), leaves), wrong.what()));
  }
  return std::move(draft.parameters);
}

}  // namespace
}  // namespace railtab::scene

namespace railtab {

SceneParameters read_scene(const std::filesystem::path& file, const std::vector<KeyChange>& changes, SceneFiles files) {
  if (file.empty()) throw input_error("scene", "an empty name", "the name of a TOML scene");
  scene::SceneDraft draft;
  draft.parameters.text = read_toml_text(file, "a TOML scene");
  check_toml_bounds(draft.parameters.text, file);
  try {
    toml::table root = toml::parse(draft.parameters.text, file.string());
    check_toml_kind(root, file, TomlKind::scene);
    if (root.empty()) throw input_error(file.string(), "a file without keys", "a scene (vsi new writes one)");
    in_file(file.string(), [&] { scene::change_keys(changes, root); });
    if (!changes.empty()) draft.parameters.text += fmt::format("\n# changed: {}\n", scene::changes_text(changes));
    const std::vector<scene::Leaf> leaves = scene::leaves_of(root, file);
    scene::assign(draft, file, leaves, files);
    return scene::settle(std::move(draft), file, leaves);
  } catch (const toml::parse_error& wrong) {
    const toml::source_position at = wrong.source().begin;
    const std::string key = scene::key_before(draft.parameters.text, at);
    throw InputError(fmt::format("{}:{}: {}{}{}", file.string(), at.line, key, key.empty() ? "" : ": ",
                                 toml_fault(draft.parameters.text, at.line, wrong.description())));
  } catch (const InputError& wrong) {
    if (changes.empty()) throw;
    throw InputError(fmt::format("{} (changed: {})", wrong.what(), scene::changes_text(changes)));
  }
}

std::string_view without_scene(std::string_view message) noexcept {
  constexpr std::string_view prefix = "scene: ";
  if (message.starts_with(prefix)) message.remove_prefix(prefix.size());
  return message;
}

InputError with_scene_line(const InputError& wrong, const SceneParameters& scene, const std::filesystem::path& file) {
  const std::string_view whole = wrong.what(), message = without_scene(whole);
  const bool of_scene = message.size() < whole.size();
  const toml::table root = toml::parse(scene.text, file.string());
  const std::string line = scene::line_of(message, scene::leaves_of(root, file));
  return of_scene || !line.empty() ? InputError(fmt::format("{}{}: {}", file.string(), line, message)) : wrong;
}

}  // namespace railtab
