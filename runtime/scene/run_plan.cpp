#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "railtab/runtime/scene/key_table.hpp"
#include "railtab/runtime/scene/plan_memory.hpp"
#include "railtab/runtime/scene/result_header.hpp"
#include "railtab/runtime/scene/run_plan.hpp"
#include "railtab/runtime/scene/scene_contact.hpp"
#include "railtab/runtime/scene/scene_loads.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/scene/scene_structure.hpp"
#include "railtab/runtime/scene/scene_warnings.hpp"
#include "railtab/runtime/scene/step_count.hpp"
#include "railtab/runtime/vehicle/static_wheel_load.hpp"
#include "railtab/runtime/vehicle/vehicle_summary.hpp"

namespace railtab {

namespace {

std::string reduction_text(const ReductionParameters& reduction) {
  return fmt::format(
      "reduction of the structure: {}, the window reaches {:g} m ahead of the train and {:g} m behind it",
      reduction_name(reduction.kind), reduction.ahead, reduction.behind);
}

// A line for each coach of a train that is one system: where its wheelsets stand and what they carry.
void describe_coaches(const VehicleModel& vehicle, ModelParts& plan) {
  if (vehicle.coaches == 1) return;
  const double front = vehicle.bodies[static_cast<std::size_t>(vehicle.wheelsets.front())].position.x();
  for (int coach = 0; coach < vehicle.coaches; ++coach) {
    std::vector<std::string> wheelsets;
    for (std::size_t w = 0; w < vehicle.wheelsets.size(); ++w) {
      const VehicleBody& body = vehicle.bodies[static_cast<std::size_t>(vehicle.wheelsets[w])];
      if (body.coach != coach) continue;
      wheelsets.push_back(fmt::format("{:.4g} kN at {:.2f} m", 1e-3 * static_wheel_load(vehicle, static_cast<int>(w)),
                                      front - body.position.x()));
    }
    plan.built.push_back(fmt::format("coach {}: wheels carry {}", coach + 1,
                                     wheelsets.empty() ? "nothing, it stands on its neighbours' bogies"
                                                       : fmt::format("{}", fmt::join(wheelsets, ", "))));
  }
}

void describe_vehicle(const SceneParameters& scene, const VsiModel& model, ModelParts& plan) {
  plan.built.push_back(fmt::format("{} x {}, {} degrees of freedom each", model.vehicle_x.size(),
                                   scene.train.vehicle == imported_vehicle ? scene.train.vehicle : model.vehicle.name,
                                   model.vehicle.dofs()));
  describe_coaches(model.vehicle, plan);
  for (const std::string& element : model.vehicle.nonlinear) {
    plan.built.push_back(fmt::format("not linear of {}: {}", model.vehicle.name, element));
  }
  for (const std::string& element : model.vehicle.left_out) {
    plan.built.push_back(fmt::format("not modelled of {}: {}", model.vehicle.name, element));
  }
  if (scene.train.vehicle != imported_vehicle) return;
  constexpr int modes = 6;
  VehicleSummary vehicle = summarise(model.vehicle, modes);
  for (double& load : vehicle.wheel_load) load *= 1e-3;
  plan.built.push_back(fmt::format("vehicle of {}: {:.6g} kg, wheels of the wheelsets carry {:.4g} kN at rest",
                                   scene.vehicle.stiffness.filename().string(), vehicle.mass,
                                   fmt::join(vehicle.wheel_load, ", ")));
  plan.built.push_back(fmt::format("its lowest natural frequencies on standing wheelsets: {:.4g} Hz",
                                   fmt::join(vehicle.frequencies, ", ")));
}

void describe_contact(const SceneParameters& scene, const VsiModel& model, ModelParts& plan) {
  if (model.geometry) {
    for (const auto& geometry : contact_geometries(model)) {
      const WheelRailPair& pair = geometry->pair();
      const std::string coaches = model.wheelset_geometry.empty() ? "" : "coach " + coaches_on(model, *geometry) + ": ";
      plan.built.push_back(fmt::format("{}contact geometry: {}, {} on {}", coaches, contact_mode_name(scene.contact),
                                       profile_in_words(pair.wheel().knots()), profile_in_words(pair.rail().knots())));
      plan.built.push_back(coaches +
                           (geometry->loaded()
                                ? "elastic contact forces: half-space solutions, from the loaded part of the table"
                                : "elastic contact forces: an ellipse per patch"));
    }
    plan.built.push_back(fmt::format("creep forces: {}{}", scene.contact.creep_law,
                                     scene.contact.creep_law == "linear" ? ", without the bound of friction" : ""));
    if (!scene.contact.friction_file.empty()) {
      plan.built.push_back(fmt::format("friction of {}", scene.contact.friction_file.filename().string()));
    }
    return;
  }
  plan.built.emplace_back("wheels that follow the rails rigidly, vertical motion only");
  plan.left_out.emplace_back("lateral, roll and yaw degrees of freedom of the vehicles: nothing moves them");
  if (model.structure && structure_plane(scene) == MotionPlane::vertical && scene.track_kind == TrackKind::flexible) {
    plan.left_out.emplace_back("lateral, roll and yaw degrees of freedom of track and bridge: nothing loads them");
  }
}

void describe_structure(const SceneParameters& scene, const VsiModel& model, ModelParts& plan) {
  if (model.structure) {
    const std::size_t spans = scene.spans.size();
    plan.built.push_back(fmt::format("{} track, {} rail nodes{}",
                                     scene.track_kind == TrackKind::imported ? "imported" : "flexible",
                                     2 * model.structure->rail[0].x.size(),
                                     spans == 0 ? "" : fmt::format(", {} span{}", spans, spans == 1 ? "" : "s")));
    if (scene.reduction.kind != Reduction::none) plan.built.push_back(reduction_text(scene.reduction));
    for (const std::string& part : model.structure->left_out) plan.left_out.push_back(part);
  }
  if (track_on_import(scene)) {
    const FeFiles& files = scene.structure.files;
    const std::filesystem::path& file = files.by_modes() ? files.modes : files.stiffness;
    plan.built.push_back(
        fmt::format("bridge of {}{}", files.by_modes() ? "the modes in " : "", file.filename().string()));
  }
}

void describe_track(const SceneParameters& scene, const VsiModel& model, ModelParts& plan) {
  if (scene.spectrum) {
    plan.built.push_back(fmt::format("random track: {}, seed {}, rising from zero over {:g} m", scene.spectrum->name,
                                     scene.spectrum->seed, scene.spectrum->fade_length()));
  } else if (scene.irregularity) {
    plan.built.push_back(fmt::format("irregularity of {}, measured at x = {:.6g} to {:.6g} m",
                                     scene.irregularity->filename().string(), model.irregularity.begin(),
                                     model.irregularity.end()));
  }
}

constexpr double wide = 1000.0;  // entries per degree of freedom: tracks have 20, bridges of 120 000 in solids 100

}  // namespace

ModelParts model_parts(const SceneParameters& scene, const VsiModel& model) {
  ModelParts parts;
  for (const scene::KeyRow& row : scene::all_keys()) {
    std::string part = row.left_out ? row.left_out(scene) : "";
    if (!part.empty()) parts.left_out.push_back(std::move(part));
  }
  describe_vehicle(scene, model, parts);
  describe_contact(scene, model, parts);
  describe_structure(scene, model, parts);
  describe_track(scene, model, parts);
  for (std::string& part : describe_loads(scene, model)) parts.built.push_back(std::move(part));
  return parts;
}

RunPlan plan_run(const SceneParameters& scene, const std::function<void(std::string_view part)>& setup) {
  if (setup) setup("building the model");
  const VsiModel model = build_model(scene);
  RunPlan plan;
  plan.structure_dofs = model.structure ? model.structure->dofs() : 0;
  plan.vehicle_dofs = static_cast<long>(model.vehicle.dofs()) * static_cast<long>(model.vehicle_x.size());
  plan.wheels = 2 * model.wheelsets();
  plan.time_step = scene.integration.time_step;
  plan.steps = step_count(scene.integration, run_duration(scene, model));
  plan.pre_roll_steps = pre_roll_steps(scene.integration, model);
  plan.duration = static_cast<double>(plan.steps) * scene.integration.time_step;
  static_cast<void>(OutputSelection(scene.output, model_header(model)));
  plan.warnings = scene_warnings(scene, model);
  static_cast<ModelParts&>(plan) = model_parts(scene, model);
  if (setup) setup(fmt::format("memory of a factor of {} degrees of freedom", plan.structure_dofs));
  plan.memory = planned_memory(scene, model, plan.duration);
  if (plan.memory.entries_per_dof > wide) {
    plan.warnings.push_back(fmt::format(
        "the structure is coupled widely: its factor has {:.0f} entries per degree of freedom, and every step and the "
        "set-up take accordingly long; long beam elements under many sleepers (bridge.elements) and solid models that "
        "are wide and high do that",
        plan.memory.entries_per_dof));
  }
  return plan;
}

}  // namespace railtab
