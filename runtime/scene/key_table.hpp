#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "railtab/runtime/scene/key_conditions.hpp"
#include "railtab/runtime/scene/key_warnings.hpp"
#include "railtab/runtime/scene/scene_keys.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"

namespace railtab::scene {

/// What the keys write into while a scene is read. Members beside the parameters hold what is settled at the end.
struct SceneDraft {
  SceneParameters parameters;
  BridgeParameters span;            ///< the [[bridge]] being read
  int span_count = 1;               ///< equal spans that this [[bridge]] stands for
  std::optional<double> speed_kmh;  ///< the other way to say train.speed
  std::string span_damping_type;    ///< of the [[bridge]] being read; empty: its damping_ratio
  std::filesystem::path irregularity;
  std::string spectrum_name;    ///< empty: no random track
  SpectrumParameters spectrum;  ///< the rest of it
  std::optional<SpanDeviationShape> deviation_shape;
  SpanDeviationParameters deviation;
  FeSupport support;              ///< the [[support]] being read
  LoadParameters load;            ///< the [[load]] being read
  WheelParameters wheel;          ///< the [[wheel]] being read
  ProfileParameters profiles;     ///< the [[profiles]] being read
  GroundMotionParameters ground;  ///< the [[ground_motion]] being read
};

using Range = KeyRange;

template <class T>
using Member = T& (*)(SceneDraft&);
using Names = std::vector<std::string> (*)();

struct NumberKey {
  Member<double> member;
  Range range;
};
struct OptionalNumberKey {
  Member<std::optional<double>> member;
  Range range;
};
/// A number, or "1:40".
struct RatioKey {
  Member<double> member;
  Range range;
};
struct IntegerKey {
  Member<int> member;
  int low, high;
};
/// One of the names, or any text where `names` is null.
struct TextKey {
  Member<std::string> member;
  Names names;
};
using Point = std::array<double, 3>;
/// Three numbers.
struct PointKey {
  Member<std::optional<Point>> member;
  Range range;
};
/// Any count of numbers, rising or not.
struct NumberListKey {
  Member<std::vector<double>> member;
  Range range;
};
/// A file that must exist, relative to the scene.
struct FileKey {
  Member<std::filesystem::path> member;
};
/// A built-in profile name, or a profile file relative to the scene.
struct ProfileKey {
  Member<std::string> member;
  ProfileKind kind;
};
/// A vehicle of the library, a vehicle's TOML file relative to the scene, or "imported".
struct VehicleKey {
  Member<std::string> member;
};
/// Vehicles of a train, front first: "-name*2", each as for VehicleKey.
struct ConsistKey {
  Member<std::vector<ConsistEntry>> member;
};
/// One of the names, each of which stands for a value of a type of its own.
struct ChoiceKey {
  std::vector<std::string> names;
  std::function<void(SceneDraft&, std::size_t)> set;
  std::function<std::size_t(SceneDraft&)> get;
};
struct ReductionKey {};
/// A list of texts.
struct TextListKey {
  Member<std::vector<std::string>> member;
};

template <class Value>
ChoiceKey choice(Member<Value> member, const std::vector<std::pair<std::string, Value>>& options) {
  std::vector<std::string> names;
  std::vector<Value> values;
  for (const auto& [name, value] : options) {
    names.push_back(name);
    values.push_back(value);
  }
  return {std::move(names), [member, values](SceneDraft& draft, std::size_t i) { member(draft) = values[i]; },
          [member, values](SceneDraft& draft) {
            std::size_t i = 0;
            while (i + 1 < values.size() && values[i] != member(draft)) ++i;
            return i;
          }};
}
/// true or false.
struct SwitchKey {
  Member<bool> member;
};

/// All that railtab knows of one key of a scene. Reading, the checks of ranges and of keys without effect, warnings,
/// the plan's list of what is left out and the guide's tables come from these rows.
struct KeyRow {
  std::string_view path;
  std::string_view unit;
  std::string_view meaning;
  std::variant<NumberKey, OptionalNumberKey, RatioKey, IntegerKey, TextKey, FileKey, ProfileKey, VehicleKey, ChoiceKey,
               ReductionKey, SwitchKey, TextListKey, PointKey, NumberListKey, ConsistKey>
      value;
  std::vector<const Condition*> applies{};  ///< all of them hold where the key has an effect
  std::vector<const Warning*> warns{};
  /// What the run does without, by the value of this key, for `vsi run --plan`; empty: nothing.
  std::string (*left_out)(const SceneParameters& scene) = nullptr;
};

/// The rows with one more condition each, which comes first.
[[nodiscard]] std::vector<KeyRow> applying(const Condition& condition, std::vector<KeyRow> rows);
/// One list of several.
[[nodiscard]] std::vector<KeyRow> all_of(std::initializer_list<std::vector<KeyRow>> parts);

// Rows by sections, each in a file of its own.
[[nodiscard]] std::vector<KeyRow> train_keys();  // and the top of the scene
[[nodiscard]] std::vector<KeyRow> vehicle_keys();
[[nodiscard]] std::vector<KeyRow> contact_keys();
[[nodiscard]] std::vector<KeyRow> profile_keys();  // [[profiles]]
[[nodiscard]] std::vector<KeyRow> track_keys();
[[nodiscard]] std::vector<KeyRow> bridge_keys();
[[nodiscard]] std::vector<KeyRow> import_keys();        // of [structure]
[[nodiscard]] std::vector<KeyRow> reduction_keys();     // of [structure]
[[nodiscard]] std::vector<KeyRow> held_node_keys();     // [[support]]
[[nodiscard]] std::vector<KeyRow> irregularity_keys();  // and [span_deviation]
[[nodiscard]] std::vector<KeyRow> wheel_keys();         // [[wheel]]
[[nodiscard]] std::vector<KeyRow> load_keys();          // [[load]] and [[ground_motion]]
[[nodiscard]] std::vector<KeyRow> integration_keys();   // and [output]
[[nodiscard]] std::vector<KeyRow> assessment_keys();

/// All, in the order of the guide.
[[nodiscard]] const std::vector<KeyRow>& all_keys();

/// The row of a key, or null.
[[nodiscard]] const KeyRow* find_key(std::string_view path);

/// "table, online, paper"
[[nodiscard]] std::string joined(const std::vector<std::string>& names);

/// What a message says of the numbers that a key accepts: "a number, 0.001 to 200 m/s".
[[nodiscard]] std::string expected_number(const Range& range, std::string_view unit);

/// The key of the table nearest to `path` in edit distance, or empty where none is near.
[[nodiscard]] std::string nearest_key(std::string_view path);

template <class... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

}  // namespace railtab::scene
