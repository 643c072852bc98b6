#include "railtab/runtime/scene/key_ranges.hpp"

#include <fmt/format.h>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/scene/key_table.hpp"

namespace railtab::scene {
namespace {

/// The numbers that a row has in the scene.
std::vector<double> numbers_of(const KeyRow& row, SceneDraft& draft) {
  return std::visit(Overloaded{
                        [&](const NumberKey& k) { return std::vector{k.member(draft)}; },
                        [&](const OptionalNumberKey& k) {
                          const std::optional<double>& value = k.member(draft);
                          return value ? std::vector{*value} : std::vector<double>();
                        },
                        [&](const RatioKey& k) { return std::vector{k.member(draft)}; },
                        [&](const IntegerKey& k) { return std::vector{static_cast<double>(k.member(draft))}; },
                        [&](const PointKey& k) {
                          const std::optional<Point>& point = k.member(draft);
                          return point ? std::vector<double>(point->begin(), point->end()) : std::vector<double>();
                        },
                        [&](const NumberListKey& k) { return k.member(draft); },
                        [](const auto&) { return std::vector<double>(); },
                    },
                    row.value);
}

std::optional<Range> range_of(const KeyRow& row) {
  return std::visit(Overloaded{
                        [](const IntegerKey& k) -> std::optional<Range> {
                          return Range{static_cast<double>(k.low), static_cast<double>(k.high)};
                        },
                        [](const auto& k) -> std::optional<Range> {
                          if constexpr (requires { k.range; }) return k.range;
                          return std::nullopt;
                        },
                    },
                    row.value);
}

/// Keys whose path begins so. A value that the key has by default is always right.
void require_section(std::string_view begin, SceneDraft& draft) {
  static SceneDraft defaults;
  for (const KeyRow& row : all_keys()) {
    const std::optional<Range> range = range_of(row);
    if (!range || !row.path.starts_with(begin)) continue;
    const std::vector<double> values = numbers_of(row, draft);
    if (values == numbers_of(row, defaults)) continue;
    for (const double value : values) {
      if (range->accepts(value)) continue;
      const bool integer = std::holds_alternative<IntegerKey>(row.value);
      throw input_error(row.path, fmt::format("{}", value),
                        integer ? "an integer " + range->text() : expected_number(*range, row.unit));
    }
  }
}

}  // namespace

void require_ranges(const SceneParameters& scene) {
  SceneDraft draft;
  draft.parameters = scene;
  if (scene.spectrum) draft.spectrum = *scene.spectrum;
  if (scene.span_deviation) draft.deviation = *scene.span_deviation;
  for (const char* section : {"train.", "vehicle.", "contact.", "structure.", "irregularity.", "span_deviation.",
                              "integration.", "output.", "assessment."}) {
    require_section(section, draft);
  }
  for (const FeSupport& support : scene.structure.supports) {
    draft.support = support;
    require_section("support.", draft);
  }
  for (const LoadParameters& load : scene.loads) {
    draft.load = load;
    require_section("load.", draft);
  }
  for (const ProfileParameters& profiles : scene.profiles) {
    draft.profiles = profiles;
    require_section("profiles.", draft);
  }
  for (const WheelParameters& wheel : scene.wheels) {
    draft.wheel = wheel;
    require_section("wheel.", draft);
  }
  for (const GroundMotionParameters& ground : scene.ground_motion) {
    draft.ground = ground;
    require_section("ground_motion.", draft);
  }
}

}  // namespace railtab::scene
