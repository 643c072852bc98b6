#pragma once

#include <array>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

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
  std::string deviation_shape = "none", deviation_direction = "vertical";
  SpanDeviationParameters deviation;
  FeSupport support;              ///< the [[support]] being read
  LoadParameters load;            ///< the [[load]] being read
  GroundMotionParameters ground;  ///< the [[ground_motion]] being read
};

/// Numbers a key accepts; `open_low` excludes the lower end.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool open_low = false;
  /// False for NaN; infinities are never accepted.
  [[nodiscard]] bool accepts(double value) const noexcept;
  [[nodiscard]] std::string text() const;
};
inline constexpr double unbounded = std::numeric_limits<double>::infinity();
inline constexpr Range not_negative{0.0, unbounded, false};

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
};
/// Any count of numbers, rising or not.
struct NumberListKey {
  Member<std::vector<double>> member;
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
struct ContactModeKey {};
struct TrackKindKey {};
struct NormalContactKey {};
struct ReductionKey {};
/// A list of texts.
struct TextListKey {
  Member<std::vector<std::string>> member;
};
/// true or false.
struct SwitchKey {
  Member<bool> member;
};
struct FileFormatKey {};
struct ContactForceKey {};

/// The one place that says which key goes to which member, in which unit and range.
struct KeyBinding {
  std::string_view path;
  std::string_view unit;
  std::string_view meaning;
  std::variant<NumberKey, OptionalNumberKey, RatioKey, IntegerKey, TextKey, FileKey, ProfileKey, ContactModeKey,
               TrackKindKey, NormalContactKey, ReductionKey, SwitchKey, TextListKey, PointKey, NumberListKey,
               FileFormatKey, ContactForceKey>
      value;
};

/// Keys of [train], [contact], [irregularity], [integration], [output] and the top of the scene.
[[nodiscard]] const std::vector<KeyBinding>& run_keys();
/// Keys of [vehicle].
[[nodiscard]] const std::vector<KeyBinding>& vehicle_keys();
/// Keys of [structure].
[[nodiscard]] const std::vector<KeyBinding>& import_keys();
/// Keys of [track], [[bridge]] and [structure].
[[nodiscard]] const std::vector<KeyBinding>& structure_keys();
/// Keys of [span_deviation], [[load]] and [[ground_motion]].
[[nodiscard]] const std::vector<KeyBinding>& load_keys();
/// All, in the order of the guide.
[[nodiscard]] const std::vector<KeyBinding>& all_keys();

/// "table, online, paper"
[[nodiscard]] std::string joined(const std::vector<std::string>& names);

/// The key of the table nearest to `path` in edit distance, or empty where none is near.
[[nodiscard]] std::string nearest_key(std::string_view path);

}  // namespace railtab::scene
