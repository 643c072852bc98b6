#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/scene/scene_case.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_wheels.hpp"
#include "railtab/runtime/stability/linear_stability.hpp"
#include "railtab/runtime/vehicle/vehicle_library.hpp"
#include "railtab/runtime/vehicle/vehicle_plausibility.hpp"

// What a vehicle's data say against the run.

namespace railtab::scene {

double highest_speed(const SceneCase& at) {
  if (!at.model.speed_profile) return at.model.contact.speed;
  constexpr int samples = 1000;
  double highest = 0.0;
  for (int i = 0; i <= samples; ++i) highest = std::max(highest, at.model.speed(at.duration * i / samples));
  return highest;
}

namespace {

void above_top_speed(const SceneCase& at, Warnings& list) {
  constexpr double rounding = 1e-6, to_kmh = 3.6;
  const VehicleModel& vehicle = at.model.vehicle;
  const double speed = highest_speed(at);
  if (vehicle.top_speed == 0.0 || speed <= vehicle.top_speed * (1.0 + rounding)) return;
  list.push_back(
      fmt::format("the train runs at {:.6g} km/h, and the top speed of {} is {:.6g} km/h: its data do not "
                  "describe it there",
                  to_kmh * speed, vehicle.name, to_kmh * vehicle.top_speed));
}

constexpr int most_dofs = 400;  // of one system, whose eigenvalues take a second

/// A system whose small motions are looked at: the train's, or one of its vehicles alone.
struct HuntingSystem {
  SceneParameters scene;
  std::string name;
  int first_wheelset = 0;  ///< in the train
};

/// Vehicles of a train too large for one system, each kind alone, and names of those that do not stand alone.
std::vector<HuntingSystem> vehicles_alone(const SceneCase& at, std::vector<std::string>& on_joints) {
  const SceneParameters& scene = at.scene;
  std::map<std::string, int> kinds;  // and the first coach of each
  int coach = 1;
  for (const ConsistEntry& entry : scene.train.entries()) {
    kinds.emplace(entry.vehicle, coach);
    coach += entry.count;
  }
  const std::vector<PlaceInTrain> places = wheelset_places(at.model);
  std::vector<HuntingSystem> systems;
  for (const auto& [kind, first_coach] : kinds) {
    const VehicleData data = find_vehicle(kind);
    if (data.stands_on_joints) {
      on_joints.push_back(data.name);
      continue;
    }
    const auto first =
        std::find_if(places.begin(), places.end(), [c = first_coach](const PlaceInTrain& p) { return p.coach == c; });
    systems.push_back({scene, data.name, static_cast<int>(first - places.begin())});
    TrainParameters& train = systems.back().scene.train;
    train.consist.clear();
    train.joint.clear();
    train.vehicle = kind;
    train.count = 1;
  }
  return systems;
}

/// A motion that grows, for a sentence.
std::string text_of(const LeastStableMotion& motion) {
  if (motion.frequency > 0.0)
    return fmt::format("a small motion of {:.3g} Hz grows by {:.3g} per second", motion.frequency, motion.growth);
  return fmt::format("a small motion without oscillation grows by {:.3g} per second", motion.growth);
}

/// Growth of small motions at rest, and with the equivalent conicity of 3 mm, at which vehicles are assessed [EN15302]:
/// a sign, no proof, of limit cycles below the critical speed at rest.
void add_growth(const HuntingSystem& system, const VsiModel& contacts, double speed, Warnings& list) {
  constexpr double to_kmh = 3.6, amplitude = 3e-3;
  const VsiModel model = stability_model(system.scene, contacts, system.first_wheelset);
  if (const std::optional<LeastStableMotion> at_rest = growing_motion(model, speed)) {
    list.push_back(fmt::format(
        "the train runs at {:.6g} km/h, above a linear critical speed of {} on these profiles: {}, until flanges or "
        "slip bound it (vsi critical-speed finds the speed)",
        to_kmh * speed, system.name, text_of(*at_rest)));
    return;
  }
  const std::optional<double> conicity = model.geometry->equivalent_conicity(amplitude);
  if (!conicity) return;
  const std::optional<LeastStableMotion> disturbed = growing_motion(model, speed, conicity);
  if (!disturbed) return;
  const std::string motion = disturbed->frequency > 0.0
                                 ? fmt::format("into a limit cycle of about {:.3g} Hz", disturbed->frequency)
                                 : std::string("without oscillation");
  list.push_back(fmt::format(
      "the train runs at {:.6g} km/h, above the critical speed of {} at the equivalent conicity {:.3g} of 3 mm: small "
      "motions decay, but one of that amplitude may grow {} (vsi critical-speed --limit-cycles)",
      to_kmh * speed, system.name, *conicity, motion));
}

void above_critical_speed(const SceneCase& at, Warnings& list) {
  const bool creeps = at.scene.contact.normal == NormalContact::hertz && at.model.contact.friction > 0.0;
  if (!creeps || at.scene.contact.mode == ContactMode::paper) return;
  std::vector<HuntingSystem> systems;
  std::vector<std::string> unchecked;
  if (at.model.vehicle.dofs() <= most_dofs) {
    systems.push_back({at.scene, at.model.vehicle.name, 0});
  } else if (at.scene.train.vehicle == imported_vehicle) {
    unchecked.push_back(at.model.vehicle.name);
  } else {
    systems = vehicles_alone(at, unchecked);
  }
  for (const HuntingSystem& system : systems) {
    try {
      add_growth(system, at.model, highest_speed(at), list);
    } catch (const ComputationError&) {
      continue;  // no rest in the middle of the track: the start of the run says why
    }
  }
  if (unchecked.empty()) return;
  list.push_back(fmt::format(
      "the critical speed of {} is not checked: the train is one system of {} degrees of freedom, more than "
      "{} (vsi critical-speed finds that of a shorter train)",
      fmt::join(unchecked, ", "), at.model.vehicle.dofs(), most_dofs));
}

void linear_stand_ins(const SceneCase& at, Warnings& list) {
  const VehicleModel& vehicle = at.model.vehicle;
  if (vehicle.linearised.empty()) return;
  list.push_back(
      fmt::format("{} has force elements that are not linear: {}", vehicle.name, fmt::join(vehicle.linearised, "; ")));
}

void implausible_vehicles(const SceneCase& at, Warnings& list) {
  if (at.scene.train.vehicle == imported_vehicle) return;
  std::set<std::string> kinds;
  for (const ConsistEntry& entry : at.scene.train.entries()) kinds.insert(entry.vehicle);
  for (const std::string& kind : kinds) {
    const std::vector<std::string> sentences = implausible_values(find_vehicle(kind));
    list.insert(list.end(), sentences.begin(), sentences.end());
  }
}

}  // namespace

const Warning vehicle_implausible{
    "springs of the vehicle deflect by more than 0.5 m under the weight, its wheels overlap, or its car body is "
    "lighter than its wheelsets",
    implausible_vehicles};
const Warning vehicle_above_top_speed{"the speed is above the top speed that the vehicle's data state",
                                      above_top_speed};
const Warning vehicle_above_critical_speed{
    "the speed is above a linear critical speed of the vehicle on its profiles, at rest or at the equivalent conicity "
    "of 3 mm; of trains in one system of more than 400 degrees of freedom, vehicles on joints are not checked",
    above_critical_speed};
const Warning vehicle_linearised{"force elements of the vehicle are replaced by linear stand-ins", linear_stand_ins};

}  // namespace railtab::scene
