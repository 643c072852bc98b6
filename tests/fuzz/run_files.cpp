#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/line/body_load.hpp"
#include "railtab/runtime/line/ground_motion.hpp"
#include "railtab/runtime/line/ground_record.hpp"
#include "railtab/runtime/line/irregularity.hpp"
#include "railtab/runtime/line/speed_profile.hpp"
#include "railtab/runtime/line/wind_load.hpp"
#include "railtab/runtime/scene/scene_keys.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/scene/scene_run.hpp"
#include "railtab/runtime/vsi/simulation.hpp"
#include "reading.hpp"

namespace railtab::fuzz {

namespace {

/// Places between `low` and `high` and beyond both.
std::array<double, 6> places(double low, double high) {
  return {low - 1.0, low, low + 0.3 * (high - low), low + 0.7 * (high - low), high, high + 1.0};
}

/// What takes seconds, or all memory, because that was asked for.
bool is_large(const SceneParameters& scene) {
  double length = scene.track.length_before + scene.track.length_after;
  long elements = 0;
  for (const BridgeParameters& span : scene.spans) {
    length += span.length;
    elements += span.elements;
  }
  const double bays = length / scene.track.sleeper_spacing;
  constexpr double most_rail_elements = 60.0, longest_random_track = 1000.0;
  return scene.train.count > 3 || elements > 200 ||
         (scene.track_kind == TrackKind::flexible &&
          bays * std::max(1, scene.track.elements_per_bay) > most_rail_elements) ||
         (scene.spectrum && scene.integration.duration * scene.train.speed > longest_random_track);
}

}  // namespace

void read_irregularity_file(const Path& file) {
  const Irregularity irregularity = read_irregularity(file);
  for (const double x : places(irregularity.begin(), irregularity.end())) {
    for (const RailSide side : {RailSide::left, RailSide::right}) {
      const RailDeviation d = irregularity.at(side, x);
      require_finite({d.y, d.z, d.dy_dx, d.dz_dx, d.ddy_dx2, d.ddz_dx2}, "an irregularity");
    }
  }
}

void read_load_file(const Path& file) {
  const LoadHistory history = read_load_history(file, 0.5);
  static_cast<void>(history.acting());
  for (const double point : {-1e6, 0.0, 0.5, 0.7, 1.25, 1e6}) {
    const ForceAndMoment load = history.at(point);
    require_finite({load[0], load[1], load[2], load[3], load[4], load[5]}, "a load");
  }
}

void require_finite(const LoadHistory& history) {
  for (const double point : {-1e6, 0.0, 0.3, 0.7, 1.25, 1e6}) {
    const ForceAndMoment load = history.at(point);
    require_finite({load[0], load[1], load[2], load[3], load[4], load[5]}, "a load of wind");
  }
}

void read_aerodynamics_file(const Path& file) {
  const Aerodynamics vehicle = read_aerodynamics(file);
  for (const double direction : {0.0, 1.5, -2.5}) {
    require_finite(wind_load_history(
        vehicle, {direction}, wind_gust(20.0, 0.0, 1.0), [](double) { return 30.0; }, 2.0));
  }
}

void read_wind_file(const Path& file) {
  Aerodynamics vehicle;
  vehicle.yaw = {0.0, 1.0, 3.2};
  vehicle.coefficient.assign(3, ForceAndMoment::Constant(2.0));
  const WindHistory history = with_points(read_wind_history(file, 0.5), {-1.0, 0.7, 1e5});
  const auto speed = [](double time) { return time < 0.7 ? 40.0 : 20.0; };
  require_finite(wind_load_history(vehicle, {2.0}, history, speed, 2.0));
}

void read_ground_file(const Path& file) {
  GroundRecord record = read_ground_record(file);
  record.scale(-2.0);
  record.shift(1.0);
  const auto times = places(record.begin(), record.end());
  for (const double time : times) {
    const GroundState state = record.at(time);
    require_finite({state.displacement[0], state.displacement[1], state.velocity[0], state.velocity[1],
                    state.acceleration[0], state.acceleration[1]},
                   "a motion of the ground");
  }
  const GroundMotion wave(std::move(record), 300.0, -50.0);
  for (const double time : times) {
    const GroundPoint point = wave.at(10.0, time);
    require_finite({point.slope[0], point.slope[1], point.curvature[0], point.curvature[1]}, "a wave in the ground");
  }
}

void read_speed_file(const Path& file) {
  const SpeedProfile profile = read_speed_profile(file);
  for (const double time : {-1.0, 0.0, 0.3, 1.0, 7.5, 1e4}) {
    require_finite({profile.speed(time), profile.acceleration(time), profile.distance(time)}, "a speed");
    if (std::isnan(profile.time_at(time))) throw std::runtime_error("the time of a place is not a number");
  }
}

void read_scene_file(const Path& file) { static_cast<void>(read_scene(file)); }

void run_scene_file(const Path& file) {
  SceneParameters scene = read_scene(file);
  if (is_large(scene)) return;
  try {
    const VsiModel model = build_model(scene);
    const double duration = run_duration(scene, model);
    require_finite({duration}, "the duration of a run");
    scene.integration.max_halvings = std::min(scene.integration.max_halvings, 2);
    VsiState state(model);
    static_cast<void>(simulate(model, scene.integration, 2.0 * scene.integration.time_step, 1, state, {}));
  } catch (const ComputationError&) {  // a model that cannot be solved is no fault of the reader
  }
}

std::string scene_vocabulary() {
  std::string lines;
  for (const SceneKey& key : scene_keys()) {
    const std::size_t dot = key.path.rfind('.');
    const bool top = dot == std::string::npos;
    const std::string section = top ? "" : key.path.substr(0, dot);
    const bool list = section == "bridge" || section == "support" || section == "load" || section == "ground_motion";
    if (!top) lines += list ? "[[" + section + "]]\n" : "[" + section + "]\n";
    const bool number = key.type == "number" || key.type == "integer" || key.type == "ratio";
    const bool bare =
        number || key.default_value == "true" || key.default_value == "false" || key.type == "list of texts";
    const std::string value = key.default_value.empty() ? (number ? "1" : "\"\"")
                              : bare                    ? key.default_value
                                                        : "\"" + key.default_value + "\"";
    lines += (top ? key.path : key.path.substr(dot + 1)) + " = " + value + "\n";
  }
  return lines;
}

}  // namespace railtab::fuzz
