#include <fmt/format.h>

#include <algorithm>

#include "railtab/runtime/scene/scene_case.hpp"

// Steps and records too far apart for what the scene describes.

namespace railtab::scene {
namespace {

/// The first natural period of the span that has the shortest, as a simply supported beam; 0: no span.
double shortest_first_period(const SceneCase& at) {
  double shortest = 0.0;
  for (const BridgeParameters& span : at.scene.spans) {
    const double period = 1.0 / first_frequency(span);
    shortest = shortest == 0.0 ? period : std::min(shortest, period);
  }
  return shortest;
}

}  // namespace

const Warning steps_too_long{
    "in a step the train travels more than half the distance between sleepers, or a quarter of the shortest wave of a "
    "random track; or it is longer than a tenth of a span's first natural period",
    [](const SceneCase& at, Warnings& list) {
      const double step = at.scene.integration.time_step, travel = step * highest_speed(at);
      const auto warn = [&](double found, const char* unit, double compared, const char* name) {
        list.push_back(fmt::format(
            "integration.time_step = {:g} s: a step is {:.3g} {} long, {} is {:.3g} {}: forces and accelerations of so "
            "short waves are wrong or missing; shorten the step",
            step, found, unit, name, compared, unit));
      };
      const bool sleepers = at.scene.track_kind == TrackKind::flexible;
      if (sleepers && travel > 0.5 * at.scene.track.sleeper_spacing) {
        warn(travel, "m", at.scene.track.sleeper_spacing, "the distance between sleepers");
      } else if (at.scene.spectrum && travel > 0.25 * at.scene.spectrum->shortest) {
        warn(travel, "m", at.scene.spectrum->shortest, "the shortest wave of the track");
      } else if (const double period = shortest_first_period(at); period > 0.0 && step > 0.1 * period) {
        warn(step, "s", period, "the first natural period of a span");
      }
    }};

const Warning records_too_few{
    "records are further apart than an eighth of a span's first natural period, or than 0.05 s",
    [](const SceneCase& at, Warnings& list) {
      constexpr double longest = 0.05;  // [s] for car bodies, at some ten hertz
      const double interval = at.scene.output.every * at.scene.integration.time_step;
      const double period = shortest_first_period(at), limit = period > 0.0 ? std::min(period / 8.0, longest) : longest;
      if (interval <= limit) return;
      list.push_back(
          fmt::format("output.every: records are {:.3g} s apart, more than {:.3g} s: largest accelerations and "
                      "displacements of deck and car bodies lie between them and are missed",
                      interval, limit));
    }};

}  // namespace railtab::scene
