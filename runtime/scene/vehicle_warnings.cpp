#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/scene/scene_case.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/stability/linear_stability.hpp"

// What a vehicle's data say against the run.

namespace railtab::scene {
namespace {

/// The highest speed of the run [m/s].
double highest_speed(const SceneCase& at) {
  if (!at.model.speed_profile) return at.model.contact.speed;
  constexpr int samples = 1000;
  double highest = 0.0;
  for (int i = 0; i <= samples; ++i) highest = std::max(highest, at.model.speed(at.duration * i / samples));
  return highest;
}

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

void above_critical_speed(const SceneCase& at, Warnings& list) {
  constexpr int most_dofs = 200;  // of trains with joints: their eigenvalues take seconds
  constexpr double to_kmh = 3.6;
  const bool creeps = at.scene.contact.normal == NormalContact::hertz && at.model.contact.friction > 0.0;
  if (!creeps || at.scene.contact.mode == ContactMode::paper || at.model.vehicle.dofs() > most_dofs) return;
  const double speed = highest_speed(at);
  try {
    const LeastStableMotion motion = least_stable_motion(stability_model(at.scene, at.model), speed);
    if (motion.growth <= 0.0) return;
    list.push_back(fmt::format(
        "the train runs at {:.6g} km/h, above a linear critical speed of {} on these profiles: a small motion of "
        "{:.3g} Hz grows by {:.3g} per second, until flanges or slip bound it (vsi critical-speed finds the speed)",
        to_kmh * speed, at.model.vehicle.name, motion.frequency, motion.growth));
  } catch (const ComputationError&) {
    return;  // no rest in the middle of the track: the start of the run says why
  }
}

void linear_stand_ins(const SceneCase& at, Warnings& list) {
  const VehicleModel& vehicle = at.model.vehicle;
  if (vehicle.linearised.empty()) return;
  list.push_back(
      fmt::format("{} has force elements that are not linear: {}", vehicle.name, fmt::join(vehicle.linearised, "; ")));
}

}  // namespace

const Warning vehicle_above_top_speed{"the speed is above the top speed that the vehicle's data state",
                                      above_top_speed};
const Warning vehicle_above_critical_speed{"the speed is above a linear critical speed of the vehicle on its profiles",
                                           above_critical_speed};
const Warning vehicle_linearised{"force elements of the vehicle run by linear stand-ins", linear_stand_ins};

}  // namespace railtab::scene
