#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "railtab/runtime/scene/scene_case.hpp"

// Spans that the train hardly loads, or from far away.

namespace railtab::scene {

const Warning span_far_from_track{
    "the beam axis lies more than 10 m below, above or beside the track", [](const SceneCase& at, Warnings& list) {
      constexpr double far = 10.0;  // [m]
      for (const BridgeParameters& span : at.scene.spans) {
        if (std::max(std::abs(span.track_offset), std::abs(span.axis_depth)) <= far) continue;
        list.push_back(fmt::format(
            "a span has bridge.axis_depth = {:g} m and bridge.track_offset = {:g} m: the track is that far from the "
            "beam axis, and tied to it rigidly; are both in m?",
            span.axis_depth, span.track_offset));
        return;
      }
    }};

const Warning span_with_few_sleepers{
    "a span carries fewer than three sleepers", [](const SceneCase& at, Warnings& list) {
      constexpr double fewest = 3.0;
      const double spacing = at.scene.track.sleeper_spacing;
      for (const BridgeParameters& span : at.scene.spans) {
        if (span.length >= fewest * spacing) continue;
        const char* const effect =
            span.length < spacing ? "a span without a sleeper between its supports is not loaded, and its values are 0"
                                  : "its accelerations say little";
        list.push_back(fmt::format(
            "bridge.length = {:g} m is less than {:g} times track.sleeper_spacing = {:g} m: the train reaches the span "
            "through its sleepers, and {}",
            span.length, fewest, spacing, effect));
        return;
      }
    }};

}  // namespace railtab::scene
