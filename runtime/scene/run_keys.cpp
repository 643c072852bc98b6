#include "railtab/runtime/scene/key_table.hpp"
#include "railtab/runtime/vehicle/coach.hpp"

namespace railtab::scene {
namespace {

std::vector<std::string> creep_law_names() { return {"linear", "polach", "fastsim", "table"}; }

std::vector<std::string> train_vehicle_names() {
  std::vector<std::string> names = vehicle_names();
  names.emplace_back(imported_vehicle);
  return names;
}

std::vector<KeyBinding> train_keys() {
  return {
      {"name", "", "name of the scene in results and reports (file name where absent)",
       TextKey{[](SceneDraft& d) -> std::string& { return d.parameters.name; }, nullptr}},
      {"train.vehicle", "", "published vehicle, or that of [vehicle], which needs no mention",
       TextKey{[](SceneDraft& d) -> std::string& { return d.parameters.train.vehicle; }, train_vehicle_names}},
      {"train.count", "1", "number of coaches",
       IntegerKey{[](SceneDraft& d) -> int& { return d.parameters.train.count; }, 1, 100}},
      {"train.speed", "m/s", "constant running speed; not together with speed_kmh",
       NumberKey{[](SceneDraft& d) -> double& { return d.parameters.train.speed; }, {1e-3, 200.0}}},
      {"train.speed_kmh", "km/h", "the same in km/h; not together with speed",
       OptionalNumberKey{[](SceneDraft& d) -> std::optional<double>& { return d.speed_kmh; }, {3.6e-3, 720.0}}},
      {"train.speed_file", "", "speed over time; not together with speed or speed_kmh",
       FileKey{[](SceneDraft& d) -> std::filesystem::path& { return d.parameters.train.speed_file; }}},
      {"train.start", "m", "position of the first wheelset at t = 0; the bridge begins at 0",
       NumberKey{[](SceneDraft& d) -> double& { return d.parameters.train.start; }, {-1e6, 1e6}}},
      {"train.initial_lateral_shift", "m", "of every wheelset at t = 0, to the right",
       NumberKey{[](SceneDraft& d) -> double& { return d.parameters.train.initial_lateral_shift; }, {-0.02, 0.02}}},
      {"train.initial_yaw", "rad", "of every wheelset at t = 0, about z down",
       NumberKey{[](SceneDraft& d) -> double& { return d.parameters.train.initial_yaw; }, {-0.1, 0.1}}},
  };
}

std::vector<KeyBinding> contact_keys() {
  return {
      {"contact.mode", "", "where contact patches come from: the geometry table, the online search, the paper's search",
       ContactModeKey{}},
      {"contact.normal", "",
       "Hertz's contact, or wheels that follow the rails rigidly: vertical only, never lifting off",
       NormalContactKey{}},
      {"contact.table", "", "geometry table; it also gives profiles and dimensions",
       FileKey{[](SceneDraft& d) -> std::filesystem::path& { return d.parameters.contact.table; }}},
      {"contact.wheel", "", "wheel profile where no table is named",
       ProfileKey{[](SceneDraft& d) -> std::string& { return d.parameters.contact.wheel; }, ProfileKind::wheel}},
      {"contact.rail", "", "rail profile where no table is named",
       ProfileKey{[](SceneDraft& d) -> std::string& { return d.parameters.contact.rail; }, ProfileKind::rail}},
      {"contact.rail_inclination", "1", "of a built-in rail towards the track centre, as a number or \"1:40\"",
       RatioKey{[](SceneDraft& d) -> double& { return d.parameters.contact.rail_inclination; }, {0.0, 0.1}}},
      {"contact.creep_law", "", "creep law",
       TextKey{[](SceneDraft& d) -> std::string& { return d.parameters.contact.creep_law; }, creep_law_names}},
      {"contact.creep_table", "", "creep table of the law \"table\" (the shipped one, for nu = 0.28, where absent)",
       FileKey{[](SceneDraft& d) -> std::filesystem::path& { return d.parameters.contact.creep_table; }}},
      {"contact.friction", "1", "Coulomb friction coefficient",
       NumberKey{[](SceneDraft& d) -> double& { return d.parameters.contact.friction; }, {0.0, 2.0}}},
      {"contact.damping", "s/m", "contact damping c of F_n·(1 + c·d'), d' the rate of penetration",
       NumberKey{[](SceneDraft& d) -> double& { return d.parameters.contact.damping; }, {0.0, 1e3}}},
      {"contact.curvature_floor", "1/m", "smallest relative lateral curvature of the Hertz ellipse",
       NumberKey{[](SceneDraft& d) -> double& { return d.parameters.contact.curvature_floor; }, {0.0, 1e4, true}}},
      {"contact.dimensions.track_gauge", "m", "between the gauge points, where no table is named",
       NumberKey{[](SceneDraft& d) -> double& { return d.parameters.contact.dimensions.track_gauge; }, {0.5, 2.0}}},
      {"contact.dimensions.gauge_height", "m", "depth of the gauge points below the rail-head tops",
       NumberKey{[](SceneDraft& d) -> double& { return d.parameters.contact.dimensions.gauge_height; }, {0.0, 0.05}}},
      {"contact.dimensions.flange_back", "m", "between the flange backs of the wheelset",
       NumberKey{[](SceneDraft& d) -> double& { return d.parameters.contact.dimensions.flange_back; }, {0.4, 2.0}}},
      {"contact.dimensions.nominal_radius", "m", "wheel radius at the tape circle",
       NumberKey{[](SceneDraft& d) -> double& { return d.parameters.contact.dimensions.nominal_radius; }, {0.1, 1.0}}},
      {"contact.material.E", "Pa", "Young's modulus of wheel and rail",
       NumberKey{[](SceneDraft& d) -> double& { return d.parameters.contact.material.E; }, {1e9, 1e15}}},
      {"contact.material.nu", "1", "Poisson's ratio of wheel and rail",
       NumberKey{[](SceneDraft& d) -> double& { return d.parameters.contact.material.nu; }, {0.0, 0.5}}},
  };
}

std::vector<KeyBinding> integration_keys() {
  return {
      {"irregularity.file", "", "measured deviations of both rails over x",
       FileKey{[](SceneDraft& d) -> std::filesystem::path& { return d.irregularity; }}},
      {"irregularity.spectrum", "", "random deviations of this spectrum, in place of a file",
       TextKey{[](SceneDraft& d) -> std::string& { return d.spectrum_name; }, spectrum_names}},
      {"irregularity.seed", "1", "of the random track",
       IntegerKey{[](SceneDraft& d) -> int& { return d.spectrum.seed; }, 0, 1000000000}},
      {"irregularity.shortest_wave", "m", "shortest wavelength of the random track",
       NumberKey{[](SceneDraft& d) -> double& { return d.spectrum.shortest; }, {0.1, 500.0}}},
      {"irregularity.longest_wave", "m", "longest wavelength of the random track",
       NumberKey{[](SceneDraft& d) -> double& { return d.spectrum.longest; }, {0.1, 500.0}}},
      {"integration.time_step", "s", "time step",
       NumberKey{[](SceneDraft& d) -> double& { return d.parameters.integration.time_step; }, {1e-9, 0.1}}},
      {"integration.duration", "s", "simulated time; 0: until the last wheelset has left the last span",
       NumberKey{[](SceneDraft& d) -> double& { return d.parameters.integration.duration; }, {0.0, 1e5}}},
      {"integration.alpha", "1", "HHT α; 0 is Newmark's trapezoidal rule",
       NumberKey{[](SceneDraft& d) -> double& { return d.parameters.integration.alpha; }, {-1.0 / 3.0, 0.0}}},
      {"integration.contact_force", "",
       "contact force of a step: that of its end, such that contact springs keep their energy, or the latter at "
       "impacts",
       ContactForceKey{}},
      {"integration.impact_step", "s",
       "longest step in the millisecond after a wheel meets its rail, where contact_force is automatic; time_step is "
       "divided by a power of two",
       NumberKey{[](SceneDraft& d) -> double& { return d.parameters.integration.impact_step; }, {1e-6, 0.1}}},
      {"integration.tolerance", "1", "Newton: change of the contact forces relative to the static wheel load",
       NumberKey{[](SceneDraft& d) -> double& { return d.parameters.integration.tolerance; }, {1e-12, 1e-2}}},
      {"integration.max_iterations", "1", "Newton iterations before a step is halved",
       IntegerKey{[](SceneDraft& d) -> int& { return d.parameters.integration.max_iterations; }, 2, 1000}},
      {"integration.max_halvings", "1", "halvings of a step that does not converge",
       IntegerKey{[](SceneDraft& d) -> int& { return d.parameters.integration.max_halvings; }, 0, 30}},
      {"output.every", "1", "steps between records",
       IntegerKey{[](SceneDraft& d) -> int& { return d.parameters.output.every; }, 1, 1000000}},
      {"output.wheels", "", "record contact forces and contact positions",
       SwitchKey{[](SceneDraft& d) -> bool& { return d.parameters.output.wheels; }}},
      {"output.energy", "", "account for the energy that normal contacts gain or lose, for the summary",
       SwitchKey{[](SceneDraft& d) -> bool& { return d.parameters.output.energy; }}},
      {"output.bodies", "", "bodies to record, by name; * stands for any letters",
       TextListKey{[](SceneDraft& d) -> std::vector<std::string>& { return d.parameters.output.bodies; }}},
      {"output.nodes", "", "nodes of the structure to record, by name",
       TextListKey{[](SceneDraft& d) -> std::vector<std::string>& { return d.parameters.output.nodes; }}},
  };
}

}  // namespace

const std::vector<KeyBinding>& run_keys() {
  static const std::vector<KeyBinding> keys = [] {
    std::vector<KeyBinding> all = train_keys();
    for (const auto& part : {contact_keys(), integration_keys()}) all.insert(all.end(), part.begin(), part.end());
    return all;
  }();
  return keys;
}

}  // namespace railtab::scene
