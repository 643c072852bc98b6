#include "railtab/runtime/scene/scene_wheels.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

namespace {

bool meets(const WheelParameters& entry, const PlaceInTrain& place, int side) {
  if (entry.coach != 0 && entry.coach != place.coach) return false;
  if (entry.wheelset != 0 && entry.wheelset != place.wheelset) return false;
  return entry.side == WheelSides::both || (entry.side == WheelSides::right) == (side == 1);
}

// What all entries say of one wheel.
struct Deviations {
  std::vector<WheelFlat> flats;
  std::vector<WheelHarmonic> harmonics;
  WheelContour contour;
};

void add(const WheelParameters& entry, const WheelContour& contour, const std::string& place, Deviations& wheel) {
  if (entry.flat.length > 0.0) wheel.flats.push_back(entry.flat);
  for (const WheelHarmonic& harmonic : {entry.polygon, entry.run_out}) {
    if (harmonic.amplitude != 0.0) wheel.harmonics.push_back(harmonic);
  }
  if (contour.angle.empty()) return;
  if (!wheel.contour.angle.empty()) {
    throw input_error(place, "a second wheel.file of the same wheel", "one for each wheel");
  }
  wheel.contour = contour;
}

}  // namespace

std::vector<PlaceInTrain> wheelset_places(const VsiModel& model) {
  const VehicleModel& vehicle = model.vehicle;
  const int per_vehicle = model.wheelsets_per_vehicle();
  std::vector<int> count(model.vehicle_x.size() * static_cast<std::size_t>(vehicle.coaches), 0);
  std::vector<PlaceInTrain> result;
  for (int w = 0; w < model.wheelsets(); ++w) {
    const auto body = static_cast<std::size_t>(vehicle.wheelsets[static_cast<std::size_t>(w % per_vehicle)]);
    const int coach = w / per_vehicle * vehicle.coaches + vehicle.bodies[body].coach;
    result.push_back({coach + 1, ++count[static_cast<std::size_t>(coach)]});
  }
  return result;
}

void add_wheel_deviations(const SceneParameters& scene, VsiModel& model) {
  if (scene.wheels.empty()) return;
  const std::vector<PlaceInTrain> where = wheelset_places(model);
  std::vector<Deviations> wheels(2 * where.size());
  for (std::size_t i = 0; i < scene.wheels.size(); ++i) {
    const WheelParameters& entry = scene.wheels[i];
    const std::string place = fmt::format("scene: [[wheel]] {} of {}", i + 1, scene.wheels.size());
    const WheelContour contour = entry.file.empty() ? WheelContour{} : read_wheel_contour(entry.file);
    bool found = false;
    for (std::size_t wheel = 0; wheel < wheels.size(); ++wheel) {
      if (!meets(entry, where[wheel / 2], static_cast<int>(wheel % 2))) continue;
      found = true;
      add(entry, contour, place, wheels[wheel]);
    }
    if (found) continue;
    const auto last = std::max_element(where.begin(), where.end(),
                                       [](const PlaceInTrain& a, const PlaceInTrain& b) { return a.coach < b.coach; });
    throw input_error(place, fmt::format("coach {}, wheelset {}", entry.coach, entry.wheelset),
                      fmt::format("a wheelset of one of the {} coaches", last->coach));
  }
  for (std::size_t wheel = 0; wheel < wheels.size(); ++wheel) {
    Deviations& d = wheels[wheel];
    model.wheel_deviation.emplace_back(model.wheel_radius(static_cast<int>(wheel / 2)), std::move(d.flats),
                                       std::move(d.harmonics), std::move(d.contour));
  }
}

void add_friction(const SceneParameters& scene, VsiModel& model) {
  if (!scene.contact.friction_file.empty()) model.rail_friction = read_rail_friction(scene.contact.friction_file);
  if (model.speed_profile) model.contact.speed_floor = scene.contact.creep_speed_floor;
}

}  // namespace railtab
