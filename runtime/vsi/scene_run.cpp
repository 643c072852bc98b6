#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "plan_memory.hpp"
#include "railtab/runtime/vsi/simulation.hpp"
#include "railtab/runtime/vsi/static_equilibrium.hpp"
#include "railtab/tables/file_checksum.hpp"
#include "railtab/tables/input_error.hpp"
#include "scene_loads.hpp"
#include "scene_structure.hpp"

namespace railtab {

namespace {

// Steps of a run. @throws InputError where nobody could wait for them.
long step_count(const SceneParameters& scene, double duration) {
  constexpr double most = 1e9;
  const double steps = duration / scene.integration.time_step;
  if (!(steps >= 0.5 && steps <= most)) {
    throw input_error("scene: integration.time_step",
                      fmt::format("{:.3g} steps of {} s in {:.3g} s", steps, scene.integration.time_step, duration),
                      fmt::format("1 to {:.0e} steps", most));
  }
  return std::lround(steps);
}

std::string no_equilibrium(const EquilibriumReport& rest) {
  if (rest.deviation_share > 0.0) {
    return fmt::format(
        "no state of rest where the train stands: there is one up to {:.0f} % of the irregularity under it, beyond "
        "that a "
        "wheelset leaves its rails; begin elsewhere (train.start) or with less irregularity",
        100.0 * rest.deviation_share);
  }
  return fmt::format(
      "no state of rest on the smooth track after {} iterations (last change {:.3g} m): do the wheels fit on the rails "
      "(track gauge, flange-back distance, profiles' origins), and can the train bear the loads at t = 0?",
      rest.iterations, rest.change);
}

ResultHeader result_header(const SceneParameters& scene, const VsiModel& model) {
  ResultHeader header;
  header.scene_name = scene.name;
  header.scene_text = scene.text;
  for (const std::filesystem::path& file : scene.files) {
    header.input_files.push_back(file.string());
    header.input_checksums.push_back(file_checksum(file));
  }
  header.program_version = RAILTAB_VERSION;
  header.contact_mode = contact_mode_name(scene.contact);
  header.speed = model.speed(0.0);
  for (int w = 0; w < model.wheelsets(); ++w) {
    const auto body =
        static_cast<std::size_t>(model.vehicle.wheelsets[static_cast<std::size_t>(w % model.wheelsets_per_vehicle())]);
    const double load = model.vehicle.static_load[model.vehicle.dof[body][2]];
    for (int side = 0; side < 2; ++side) {
      header.wheel_x.push_back(model.wheelset_x(w, 0.0) - model.wheelset_x(0, 0.0));
      header.static_wheel_load.push_back(0.5 * load);
    }
  }
  for (std::size_t v = 0; v < model.vehicle_x.size(); ++v) {
    for (const RigidBody& body : model.vehicle.bodies)
      header.body_names.push_back(fmt::format("coach-{}/{}", v + 1, body.name));
  }
  if (model.structure) {
    for (const StructureNode& node : model.structure->nodes) {
      header.node_names.push_back(node.name);
      header.node_x.push_back(node.x);
    }
  }
  if (!model.geometry) return header;
  const WheelRailPair& pair = model.geometry->pair();
  header.wheel_profile = pair.wheel().knots().name;
  header.rail_profile = pair.rail().knots().name;
  header.wheel_y = pair.wheel().knots().y;
  header.wheel_z = pair.wheel().knots().z;
  header.rail_y = pair.rail().knots().y;
  header.rail_z = pair.rail().knots().z;
  return header;
}

// Time that a train runs before its scene begins, so that what the steady start leaves out, the rhythm of the sleepers,
// is there: as long as the modelled track reaches back, for where the rails are rigid there is none. The published
// method has its own state to settle to.
long run_in_steps(const SceneParameters& scene, const VsiModel& model) {
  constexpr double enough = 0.2;  // s: the wheelsets' bouncing on the track has decayed to less than 1e-3
  const auto steps = [&](double time) {
    return time > 0.0 ? static_cast<long>(time / scene.integration.time_step) : 0L;
  };
  if (!model.structure) return model.geometry && model.geometry->is_paper() ? steps(enough) : 0;
  const double rear = model.wheelset_x(model.wheelsets() - 1, 0.0);
  const double track = rear - std::max(model.structure->rail[0].x.front(), model.structure->rail[1].x.front());
  return steps(std::min(enough, 0.8 * track / model.speed(0.0)));
}

// The published search's pairs jump as a wheel moves, and at rest there is no inertia to hold it meanwhile: rest is
// sought with the online search, and the run-in does the difference.
std::optional<VsiModel> other_model_at_rest(const SceneParameters& scene, const VsiModel& model) {
  if (!model.geometry || !model.geometry->is_paper()) return std::nullopt;
  VsiModel rest = model;
  rest.geometry = std::make_shared<const ContactGeometry>(ContactSearch(model.geometry->pair()));
  rest.contact.geometry = rest.geometry.get();
  rest.contact.normal.curvature_floor = scene.contact.curvature_floor;
  return rest;
}

// State at t = 0: steady, and run in where there is track for it. A run-in that fails is left out.
EquilibriumReport start(const SceneParameters& scene, const VsiModel& model, VsiState& state) {
  const std::optional<VsiModel> other = other_model_at_rest(scene, model);
  const VsiModel& at_rest = other ? *other : model;
  const long before = run_in_steps(scene, model);
  if (before > 0) {
    VsiState early(model);
    early.time = -static_cast<double>(before) * scene.integration.time_step;
    const EquilibriumReport rest = steady_start(at_rest, early);
    if (rest.converged && simulate(model, scene.integration, 0.0, 1, early, {}, -before).complete) {
      state = std::move(early);
      return rest;
    }
  }
  return steady_start(at_rest, state);
}

// Where a hunting study begins. @throws InputError where that is beside the rails
void displace(const SceneParameters& scene, const VsiModel& model, VsiState& state) {
  const double shift = scene.train.initial_lateral_shift, yaw = scene.train.initial_yaw;
  if (displace_train(model, shift, yaw, state)) return;
  throw input_error("scene: train.initial_lateral_shift", fmt::format("{} m with a yaw of {} rad", shift, yaw),
                    "a place of the wheelsets at which no flange stands on its rail");
}

std::string reduction_text(const ReductionParameters& reduction) {
  const std::string name = fmt::format("reduction of the structure: {}", reduction_name(reduction.kind));
  if (reduction.kind == Reduction::window) {
    return fmt::format("{}, {:g} m ahead of the train and {:g} m behind take part", name, reduction.ahead,
                       reduction.behind);
  }
  if (reduction.kind == Reduction::modal) {
    return fmt::format("{}, {} modes{}", name, reduction.modes,
                       reduction.static_correction ? " with static correction" : "");
  }
  return fmt::format("{}, {} modes of each part", name, reduction.modes);
}

// What was done to the points of measured profiles.
void note_repairs(const VsiModel& model, const RunObserver& observer) {
  if (!model.geometry) return;
  const WheelRailPair& pair = model.geometry->pair();
  for (const ProfileKnots* profile : {&pair.wheel().knots(), &pair.rail().knots()}) {
    for (const std::string& note : profile->notes) observer.note(note);
  }
}

}  // namespace

RunPlan plan_run(const SceneParameters& scene) {
  const VsiModel model = build_model(scene);
  RunPlan plan;
  plan.structure_dofs = model.structure ? model.structure->dofs() : 0;
  plan.vehicle_dofs = static_cast<long>(model.vehicle.dofs()) * static_cast<long>(model.vehicle_x.size());
  plan.wheels = 2 * model.wheelsets();
  plan.time_step = scene.integration.time_step;
  plan.duration = run_duration(scene, model);
  plan.steps = step_count(scene, plan.duration);
  plan.memory = step_memory(model, scene.integration.time_step, scene.integration.alpha);
  plan.built.push_back(
      fmt::format("{} x {}, {} unknowns each", scene.train.count, scene.train.vehicle, model.vehicle.dofs()));
  if (model.geometry) {
    plan.built.push_back(fmt::format("contact geometry: {}, {} on {}", contact_mode_name(scene.contact),
                                     model.geometry->pair().wheel().knots().name,
                                     model.geometry->pair().rail().knots().name));
    plan.built.push_back(fmt::format("creep forces: {}", scene.contact.creep_law));
  } else {
    plan.built.emplace_back("wheels that follow the rails rigidly, vertical motion only");
    plan.left_out.emplace_back("contact geometry, creep forces, loss of contact: contact.normal is \"rigid\"");
    plan.left_out.emplace_back("lateral, roll and yaw unknowns of the vehicles: nothing moves them");
    if (model.structure && structure_plane(scene) == MotionPlane::vertical && scene.track_kind == TrackKind::flexible) {
      plan.left_out.emplace_back("lateral, roll and yaw unknowns of track and bridge: nothing loads them");
    }
  }
  if (model.structure) {
    plan.built.push_back(fmt::format("{} track, {} rail nodes, {} span(s)",
                                     scene.track_kind == TrackKind::imported ? "imported" : "flexible",
                                     2 * model.structure->rail[0].x.size(), scene.spans.size()));
    if (scene.reduction.kind != Reduction::none) plan.built.push_back(reduction_text(scene.reduction));
  } else {
    plan.left_out.emplace_back("structure unknowns and their factorisation: the track is rigid");
  }
  if (track_on_import(scene)) {
    plan.built.push_back(fmt::format("bridge of {}", scene.structure.files.stiffness.filename().string()));
  } else if (scene.spans.empty() && scene.track_kind != TrackKind::imported)
    plan.left_out.emplace_back("bridge: the scene names none");
  if (scene.spectrum)
    plan.built.push_back(fmt::format("random track: {}, seed {}", scene.spectrum->name, scene.spectrum->seed));
  for (std::string& part : describe_loads(scene, model)) plan.built.push_back(std::move(part));
  if (!scene.irregularity && !scene.spectrum) plan.left_out.emplace_back("irregularity: the scene names none");
  if (model.geometry && scene.contact.mode != ContactMode::table)
    plan.left_out.emplace_back("geometry table look-up: contact is searched in every iteration");
  return plan;
}

RunSummary run_scene(const SceneParameters& scene, const RunObserver& observer,
                     const std::optional<RunCheckpoint>& resume) {
  const auto begin = std::chrono::steady_clock::now();
  const auto setup = [&](std::string_view part) {
    if (observer.setup) observer.setup(part);
  };
  setup("building the model");
  const VsiModel model = build_model(scene);
  if (observer.note) note_repairs(model, observer);
  const double duration = run_duration(scene, model);
  static_cast<void>(step_count(scene, duration));
  VsiState state(model);
  EquilibriumReport rest;
  if (resume) {
    unpack(resume->state, state);
    rest.converged = true;
  } else {
    setup("state of rest");
    rest = start(scene, model, state);
    if (rest.converged) displace(scene, model, state);
  }
  const ResultHeader header = result_header(scene, model);
  const OutputSelection selection(scene.output, header);
  if (observer.start) observer.start(selection.of(header));
  RunSummary summary;
  if (!rest.converged) {
    summary.message = no_equilibrium(rest);
    summary.contact_mode = contact_mode_name(scene.contact);
    return summary;
  }
  RunObserver selected = observer;
  selected.contact_energy = observer.contact_energy || scene.output.energy;
  if (observer.record) {
    selected.record = [&](StepRecord& record) {
      selection.cut(record);
      observer.record(record);
    };
  }
  setup("factorising");
  const double set_up = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  summary =
      simulate(model, scene.integration, duration, scene.output.every, state, selected, resume ? resume->step : 0);
  summary.seconds_setup += set_up;
  summary.seconds_total += set_up;
  summary.contact_mode = contact_mode_name(scene.contact);
  return summary;
}

}  // namespace railtab
