#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "railtab/runtime/scene/scene_case.hpp"

// Spans that the train hardly loads, from far away, or from the beginning.

namespace railtab::scene {

namespace {

void standing_on_span(const SceneCase& at, Warnings& list) {
  if (!at.model.structure) return;
  constexpr double about_its_end = 0.1;  // [m]
  for (const auto& [begin, end] : at.model.structure->spans) {
    for (int w = 0; w < at.model.wheelsets(); ++w) {
      const double x = at.model.wheelset_x(w, 0.0);
      if (x < begin + about_its_end || x > end - about_its_end) continue;
      list.push_back(fmt::format(
          "train.start = {:g} m: at t = 0 wheelset {} stands at x = {:.6g} m on a span, from {:.6g} m to {:.6g} m, "
          "which begins at rest under it: what the entry of wheelsets adds is missing",
          at.scene.train.start, w + 1, x, begin, end));
      return;
    }
  }
}

}  // namespace

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

const Warning start_on_span{"wheelsets stand on a span at t = 0", standing_on_span};

}  // namespace railtab::scene
