#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "railtab/runtime/scene/scene_case.hpp"

// Loads that do not act in the run, or that its time steps may miss.

namespace railtab::scene {
namespace {

std::string place_of_load(const SceneCase& at, std::size_t index) {
  return fmt::format("[[load]] {} of {}", index + 1, at.scene.loads.size());
}

bool is_zero(const SceneCase& at, std::size_t index) { return !at.model.loads[index].history.acting().any(); }

/// Where a vehicle's body is at t = 0 [m].
double start_of_body(const VsiModel& model, std::size_t vehicle, int body) {
  return model.vehicle_x[vehicle] + model.vehicle.bodies[static_cast<std::size_t>(body)].position[0];
}

/// Where the bodies run that a load acts on.
Interval body_way(const VsiModel& model, const BodyLoad& load, double duration) {
  const bool all = load.vehicle == BodyLoad::every_vehicle;
  const std::size_t first = all ? 0 : static_cast<std::size_t>(load.vehicle);
  return {start_of_body(model, all ? model.vehicle_x.size() - 1 : first, load.bodies.back()),
          start_of_body(model, first, load.bodies.front()) + model.distance(duration)};
}

std::optional<std::string> outside_run(const SceneCase& at, std::size_t index) {
  const LoadParameters& load = at.scene.loads[index];
  const BodyLoad& acting = at.model.loads[index];
  if (is_zero(at, index)) return std::nullopt;
  if (load.file.empty() && load.gust_duration == 0.0) return std::nullopt;  // constant
  const bool over_time = acting.history.argument() == LoadArgument::time;
  const Interval run = over_time ? Interval{0.0, at.duration} : body_way(at.model, acting, at.duration);
  const Interval history{acting.history.begin(), acting.history.end()};
  if (history.meets(run)) return std::nullopt;
  const std::string_view value = load.file.empty()        ? "it does not act"
                                 : history.high < run.low ? "its last value acts throughout"
                                                          : "its first value acts throughout";
  const std::string_view name = over_time ? "t" : "x", unit = over_time ? "s" : "m";
  return fmt::format("{} is specified for {}, the run is at {}: {}", place_of_load(at, index),
                     text(history, name, unit), text(run, name, unit), value);
}

/// When a load is at a point of its history: a time, or the place of a vehicle's loaded body.
double time_at(const VsiModel& model, const BodyLoad& load, std::size_t vehicle, int body, double point) {
  if (load.history.argument() == LoadArgument::time) return point;
  const double run = point - start_of_body(model, vehicle, body);
  return model.speed_profile ? model.speed_profile->time_at(run) : run / model.contact.speed;
}

/// A load that rises and falls within a few steps: what acts of it is what the ends of steps happen to meet.
std::optional<std::string> short_pulse(const SceneCase& at, std::size_t index) {
  constexpr double resolved = 4.0;  // steps from a rise to the end of the fall
  constexpr const char* names[] = {"Fx", "Fy", "Fz", "Mx", "My", "Mz"};
  const VsiModel& model = at.model;
  const BodyLoad& load = model.loads[index];
  const double step = at.scene.integration.time_step;
  const bool one = load.vehicle != BodyLoad::every_vehicle || load.history.argument() == LoadArgument::time;
  const std::size_t first = load.vehicle == BodyLoad::every_vehicle ? 0 : static_cast<std::size_t>(load.vehicle);
  const std::size_t end = one ? first + 1 : model.vehicle_x.size();
  Interval shortest{0.0, INFINITY};
  int component = 0;
  for (const LoadHistory::Pulse& pulse : load.history.pulses()) {
    for (std::size_t vehicle = first; vehicle < end; ++vehicle) {
      for (const int body : load.bodies) {
        const Interval acting{time_at(model, load, vehicle, body, pulse.begin),
                              time_at(model, load, vehicle, body, pulse.end)};
        if (!acting.meets({0.0, at.duration}) || acting.high - acting.low >= shortest.high - shortest.low) continue;
        shortest = acting;
        component = pulse.component;
      }
    }
  }
  const double length = shortest.high - shortest.low;
  if (length >= resolved * step * (1.0 - 1e-9)) return std::nullopt;
  return fmt::format(
      "{}: {} rises and falls within {:.3g} s at t = {:.6g} s, in less than four time steps ({:.3g} s): "
      "it may act in part or not at all; an integration.time_step of {:.3g} s resolves it",
      place_of_load(at, index), names[component], length, shortest.low, resolved * step, length / resolved);
}

/// One warning for each load for which `warning` says something.
template <class Warning>
void of_loads(const SceneCase& at, Warnings& list, const Warning& warning) {
  for (std::size_t i = 0; i < at.scene.loads.size(); ++i) {
    if (std::optional<std::string> said = warning(at, i)) list.push_back(std::move(*said));
  }
}

}  // namespace

const Warning load_zero{"the load is zero throughout", [](const SceneCase& at, Warnings& list) {
                          of_loads(at, list, [](const SceneCase& c, std::size_t i) -> std::optional<std::string> {
                            if (!is_zero(c, i)) return std::nullopt;
                            return place_of_load(c, i) + " is zero throughout: it does not act";
                          });
                        }};
const Warning load_outside_run{"the load lies outside the run",
                               [](const SceneCase& at, Warnings& list) { of_loads(at, list, outside_run); }};
const Warning load_shorter_than_steps{"the load rises and falls within four time steps",
                                      [](const SceneCase& at, Warnings& list) { of_loads(at, list, short_pulse); }};

}  // namespace railtab::scene
