// Prices of the parts that the project is about, relative to what they replace, against the committed ones:
//
//     performance_ratios BASELINE.csv             prints each ratio beside its baseline, warns beyond 20 %, and fails
//                                                 where a ratio has a limit and exceeds it
//     performance_ratios BASELINE.csv --renew     writes the ratios of this machine as the new baseline
//
// Ratios of processor times in one process: medians over rounds in which each pair is measured one after the other.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ctime>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/contact/contact_response.hpp"
#include "railtab/runtime/contact/creep_law.hpp"
#include "railtab/runtime/contact/table_contact.hpp"
#include "railtab/runtime/contact_files/creep_law_file.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "railtab/runtime/structure/track_bridge.hpp"
#include "railtab/runtime/vsi/contact_law.hpp"
#include "railtab/runtime/vsi/operator_levels.hpp"
#include "railtab/runtime/vsi/simulation.hpp"
#include "railtab/tablegen/loaded_sweep.hpp"

namespace {

using namespace railtab;

constexpr double warning = 0.2;
constexpr int rounds = 15;

/// Returns a number that depends on the work, so that the work is not left out.
using Work = std::function<double()>;

double seconds_of(const Work& work) {
  const std::clock_t begin = std::clock();
  volatile double used = work();
  static_cast<void>(used);
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

double median_ratio(const Work& part, const Work& whole) {
  std::vector<double> ratios;
  for (int round = 0; round < rounds; ++round) {
    const double first = seconds_of(part), second = seconds_of(whole);
    ratios.push_back(first / second);
  }
  std::nth_element(ratios.begin(), ratios.begin() + rounds / 2, ratios.end());
  return ratios[rounds / 2];
}

ContactSearch s1002_on_60e1() {
  return ContactSearch(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "S1002", 1.0 / 40)),
                                     ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40)),
                                     PairDimensions{}));
}

/// Contact patches of S1002 on 60E1 from the table and by the search: y ±4 mm, yaw ±2 mrad, 0 to 0.3 mm below touch.
double geometry_table_to_search() {
  const ContactSearch search = s1002_on_60e1();
  GeometrySweepOptions options;
  options.lateral = {-0.004, 0.004};
  options.yaw = {0.0, 0.002};
  options.roll = {0.0, 0.0};
  const TableContact contact(GeometryTable(sweep_geometry(search, options)));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> y(-0.004, 0.004), yaw(-0.002, 0.002), lowering(0.0, 3e-4);
  std::vector<WheelsetPose> poses;
  while (poses.size() < 2048) {
    WheelsetPose pose{y(random), 0.0, 0.0, yaw(random)};
    pose.z = search.touch_height(pose.y, pose.roll, pose.yaw) + lowering(random);
    ContactPatches answer;
    if (std::isfinite(pose.z) && contact.patches_from_table(pose, 0.0, answer)) poses.push_back(pose);
  }
  const auto sum = [&](const auto& patches) {
    double penetration = 0.0;
    for (const WheelsetPose& pose : poses) penetration += patches(pose).patch[0].penetration;
    return penetration;
  };
  return median_ratio([&] { return sum([&](const WheelsetPose& pose) { return contact.patches(pose); }); },
                      [&] { return sum([&](const WheelsetPose& pose) { return contact.search().patches(pose); }); });
}

/// Contact forces of a wheel with their tangent in a time step: from a table of the loaded contact, and of an ellipse
/// per patch from a geometry table. S1002 on 60E1, y −2.5 to −1 mm, 40 to 80 µm below touch.
double loaded_table_to_patches() {
  const ContactSearch search = s1002_on_60e1();
  GeometrySweepOptions geometry;
  geometry.lateral = {-0.004, 0.001};
  geometry.yaw = {0.0, 0.004};
  geometry.roll = {-0.001, 0.001};
  const TableContact table(GeometryTable(sweep_geometry(search, geometry)));
  LoadedSweepOptions options;
  options.lateral = {-3e-3, -0.5e-3};
  options.roll = geometry.roll;
  options.yaw = 4e-3;
  options.levels = 13;
  options.largest_load = 150e3;
  options.force_error = 5e-3;
  options.light_error = 2e-2;
  options.contact.elements.across_narrowest = 14;
  const ContactGeometry loaded(table, std::make_shared<const LoadedTable>(sweep_loaded(search, options)));
  const ContactGeometry patches(table);
  std::vector<WheelsetMotion> queries(512);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> y(-0.0025, -0.001), yaw(-3e-3, 3e-3), lowering(4e-5, 8e-5), slip(-0.05, 0.05);
  for (WheelsetMotion& q : queries) {
    q.displacement << 0.0, y(random), 0.0, 0.0, 0.0, yaw(random);
    q.displacement[2] = search.touch_height(q.displacement[1], 0.0, q.displacement[5]) + lowering(random);
    q.velocity << slip(random), slip(random), 0.0, 0.0, slip(random), 0.0;
  }
  const auto forces = [&](const ContactGeometry& of) {
    WheelContactModel model;
    model.geometry = &of;
    model.creep_law = creep_law("table", 0.28);
    model.speed = 50.0;
    const StepRates rates{Vector6::Constant(2000.0), 2000.0, nullptr};
    return [&queries, model, rates] {
      double sum = 0.0;
      for (const WheelsetMotion& wheelset : queries) {
        const WheelResponse response = wheel_response(model, WheelSide::right, wheelset, {}, rates);
        sum += response.force.wheelset[2] + response.tangent(2, 2);
      }
      return sum;
    };
  };
  return median_ratio(forces(loaded), forces(patches));
}

/// Creep forces of the shipped table and of FASTSIM with 20 × 20 elements, at cases that have nothing to do with each
/// other.
double creep_table_to_fastsim() {
  struct Case {
    double ratio;
    Creepage creepage;
  };
  std::vector<Case> cases;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> decades(-1.5, 1.0), ratio(-0.9, 0.9), direction(-1.0, 1.0);
  for (int i = 0; i < 4096; ++i) {
    const double size = std::pow(10.0, decades(random));
    cases.push_back({std::pow(10.0, ratio(random)),
                     {size * direction(random), size * direction(random), size * direction(random)}});
  }
  const auto forces = [&](const CreepLaw& law) {
    double sum = 0.0;
    for (const Case& c : cases) sum += creep_force(law, c.ratio, c.creepage).y;
    return sum;
  };
  const CreepLaw table = creep_law("table", 0.28), fastsim = FastsimCreep{.strips = 20, .elements = 20};
  return median_ratio([&] { return forces(table); }, [&] { return forces(fastsim); });
}

/// A time step of a coach on a track with ten spans, online contact, and one back-substitution of its structure's
/// factor.
double step_to_back_substitution() {
  SceneParameters scene;
  scene.contact.mode = ContactMode::online;
  scene.train.start = 20.0;
  scene.track.length_before = scene.track.length_after = 200.0;
  scene.spans.resize(10);
  scene.irregularity = std::string(RAILTAB_SOURCE_DIR) + "/docs/examples/demo_irregularity.csv";
  const VsiModel model = build_model(scene);
  VsiState state(model);
  if (!steady_start(model, state).converged) throw ComputationError("no static equilibrium");
  const double time_step = scene.integration.time_step;
  OperatorLevels levels(model, scene.integration.alpha, time_step);
  StepWorkspace workspace(model);
  const std::unique_ptr<ContactLaw> contacts = make_contact_law(model);
  const DofRange all{0, model.structure->dofs()};
  const SubstitutionFactor& factor = levels.update(0, state.time + time_step, all).structure->factor();
  const Eigen::VectorXd load = Eigen::VectorXd::Ones(model.structure->dofs());
  constexpr int repeated = 20;
  const auto steps = [&] {
    double iterations = 0.0;
    for (int i = 0; i < repeated; ++i) {
      const StepOperators& operators = levels.update(0, state.time + time_step, all);
      const StepReport report = advance(model, operators, {}, state, *contacts, workspace);
      if (report.outcome != StepOutcome::accepted) throw ComputationError("a step that does not converge");
      iterations += report.newton_iterations;
    }
    return iterations;
  };
  steps();
  return median_ratio(steps, [&] {
    double sum = 0.0;
    for (int i = 0; i < repeated; ++i) sum += factor.solve(load)[i];
    return sum;
  });
}

/// A run in a gust that leans coaches on their stops; rigid track, where the structure takes no time.
Work train_in_gust(const TrainParameters& train, double duration) {
  SceneParameters scene;
  scene.train = train;
  scene.train.speed = 30.0;
  scene.contact.mode = ContactMode::online;
  scene.contact.dimensions.nominal_radius = 0.4575;
  scene.track_kind = TrackKind::rigid;
  LoadParameters gust;
  gust.load[1] = 60e3;
  gust.gust_duration = 0.6;
  scene.loads = {gust};
  return [model = build_model(scene), integration = scene.integration, duration] {
    VsiState state(model);
    if (!steady_start(model, state).converged) throw ComputationError("no static equilibrium");
    const RunSummary run = simulate(model, integration, duration, 1000, state, {});
    if (!run.complete) throw ComputationError(run.message);
    return static_cast<double>(run.newton_iterations);
  };
}

Work coach_in_gust(const std::string& vehicle, ForceElementChoice choice) {
  TrainParameters train;
  train.vehicle = vehicle;
  train.force_elements = choice;
  return train_in_gust(train, 0.6);
}

constexpr const char* coach_with_stops = "chinese-emu-car";

/// A coach with stops, blow-off and yaw dampers, and the same one with linear stand-ins.
double force_elements_to_linear() {
  return median_ratio(coach_in_gust(coach_with_stops, ForceElementChoice::nonlinear),
                      coach_in_gust(coach_with_stops, ForceElementChoice::linear));
}

/// The coach with side bearers and wedges besides, and the linear one without.
double all_force_elements_to_linear() {
  return median_ratio(coach_in_gust(std::string(RAILTAB_SOURCE_DIR) + "/tests/reference/coach_with_all_elements.toml",
                                    ForceElementChoice::nonlinear),
                      coach_in_gust(coach_with_stops, ForceElementChoice::linear));
}

/// Sixteen of these coaches, the rear eight turned round, and sixteen that run alike, until the first are on their
/// stops.
double mixed_train_to_equal_vehicles() {
  constexpr double duration = 0.2;  // s
  TrainParameters mixed, equal;
  mixed.consist = {{coach_with_stops, 8, false}, {coach_with_stops, 8, true}};
  equal.vehicle = coach_with_stops;
  equal.count = 16;
  return median_ratio(train_in_gust(mixed, duration), train_in_gust(equal, duration));
}

std::map<std::string, double> read_baseline(const std::string& file) {
  std::map<std::string, double> ratios;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    const std::size_t comma = line.find(',');
    if (line.empty() || line[0] == '#' || line.starts_with("ratio,") || comma == std::string::npos) continue;
    ratios[line.substr(0, comma)] = std::stod(line.substr(comma + 1));
  }
  return ratios;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "performance_ratios BASELINE.csv [--renew]\n");
    return 2;
  }
  const std::string file = argv[1];
  const bool renew = argc > 2 && std::strcmp(argv[2], "--renew") == 0;
  const std::map<std::string, double> baseline = read_baseline(file);
  std::string text =
      "# Ratios of processor times that tools/check compares its own with; build type dev.\n"
      "# Made by tools/regenerate performance_ratios.\nratio,value\n";
  struct Price {
    const char* name;
    double (*ratio)();
    double limit = std::numeric_limits<double>::infinity();
  };
  constexpr double force_element_limit = 1.3;  // what a vehicle's force elements may cost
  int exceeded = 0;
  for (const auto& [name, measure, limit] :
       {Price{"contact geometry: table / online search", geometry_table_to_search},
        Price{"contact forces: loaded table / patches", loaded_table_to_patches},
        Price{"creep forces: table / FASTSIM 20 x 20", creep_table_to_fastsim},
        Price{"time step / back-substitution", step_to_back_substitution},
        Price{"force elements: as built / linear", force_elements_to_linear, force_element_limit},
        Price{"all force elements / linear", all_force_elements_to_linear, force_element_limit},
        Price{"mixed train / equal vehicles", mixed_train_to_equal_vehicles}}) {
    const double ratio = measure();
    text += fmt::format("{},{:.4g}\n", name, ratio);
    fmt::print("{:<42}{:>9.4f}", name, ratio);
    if (const auto known = baseline.find(name); known != baseline.end()) {
      const double change = ratio / known->second - 1.0;
      fmt::print("   baseline {:.4f}, {:+.0f} %{}", known->second, 100.0 * change,
                 std::abs(change) > warning && !renew ? "   WARNING: more than 20 %" : "");
    }
    fmt::print("{}\n", ratio > limit ? fmt::format("   FAILED: more than {}", limit) : "");
    if (ratio > limit) ++exceeded;
  }
  if (renew) write_text_file(file, text);
  return exceeded > 0 ? 1 : 0;
}
