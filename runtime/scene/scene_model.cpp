#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/scene/judged_stretch.hpp"
#include "railtab/runtime/scene/scene_contact.hpp"
#include "railtab/runtime/scene/scene_loads.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/scene/scene_structure.hpp"
#include "railtab/runtime/scene/scene_wheels.hpp"
#include "railtab/runtime/scene/shared_setup.hpp"
#include "railtab/runtime/stability/rigid_rails.hpp"
#include "railtab/runtime/structure/carried_motion.hpp"
#include "railtab/runtime/vehicle/consist.hpp"
#include "railtab/runtime/vehicle/vehicle_library.hpp"
#include "railtab/runtime/vsi/support_motion.hpp"

namespace railtab {

namespace {

double spans_length(const SceneParameters& scene) {
  double length = 0.0;
  for (const BridgeParameters& span : scene.spans) length += span.length;
  return length;
}

// Along the track's plane to the right, and normal to it.
double lateral_acceleration(const TrainParameters& train) {
  const double sine = train.cant_sine();
  return train.lateral_acceleration * std::sqrt(1.0 - sine * sine) - standard_gravity * sine;
}
double normal_gravity(const TrainParameters& train) {
  const double sine = train.cant_sine();
  return standard_gravity * std::sqrt(1.0 - sine * sine) + train.lateral_acceleration * sine;
}

// The vehicles as one system where they differ, are turned or have joints; else none.
std::optional<VehicleModel> scene_consist(const TrainParameters& train, MotionPlane plane,
                                          const VehicleWeight& weight) {
  const std::vector<ConsistEntry> entries = train.entries();
  const bool alike = std::all_of(entries.begin(), entries.end(), [&](const ConsistEntry& entry) {
    return entry.vehicle == entries.front().vehicle && !entry.reversed;
  });
  const VehicleData data = find_vehicle(entries.front().vehicle);
  const bool joined = !train.joint.empty() || !data.joint_front.empty() || !data.joint_rear.empty();
  if (alike && (!joined || train.vehicles() == 1)) return {};
  return build_consist(read_consist(entries, train.joint), plane, weight, train.force_elements);
}

VehicleModel scene_vehicle(const SceneParameters& scene) {
  const MotionPlane plane = vehicle_plane(scene);
  const VehicleWeight weight{normal_gravity(scene.train), scene.train.geometric_stiffness};
  if (scene.train.vehicle == imported_vehicle) return import_vehicle(scene.vehicle, plane, weight);
  if (weight.geometric_stiffness == GeometricStiffness::in_matrices) {
    throw input_error("scene: train.geometric_stiffness", "\"in-matrices\" with a vehicle that is not imported",
                      "\"included\" or \"omitted\"");
  }
  if (std::optional<VehicleModel> consist = scene_consist(scene.train, plane, weight)) return *std::move(consist);
  const VehicleData data = find_vehicle(scene.train.entries().front().vehicle);
  if (data.motion == MotionPlane::vertical && plane != MotionPlane::vertical) {
    throw input_error(
        "scene: train.vehicle", fmt::format("{}, whose data are vertical only", data.name),
        "contact.normal = \"rigid\", or a copy of its file (vsi vehicle NAME --toml) with the lateral values "
        "as named assumptions");
  }
  require_closing(data);
  return build_vehicle(data, plane, weight, scene.train.force_elements);
}

// The first wheelset stands at `start`; coaches follow each other at their length over couplers.
std::vector<double> vehicle_positions(const TrainParameters& train, const VehicleModel& vehicle) {
  const double first_wheelset = vehicle.bodies[static_cast<std::size_t>(vehicle.wheelsets.front())].position[0];
  std::vector<double> x;
  const int systems = train.vehicle == imported_vehicle ? train.count : train.vehicles() / vehicle.coaches;
  for (int i = 0; i < systems; ++i) x.push_back(train.start - first_wheelset - i * vehicle.length);
  return x;
}

void check_on_track(const SceneParameters& scene, const VsiModel& model) {
  if (!model.structure) return;
  const RailLine& rail = model.structure->rail[0];
  const double last = model.wheelset_x(model.wheelsets() - 1, 0.0);
  const double end = model.wheelset_x(0, run_duration(scene, model));
  const auto where = [&] { return fmt::format("{:.2f} m to {:.2f} m", rail.x.front(), rail.x.back()); };
  if (last < rail.x.front() || scene.train.start > rail.x.back()) {
    throw input_error("scene: train.start",
                      fmt::format("wheelsets from x = {:.2f} m to {:.2f} m", last, scene.train.start),
                      fmt::format("all on the modelled track, {} (track.length_before)", where()));
  }
  if (end > rail.x.back()) {
    throw input_error(
        "scene: track.length_after", fmt::format("a run that ends with the first wheelset at x = {:.2f} m", end),
        fmt::format("one that ends on the modelled track, {} (a longer track or a shorter duration)", where()));
  }
}

// A random track as far as the train runs, its pre-roll included.
Irregularity random_track(const SceneParameters& scene, const VsiModel& model) {
  constexpr double margin = 50.0;  // m
  const double end = run_duration(scene, model);
  return random_irregularity(*scene.spectrum, model.wheelset_x(model.wheelsets() - 1, 0.0) - margin,
                             model.wheelset_x(0, end) + margin, scene.train.start);
}

// The structure as the steps will have it.
void reduce(const ReductionParameters& reduction, VsiModel& model, SharedSetUp* shared) {
  if (!model.structure) return;
  if (model.ground_motion && reduction.kind != Reduction::none) {
    StructureModel moved = *model.structure;
    moved.supports = gathered(moved.supports, *model.ground_motion);
    model.structure = share(relative_to_supports(std::move(moved)));
  }
  switch (reduction.kind) {
    case Reduction::window:
      if (model.structure->dof_x.empty()) {
        throw input_error("scene: structure.reduction", "\"window\" of an imported structure",
                          "\"none\": the positions of its degrees of freedom along the track are not known");
      }
      model.window = shared && !model.ground_motion ? shared->window(model.structure, reduction)
                                                    : make_window(*model.structure, reduction);
      break;
    case Reduction::none:
      break;
  }
}

}  // namespace

VsiModel train_model(const SceneParameters& scene) {
  VsiModel model;
  model.vehicle = scene_vehicle(scene);
  model.vehicle_x = vehicle_positions(scene.train, model.vehicle);
  return model;
}

VsiModel stability_model(const SceneParameters& scene, const VsiModel& model, int first_wheelset) {
  SceneParameters linear = scene;
  linear.train.force_elements = ForceElementChoice::linear;
  return on_rigid_rails(model, scene_vehicle(linear), first_wheelset, model.contact.speed);
}

VsiModel stability_model(const SceneParameters& scene) {
  if (scene.contact.normal != NormalContact::hertz) {
    throw input_error("scene: contact.normal", "\"rigid\"", "\"hertz\": wheels that follow the rails cannot hunt");
  }
  VsiModel contacts = train_model(scene);
  add_contact(scene, contacts);
  return stability_model(scene, contacts);
}

VsiModel limit_cycle_model(const SceneParameters& scene) {
  VsiModel model = stability_model(scene);
  model.vehicle = scene_vehicle(scene);
  return model;
}

VsiModel build_model(const SceneParameters& scene, SharedSetUp* shared) {
  scene.validate();
  VsiModel model = train_model(scene);
  model.lateral_acceleration = lateral_acceleration(scene.train);
  model.judged = judged_stretch(scene);
  model.normal_contact = scene.contact.normal;
  model.contact.speed = scene.train.speed;
  if (scene.contact.normal == NormalContact::hertz) add_contact(scene, model, shared);
  if (shared) model.store = shared->structures();
  if (scene.track_kind != TrackKind::rigid) {
    model.structure = shared ? shared->structure(scene) : share(scene_structure(scene));
    model.structure_warnings = model.structure->warnings;
  }
  if (scene.irregularity) model.irregularity = read_irregularity(*scene.irregularity);
  add_loads(scene, model);
  add_wheel_deviations(scene, model);
  add_friction(scene, model);
  if (scene.spectrum) model.irregularity = random_track(scene, model);
  check_on_track(scene, model);
  reduce(scene.reduction, model, shared);
  return model;
}

double run_duration(const SceneParameters& scene, const VsiModel& model) {
  if (scene.integration.duration > 0.0) return scene.integration.duration;
  const auto time_to = [&](double x) {
    const double last = model.wheelset_x(model.wheelsets() - 1, 0.0), way = x - last;
    if (!(way > 0.0)) {
      throw input_error("scene: train.start", fmt::format("the last wheelset at x = {:.6g} m", last),
                        fmt::format("it before x = {:.6g} m, where the run ends, or integration.duration", x));
    }
    const double crossing = model.speed_profile ? model.speed_profile->time_at(way) : way / model.contact.speed;
    if (!std::isfinite(crossing)) {
      throw input_error("scene: train.speed_file",
                        fmt::format("a train that stops before its last wheelset is at x = {:.6g} m", x),
                        "one that leaves the bridge, or integration.duration");
    }
    return crossing + scene.integration.free_vibration;
  };
  if (track_on_import(scene)) {
    // the track goes on for length_after, rounded up to whole bays
    return time_to(model.structure->rail[0].x.back() - scene.track.length_after);
  }
  if (scene.spans.empty()) {
    throw input_error("scene: integration.duration", "none, and no bridge",
                      "a duration in s, or a [[bridge]] to cross");
  }
  return time_to(spans_length(scene));
}

}  // namespace railtab
