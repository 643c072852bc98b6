#include "railtab/runtime/scene/scene_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "railtab/runtime/scene/scene_loads.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"

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

/// Where a vehicle's body that a load acts on is at t = 0 [m].
double start_of_body(const VsiModel& model, const BodyLoad& load, std::size_t vehicle) {
  return model.vehicle_x[vehicle] + model.vehicle.bodies[static_cast<std::size_t>(load.body)].position[0];
}

/// Where the bodies run that a load acts on.
Interval body_way(const VsiModel& model, const BodyLoad& load, double duration) {
  const bool all = load.vehicle == BodyLoad::every_vehicle;
  const std::size_t first = all ? 0 : static_cast<std::size_t>(load.vehicle);
  return {start_of_body(model, load, all ? model.vehicle_x.size() - 1 : first),
          start_of_body(model, load, first) + model.distance(duration)};
}

std::optional<std::string> of_load(const SceneParameters& scene, const VsiModel& model, std::size_t index,
                                   double duration) {
  const LoadParameters& load = scene.loads[index];
  const BodyLoad& acting = model.loads[index];
  const std::string place = fmt::format("[[load]] {} of {}", index + 1, scene.loads.size());
  if (!acting.history.acting().any()) return place + " is zero throughout: it does not act";
  if (load.file.empty() && load.gust_duration == 0.0) return std::nullopt;  // constant
  const bool over_time = acting.history.argument() == LoadArgument::time;
  const Interval run = over_time ? Interval{0.0, duration} : body_way(model, acting, duration);
  const Interval history{acting.history.begin(), acting.history.end()};
  if (history.meets(run)) return std::nullopt;
  const std::string_view value = load.file.empty()        ? "it does not act"
                                 : history.high < run.low ? "its last value acts throughout"
                                                          : "its first value acts throughout";
  const std::string_view name = over_time ? "t" : "x", unit = over_time ? "s" : "m";
  return fmt::format("{} is given for {}, the run is at {}: {}", place, text(history, name, unit),
                     text(run, name, unit), value);
}

/// When a load is at a point of its history: a time, or the place of a vehicle's loaded body.
double time_at(const VsiModel& model, const BodyLoad& load, std::size_t vehicle, double point) {
  if (load.history.argument() == LoadArgument::time) return point;
  const double run = point - start_of_body(model, load, vehicle);
  return model.speed_profile ? model.speed_profile->time_at(run) : run / model.contact.speed;
}

/// A load that rises and falls within a few steps: what acts of it is what the ends of steps happen to meet.
std::optional<std::string> of_short_load(const SceneParameters& scene, const VsiModel& model, std::size_t index,
                                         double duration) {
  constexpr double resolved = 4.0;  // steps from a rise to the end of the fall
  constexpr const char* names[] = {"Fx", "Fy", "Fz", "Mx", "My", "Mz"};
  const BodyLoad& load = model.loads[index];
  const double step = scene.integration.time_step;
  const bool one = load.vehicle != BodyLoad::every_vehicle || load.history.argument() == LoadArgument::time;
  const std::size_t first = load.vehicle == BodyLoad::every_vehicle ? 0 : static_cast<std::size_t>(load.vehicle);
  const std::size_t end = one ? first + 1 : model.vehicle_x.size();
  Interval shortest{0.0, INFINITY};
  int component = 0;
  for (const LoadHistory::Pulse& pulse : load.history.pulses()) {
    for (std::size_t vehicle = first; vehicle < end; ++vehicle) {
      const Interval acting{time_at(model, load, vehicle, pulse.begin), time_at(model, load, vehicle, pulse.end)};
      if (!acting.meets({0.0, duration}) || acting.high - acting.low >= shortest.high - shortest.low) continue;
      shortest = acting;
      component = pulse.component;
    }
  }
  const double length = shortest.high - shortest.low;
  if (length >= resolved * step * (1.0 - 1e-9)) return std::nullopt;
  return fmt::format(
      "[[load]] {} of {}: {} rises and falls within {:.3g} s at t = {:.6g} s, in less than four time steps ({:.3g} s): "
      "it may act in part or not at all; an integration.time_step of {:.3g} s resolves it",
      index + 1, scene.loads.size(), names[component], length, shortest.low, resolved * step, length / resolved);
}

/// The stretch of x that a station's record has a share in.
Interval reach_of_station(const std::vector<GroundMotionParameters>& stations, std::size_t index) {
  return {index == 0 ? -INFINITY : stations[index - 1].x,
          index + 1 == stations.size() ? INFINITY : stations[index + 1].x};
}

/// Where the ground moves something: wheels, and supports of the structure.
Interval ground_way(const VsiModel& model, Interval way) {
  if (!model.structure) return way;
  for (const double x : model.structure->supports.x) way = {std::min(way.low, x), std::max(way.high, x)};
  return way;
}

std::optional<std::string> of_drift_correction(const GroundRecord& record, const std::string& place) {
  constexpr double noticeable = 0.1;  // of the peak: real records need a few per cent
  std::string parts;
  for (Eigen::Index k = 0; k < 2; ++k) {
    const double given = record.given_peak()[k], added = record.drift_correction()[k];
    if (added <= noticeable * given) continue;
    parts += fmt::format("{}{}: up to {:.3g} m/s² added to a peak of {:.3g} m/s², which is {:.3g} m/s² then ({:.0f} %)",
                         parts.empty() ? "" : "; ", k == 0 ? "y" : "z", added, given, record.peak()[k],
                         100.0 * record.peak()[k] / given);
  }
  if (parts.empty()) return std::nullopt;
  return fmt::format(
      "{}: the straight line that lets the ground end at rest where it began changes the record ({}): is "
      "it whole, and an acceleration?",
      place, parts);
}

/// What a record does, and what of it reaches nothing.
void of_ground(const SceneParameters& scene, const VsiModel& model, std::size_t index, const Interval& way,
               double duration, std::vector<std::string>& warnings) {
  const GroundMotionParameters& ground = scene.ground_motion[index];
  const std::string place = fmt::format("[[ground_motion]] {} of {}", index + 1, scene.ground_motion.size());
  const GroundRecord record = read_ground_record(ground.file);
  const GroundVector peak = record.peak();
  constexpr double rounding = 1e-12;  // of the correction of a constant
  if (ground.factor == 0.0) {
    warnings.push_back(place + " is taken times 0: the ground stays at rest");
  } else if (record.given_peak().isZero(0.0)) {
    warnings.push_back(place + " is zero throughout: the ground stays at rest");
  } else if (auto corrected = of_drift_correction(record, place)) {
    warnings.push_back(std::move(*corrected));
  }
  if (vehicle_plane(scene) == MotionPlane::vertical && peak[0] > rounding * record.given_peak()[0]) {
    warnings.push_back(place + (lateral_ground_is_left_out(scene)
                                    ? " moves the ground along y too: nothing in a vertical scene follows it"
                                    : " moves the ground along y: the structure follows it, the train, whose wheels "
                                      "follow the rails vertically, does not"));
  }
  const double begin = record.begin() + ground.start;
  if (begin >= duration) {
    warnings.push_back(fmt::format("{} begins at t = {:.6g} s, the run ends at {:.6g} s: the ground stays at rest",
                                   place, begin, duration));
  }
  const Interval moved = ground_way(model, way);
  if (scene.ground_motion.size() > 1 && !reach_of_station(scene.ground_motion, index).meets(moved)) {
    warnings.push_back(fmt::format("{}, at x = {:.6g} m, moves nothing: wheels and supports are at {}", place, ground.x,
                                   text(moved, "x", "m")));
  }
}

std::optional<std::string> of_speed(const SceneParameters& scene, const VsiModel& model, double duration) {
  const Interval profile{model.speed_profile->begin(), model.speed_profile->end()}, run{0.0, duration};
  // beyond its points the speed is constant: one that only touches the run changes nothing
  if (profile.low < run.high && run.low < profile.high) return std::nullopt;
  return fmt::format("train.speed_file {} is given for {}, the run is at {}: its {} speed holds throughout",
                     scene.train.speed_file.filename().string(), text(profile, "t", "s"), text(run, "t", "s"),
                     profile.low >= run.high ? "first" : "last");
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
  if (model.irregularity.largest() == 0.0) {
    return fmt::format("irregularity.file {} is zero throughout: the track is perfect",
                       scene.irregularity->filename().string());
  }
  if (measured.meets(way)) return std::nullopt;
  return fmt::format("irregularity.file {} is measured at {}, the wheels run at {}: their track is perfect",
                     scene.irregularity->filename().string(), text(measured, "x", "m"), text(way, "x", "m"));
}

/// Outside a record the track is perfect: where one ends off zero, wheels meet a step.
std::optional<std::string> of_steps_in_irregularity(const SceneParameters& scene, const VsiModel& model,
                                                    const Interval& way) {
  constexpr double noticeable = 1e-4;  // [m]
  std::string steps;
  const auto step_at = [&](double x, std::string_view verb) {
    if (x < way.low || x > way.high) return;
    const RailDeviation left = model.irregularity.at(RailSide::left, x),
                        right = model.irregularity.at(RailSide::right, x);
    std::pair<std::string_view, double> largest{"", 0.0};
    for (const auto& column : {std::pair<std::string_view, double>{"y_left", left.y},
                               {"z_left", left.z},
                               {"y_right", right.y},
                               {"z_right", right.z}}) {
      if (std::abs(column.second) > std::abs(largest.second)) largest = column;
    }
    if (std::abs(largest.second) <= noticeable) return;
    steps += fmt::format("{}{} at x = {:.6g} m with {} = {:.3g} mm", steps.empty() ? "" : " and ", verb, x,
                         largest.first, 1e3 * largest.second);
  };
  step_at(model.irregularity.begin(), "begins");
  step_at(model.irregularity.end(), "ends");
  if (steps.empty()) return std::nullopt;
  return fmt::format(
      "irregularity.file {} {}, not with zero: {}; fade the record in and out, or let it reach beyond the run",
      scene.irregularity->filename().string(), steps,
      model.normal_contact == NormalContact::rigid
          ? "wheels that follow the rails jump there, without the force that it would take"
          : "wheels meet a step there, whose force grows without bound as integration.time_step shrinks");
}

}  // namespace

std::vector<std::string> scene_warnings(const SceneParameters& scene, const VsiModel& model) {
  const double duration = run_duration(scene, model);
  const Interval way = wheel_way(model, duration);
  std::vector<std::string> warnings = model.structure_doubts;
  const auto add = [&](std::optional<std::string> warning) {
    if (warning) warnings.push_back(std::move(*warning));
  };
  if (scene.contact.normal == NormalContact::hertz && scene.contact.mode == ContactMode::paper &&
      scene.integration.contact_force == ContactForceRule::energy) {
    warnings.emplace_back(
        "integration.contact_force = \"energy\" with contact.mode = \"paper\": its contact points jump, no force keeps "
        "the springs' energy over a jump, and a step may have no solution; \"automatic\" takes \"endpoint\"");
  }
  for (std::size_t i = 0; i < scene.loads.size(); ++i) {
    add(of_load(scene, model, i, duration));
    add(of_short_load(scene, model, i, duration));
  }
  for (std::size_t i = 0; i < scene.ground_motion.size(); ++i) of_ground(scene, model, i, way, duration, warnings);
  if (model.speed_profile) add(of_speed(scene, model, duration));
  if (scene.span_deviation) add(of_deviation(*scene.span_deviation, way));
  if (scene.irregularity) {
    add(of_irregularity(scene, model, way));
    add(of_steps_in_irregularity(scene, model, way));
  }
  return warnings;
}

}  // namespace railtab
