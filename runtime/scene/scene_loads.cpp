#include "railtab/runtime/scene/scene_loads.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numbers>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/line/wind_load.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"

namespace railtab {

namespace {

// Bodies of that name in one coach of a vehicle, or, below 0, in each that has one.
std::vector<int> bodies_of(const VsiModel& model, const std::string& name, int coach, const std::string& place) {
  std::vector<std::string> names;
  std::vector<int> found;
  for (std::size_t b = 0; b < model.vehicle.bodies.size(); ++b) {
    const VehicleBody& body = model.vehicle.bodies[b];
    if (coach >= 0 && body.coach != coach) continue;
    if (body.name == name) found.push_back(static_cast<int>(b));
    if (std::find(names.begin(), names.end(), body.name) == names.end()) names.push_back(body.name);
  }
  if (!found.empty()) return found;
  throw input_error(place, fmt::format("load.body = \"{}\"", name), fmt::format("one of {}", fmt::join(names, ", ")));
}

/// Height of the bodies above the rail-head tops [m]. @throws InputError where they differ
double height_of(const VsiModel& model, const std::vector<int>& bodies, const std::string& place) {
  const auto height = [&](int body) { return -model.vehicle.bodies[static_cast<std::size_t>(body)].position[2]; };
  for (const int body : bodies) {
    if (height(body) == height(bodies.front())) continue;
    throw input_error(place,
                      fmt::format("bodies {:.4g} m and {:.4g} m above the rails", height(bodies.front()), height(body)),
                      "a [[load]] with load.coach for each kind of vehicle: coefficients are those of one");
  }
  return height(bodies.front());
}

LoadHistory wind_history(const VsiModel& model, const LoadParameters& load, const std::vector<int>& bodies,
                         const std::string& place) {
  Aerodynamics vehicle = read_aerodynamics(load.aerodynamics);
  vehicle.area = load.area;
  vehicle.length = load.length;
  const Wind wind{load.wind_direction * std::numbers::pi / 180.0, load.air_density};
  WindHistory history{LoadArgument::time, {0.0}, {load.wind_speed.value_or(0.0)}};
  if (!load.file.empty()) {
    history = read_wind_history(load.file, load.start);
  } else if (load.gust_duration > 0.0) {
    history = wind_gust(*load.wind_speed, load.start, load.gust_duration);
  }
  if (model.speed_profile && history.argument == LoadArgument::position) {
    throw input_error(place, "wind over positions, and train.speed_file", "wind over times t[s], or a constant speed");
  }
  if (model.speed_profile) history = with_points(std::move(history), model.speed_profile->points());
  const auto train_speed = [&](double time) { return model.speed_profile ? model.speed(time) : model.contact.speed; };
  return wind_load_history(vehicle, wind, history, train_speed, height_of(model, bodies, place));
}

LoadHistory load_history(const VsiModel& model, const LoadParameters& load, const std::vector<int>& bodies,
                         const std::string& place) {
  if (!load.aerodynamics.empty()) return wind_history(model, load, bodies, place);
  if (!load.file.empty()) return read_load_history(load.file, load.start);
  ForceAndMoment components;
  for (std::size_t k = 0; k < load.load.size(); ++k)
    components[static_cast<Eigen::Index>(k)] = load.load[k].value_or(0.0);
  if (load.gust_duration > 0.0) return gust_history(components, load.start, load.gust_duration);
  return {LoadArgument::time, {0.0}, {components}};
}

// A load on a motion that the vehicle does not have would be read and not used.
void check_components(const VsiModel& model, const BodyLoad& load, const std::string& place) {
  constexpr const char* names[] = {"Fx", "Fy", "Fz", "Mx", "My", "Mz"};
  const auto acting = load.history.acting();
  for (int k = 0; k < 6; ++k) {
    const bool moves = std::all_of(load.bodies.begin(), load.bodies.end(), [&](int body) {
      return model.vehicle.dof[static_cast<std::size_t>(body)][static_cast<std::size_t>(k)] != held;
    });
    if (!acting[k] || moves) continue;
    throw input_error(
        place, fmt::format("{} on a body without that motion", names[k]),
        "loads on motions that the vehicle has (the car body's x is held; a scene whose wheels follow the "
        "rails has no lateral motion)");
  }
}

void add_body_loads(const SceneParameters& scene, VsiModel& model) {
  int number = 0;
  for (const LoadParameters& load : scene.loads) {
    const std::string place = fmt::format("scene: [[load]] {} of {}", ++number, scene.loads.size());
    const bool all = load.coach == 0;
    const int coaches = model.vehicle.coaches;
    const std::vector<int> bodies = bodies_of(model, load.body, all ? -1 : (load.coach - 1) % coaches, place);
    BodyLoad acting{all ? BodyLoad::every_vehicle : (load.coach - 1) / coaches, bodies,
                    load_history(model, load, bodies, place)};
    check_components(model, acting, place);
    model.loads.push_back(std::move(acting));
  }
}

GroundRecord ground_record(const GroundMotionParameters& ground) {
  GroundRecord record = read_ground_record(ground.file);
  record.scale(ground.factor);
  record.shift(ground.start);
  if (record.begin() < 0.0) {
    throw input_error(ground.file.string(), fmt::format("a record that begins at t = {} s", record.begin()),
                      "one that begins at t >= 0, or a ground_motion.start that makes it so");
  }
  return record;
}

// Where a wave arrives first: no wheel and no support moves before the record's own begin.
double wave_origin(const VsiModel& model, double wave_speed, double duration) {
  double low = model.wheelset_x(model.wheelsets() - 1, 0.0), high = model.wheelset_x(0, duration);
  if (model.structure) {
    for (const double x : model.structure->supports.x) {
      low = std::min(low, x);
      high = std::max(high, x);
    }
  }
  return wave_speed > 0.0 ? low : high;
}

std::string first_record(const SceneParameters& scene) {
  return fmt::format("scene: [[ground_motion]] 1 of {}", scene.ground_motion.size());
}

// An imported structure may not say what its supports do to it.
void check_supports(const SceneParameters& scene, const VsiModel& model) {
  const StructureSupports& supports = model.structure->supports;
  if (supports.columns() == 0) {
    throw input_error(first_record(scene), "an imported structure whose supports have no rows",
                      "a table of dofs with the supports' rows (rail = support), or structure.nodes");
  }
  const std::vector<DofIndices>& rail = model.structure->rail[0].dof;
  const bool beside = std::any_of(rail.begin(), rail.end(), [](const DofIndices& dof) { return dof[1] == held; });
  if (beside && model.normal_contact == NormalContact::hertz) {
    throw input_error(first_record(scene), "rails that have no lateral motion",
                      "rails with it, or contact.normal = \"rigid\"");
  }
  if (supports.alike_only() && !model.ground_motion->uniform()) {
    throw input_error(first_record(scene),
                      "motion that differs along the track, and an imported structure " + supports.beyond,
                      "one record for all, or the rows of all supports in the matrices and a [[support]] for each");
  }
}

void add_ground_motion(const SceneParameters& scene, VsiModel& model) {
  if (scene.ground_motion.empty()) return;
  const GroundMotionParameters& first = scene.ground_motion.front();
  if (scene.ground_motion.size() > 1) {
    std::vector<GroundMotion::Station> stations;
    for (const GroundMotionParameters& g : scene.ground_motion) stations.push_back({g.x, ground_record(g)});
    model.ground_motion.emplace(std::move(stations));
  } else if (first.wave_speed != 0.0) {
    const double origin = wave_origin(model, first.wave_speed, run_duration(scene, model));
    model.ground_motion.emplace(ground_record(first), first.wave_speed, origin);
  } else {
    model.ground_motion.emplace(ground_record(first));
  }
  if (model.structure) check_supports(scene, model);
  const GroundVector peak = model.ground_motion->peak();
  if (lateral_ground_is_left_out(scene) && peak[0] > 0.0 && peak[1] == 0.0) {
    throw input_error(first_record(scene), "lateral motion alone with contact.normal = \"rigid\"",
                      "a column z, or contact.normal = \"hertz\": a vertical scene has no lateral motion");
  }
}

}  // namespace

MotionPlane vehicle_plane(const SceneParameters& scene) noexcept {
  return scene.contact.normal == NormalContact::rigid ? MotionPlane::vertical : MotionPlane::spatial;
}

MotionPlane structure_plane(const SceneParameters& scene) noexcept {
  const bool aside = std::any_of(scene.spans.begin(), scene.spans.end(),
                                 [](const BridgeParameters& span) { return span.track_offset != 0.0; });
  const bool imported = scene.structure.files.given();  // has all its motions
  return aside || imported ? MotionPlane::spatial : vehicle_plane(scene);
}

bool lateral_ground_is_left_out(const SceneParameters& scene) noexcept {
  return vehicle_plane(scene) == MotionPlane::vertical &&
         (scene.track_kind == TrackKind::rigid || structure_plane(scene) == MotionPlane::vertical);
}

void add_loads(const SceneParameters& scene, VsiModel& model) {
  if (!scene.train.speed_file.empty()) {
    model.speed_profile = read_speed_profile(scene.train.speed_file);
    model.contact.speed = model.speed(0.0);
  }
  if (scene.span_deviation) model.span_deviation.emplace(*scene.span_deviation);
  add_body_loads(scene, model);
  add_ground_motion(scene, model);
}

std::vector<std::string> describe_loads(const SceneParameters& scene, const VsiModel& model) {
  std::vector<std::string> parts;
  if (model.speed_profile) parts.push_back("speed over time: " + scene.train.speed_file.filename().string());
  if (scene.span_deviation) {
    const SpanDeviationParameters& d = *scene.span_deviation;
    parts.push_back(fmt::format(
        "{} of {:.3g} m spans by {:.3g} mm, {}", d.shape == SpanDeviationShape::bending ? "bending" : "parallel shift",
        d.span, 1e3 * d.amplitude, d.direction == SpanDeviationDirection::vertical ? "vertical" : "lateral"));
  }
  for (const LoadParameters& load : scene.loads) {
    parts.push_back(fmt::format("load on {} of {}", load.body,
                                load.coach == 0 ? "every coach" : fmt::format("coach {}", load.coach)));
  }
  if (model.ground_motion) {
    const StructureSupports none;
    const StructureSupports& supports = model.structure ? model.structure->supports : none;
    const std::string under = supports.carried.size() > 0 ? "all supports, displacements relative to what they carry"
                                                          : fmt::format("{} supports", supports.x.size());
    parts.push_back(fmt::format("ground motion, {} record(s), under {}", scene.ground_motion.size(), under));
  }
  return parts;
}

}  // namespace railtab
