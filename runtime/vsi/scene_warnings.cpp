#include "scene_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "railtab/runtime/vsi/simulation.hpp"

namespace railtab {

namespace {

/// A stretch of time [s] or of the track [m].
struct Interval {
  double low, high;
  [[nodiscard]] bool meets(const Interval& other) const { return low <= other.high && other.low <= high; }
};

std::string text(const Interval& interval, std::string_view name, std::string_view unit) {
  return fmt::format("{} = {:.6g} to {:.6g} {}", name, interval.low, interval.high, unit);
}

/// Where the train's wheelsets run.
Interval wheel_way(const VsiModel& model, double duration) {
  return {model.wheelset_x(model.wheelsets() - 1, 0.0), model.wheelset_x(0, duration)};
}

/// Where the bodies run that a load acts on.
Interval body_way(const VsiModel& model, const BodyLoad& load, double duration) {
  const bool all = load.vehicle == BodyLoad::every_vehicle;
  const auto place = [&](std::size_t vehicle) {
    return model.vehicle_x[vehicle] + model.vehicle.bodies[static_cast<std::size_t>(load.body)].position[0];
  };
  const std::size_t first = all ? 0 : static_cast<std::size_t>(load.vehicle);
  return {place(all ? model.vehicle_x.size() - 1 : first), place(first) + model.distance(duration)};
}

std::optional<std::string> of_load(const SceneParameters& scene, const VsiModel& model, std::size_t index,
                                   double duration) {
  const LoadParameters& load = scene.loads[index];
  const BodyLoad& acting = model.loads[index];
  if (load.file.empty() && load.gust_duration == 0.0) return std::nullopt;  // constant
  const bool over_time = acting.history.argument() == LoadArgument::time;
  const Interval run = over_time ? Interval{0.0, duration} : body_way(model, acting, duration);
  const Interval history{acting.history.begin(), acting.history.end()};
  if (history.meets(run)) return std::nullopt;
  const std::string_view value = load.file.empty()        ? "it does not act"
                                 : history.high < run.low ? "its last value acts throughout"
                                                          : "its first value acts throughout";
  const std::string_view name = over_time ? "t" : "x", unit = over_time ? "s" : "m";
  return fmt::format("[[load]] {} of {} is given for {}, the run is at {}: {}", index + 1, scene.loads.size(),
                     text(history, name, unit), text(run, name, unit), value);
}

std::optional<std::string> of_ground(const SceneParameters& scene, std::size_t index, double duration) {
  const GroundMotionParameters& ground = scene.ground_motion[index];
  const std::string place = fmt::format("[[ground_motion]] {} of {}", index + 1, scene.ground_motion.size());
  if (ground.factor == 0.0) return place + " is taken times 0: the ground stays at rest";
  const double begin = read_ground_record(ground.file).begin() + ground.start;
  if (begin < duration) return std::nullopt;
  return fmt::format("{} begins at t = {:.6g} s, the run ends at {:.6g} s: the ground stays at rest", place, begin,
                     duration);
}

std::optional<std::string> of_deviation(const SpanDeviationParameters& deviation, const Interval& way) {
  if (deviation.amplitude == 0.0) return "span_deviation.amplitude is 0: no span turns";
  const double spans = deviation.shape == SpanDeviationShape::bending ? 2.0 : 1.0;
  const Interval turning{deviation.start, deviation.start + spans * deviation.span};
  if (turning.meets(way)) return std::nullopt;
  return fmt::format("the spans of [span_deviation] turn at {}, the wheels run at {}", text(turning, "x", "m"),
                     text(way, "x", "m"));
}

std::optional<std::string> of_irregularity(const SceneParameters& scene, const VsiModel& model, const Interval& way) {
  const Interval measured{model.irregularity.begin(), model.irregularity.end()};
  if (measured.meets(way)) return std::nullopt;
  return fmt::format("irregularity.file {} is measured at {}, the wheels run at {}: their track is perfect",
                     scene.irregularity->filename().string(), text(measured, "x", "m"), text(way, "x", "m"));
}

}  // namespace

std::vector<std::string> scene_warnings(const SceneParameters& scene, const VsiModel& model) {
  const double duration = run_duration(scene, model);
  const Interval way = wheel_way(model, duration);
  std::vector<std::string> warnings;
  const auto add = [&](std::optional<std::string> warning) {
    if (warning) warnings.push_back(std::move(*warning));
  };
  for (std::size_t i = 0; i < scene.loads.size(); ++i) add(of_load(scene, model, i, duration));
  for (std::size_t i = 0; i < scene.ground_motion.size(); ++i) add(of_ground(scene, i, duration));
  if (scene.span_deviation) add(of_deviation(*scene.span_deviation, way));
  if (scene.irregularity) add(of_irregularity(scene, model, way));
  return warnings;
}

}  // namespace railtab
