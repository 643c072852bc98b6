// The vehicles of the library: axle load, first natural frequencies, linear critical speed on S1002 and 60E1 at 1:40,
// with the contact at rest and with equivalent conicities, and the largest wheel force of two of them over the bridge
// of docs/examples/demo.toml. Writes vehicles.csv into the folder given.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <fstream>
#include <string>

#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/scene/scene_run.hpp"
#include "railtab/runtime/stability/linear_stability.hpp"
#include "railtab/runtime/vehicle/vehicle_library.hpp"
#include "railtab/runtime/vehicle/vehicle_modes.hpp"
#include "railtab/runtime/vehicle/vehicle_summary.hpp"
#include "railtab/runtime/vsi/step_record.hpp"

namespace {

using namespace railtab;

constexpr int modes = 8;
constexpr double to_kmh = 3.6;

/// At 100 km/h the freight wagons hunt.
double demo_kmh(const std::string& vehicle) { return vehicle.starts_with("freight") ? 60.0 : 100.0; }

/// The demo's scene with another vehicle.
SceneParameters scene_of(const VehicleData& vehicle) {
  std::vector<KeyChange> changes{{"train.vehicle", fmt::format("\"{}\"", vehicle.name)},
                                 {"train.speed_kmh", fmt::format("{}", demo_kmh(vehicle.name))},
                                 {"contact.table", ""},
                                 {"output.every", "1"}};
  if (vehicle.motion == MotionPlane::vertical) {
    changes.insert(
        changes.end(),
        {{"contact.normal", "\"rigid\""}, {"contact.mode", ""}, {"contact.creep_law", ""}, {"contact.friction", ""}});
  } else {
    changes.insert(changes.end(),
                   {{"contact.mode", "\"online\""},
                    {"contact.rail_inclination", "\"1:40\""},
                    {"contact.dimensions.nominal_radius", fmt::format("{}", vehicle.parts.nominal_radius)}});
  }
  return read_scene(RAILTAB_SOURCE_DIR "/docs/examples/demo.toml", changes);
}

/// Of all wheels over the whole run [N].
double largest_wheel_force(const SceneParameters& scene) {
  double largest = 0.0;
  RunObserver observer;
  observer.record = [&](const StepRecord& record) {
    for (const WheelRecord& wheel : record.wheels) largest = std::max(largest, wheel.Q);
  };
  const RunSummary run = run_scene(scene, observer);
  if (!run.complete) throw std::runtime_error(fmt::format("{}: {}", scene.train.vehicle, run.message));
  return largest;
}

/// "260.2", "< 18" where motions grow from the lowest speed of the search on, "> 540" where none does [km/h].
std::string critical_speed(const VsiModel& model, std::optional<double> conicity) {
  const SpeedSearch search;
  const LinearCriticalSpeed found = linear_critical_speed(model, search, conicity);
  if (!found.critical) return fmt::format("> {:.0f}", to_kmh * search.high);
  if (found.critical->speed <= search.low) return fmt::format("< {:.0f}", to_kmh * search.low);
  return fmt::format("{:.1f}", to_kmh * found.critical->speed);
}

std::string row_of(const std::string& name) {
  const VehicleData data = library_vehicle(name);
  const VehicleModel vehicle = build_vehicle(data, data.motion);
  const double load = summarise(vehicle, 0).wheel_load.front();
  std::string row = fmt::format("{},{:.3f}", name, 2e-3 * load / vehicle.gravity);
  const std::vector<VehicleMode> motions = natural_modes(vehicle, modes);
  for (std::size_t k = 0; k < modes; ++k) {
    row += k < motions.size() ? fmt::format(",{:.3f}", motions[k].frequency) : ",none";
  }
  const SceneParameters scene = scene_of(data);
  if (data.motion == MotionPlane::vertical) {
    row += ",none,none,none,none";
  } else {
    const VsiModel model = stability_model(scene);
    for (const std::optional<double> conicity : {std::optional<double>{}, {0.1}, {0.2}, {0.3}}) {
      row += "," + critical_speed(model, conicity);
    }
  }
  return row + fmt::format(",{:.0f},{:.1f},{:.0f},{:.1f}\n", to_kmh * data.top_speed, 1e-3 * load, demo_kmh(name),
                           1e-3 * largest_wheel_force(scene));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: vehicle_library_figure FOLDER\n", stderr);
    return 2;
  }
  try {
    std::string rows;
    for (const std::string& name : vehicle_names()) rows += row_of(name);
    std::ofstream(std::string(argv[1]) + "/vehicles.csv")
        << "# The library's vehicles, made by tests/validation/vehicle_library_figure; vertical data have six motions "
           "and no critical speed\n"
           "vehicle,axle_load_t,f1_Hz,f2_Hz,f3_Hz,f4_Hz,f5_Hz,f6_Hz,f7_Hz,f8_Hz,critical_kmh,critical_01_kmh,"
           "critical_02_kmh,critical_03_kmh,top_speed_kmh,static_wheel_load_kN,demo_kmh,largest_Q_kN\n"
        << rows;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
}
