// A train on a ballasted track and bridge whose matrices are imported, against TTB-2D [Cantero2022]: wheels that follow
// the rails rigidly, vertical only. The reference's files are not part of the repository; RAILTAB_EXTERNAL_DATA names
// the folder that has them.

#define BOOST_BIND_GLOBAL_PLACEHOLDERS  // property_tree's header asks for them
#include <gtest/gtest.h>

#include <array>
#include <boost/property_tree/json_parser.hpp>
#include <boost/property_tree/ptree.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "../measured.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "railtab/runtime/structure/structure_import.hpp"
#include "railtab/runtime/vsi/simulation.hpp"
#include "railtab/runtime/vsi/step_record.hpp"

namespace railtab {
namespace {

using boost::property_tree::ptree;

std::filesystem::path folder_of(const std::string& name) {
  const char* external = std::getenv("RAILTAB_EXTERNAL_DATA");
  return external ? std::filesystem::path(external) / "ttb2d" / name : std::filesystem::path();
}

std::vector<double> list(const ptree& tree) {
  std::vector<double> values;
  for (const auto& [key, value] : tree) values.push_back(value.get_value<double>());
  return values;
}

// The columns of a compressed CSV, without its header.
std::vector<std::vector<double>> read_columns(const std::filesystem::path& file) {
  std::vector<std::vector<double>> columns;
  FILE* pipe = popen(("gzip -dc '" + file.string() + "'").c_str(), "r");
  if (!pipe) throw std::runtime_error("cannot run gzip");
  std::array<char, 4096> line;
  for (bool header = true; std::fgets(line.data(), line.size(), pipe); header = false) {
    if (header) continue;
    std::istringstream fields(line.data());
    std::string field;
    for (std::size_t i = 0; std::getline(fields, field, ','); ++i) {
      if (columns.size() <= i) columns.emplace_back();
      columns[i].push_back(std::stod(field));
    }
  }
  if (pclose(pipe) != 0 || columns.empty()) throw std::runtime_error("cannot read " + file.string());
  return columns;
}

// TTB-2D counts up and its slopes as dz_up/dx: z turned, pitch = -dz/dx as it is. One line stands for both rails.
StructureModel imported(const std::filesystem::path& folder) {
  ptree map;
  read_json((folder / "dofmap.json").string(), map);
  const std::vector<double> rail = list(map.get_child("rail_vert")), x = list(map.get_child("rail_x"));
  const std::vector<double> beam = list(map.get_child("beam_vert")), beam_x = list(map.get_child("beam_x"));
  const std::filesystem::path table =
      std::filesystem::temp_directory_path() / ("railtab_" + folder.filename().string());
  std::ofstream out(table);
  out << "row,node,x[m],motion,rail\n";
  out.precision(17);
  for (std::size_t i = 0; i < rail.size(); ++i) {
    out << rail[i] << ",r" << i << ',' << x[i] << ",-z,both\n"
        << rail[i] + 1 << ",r" << i << ',' << x[i] << ",pitch,both\n";
  }
  const std::size_t middle = beam.size() / 2;
  out << beam[middle] << ",deck-midspan-1," << beam_x[middle] << ",-z,\n";
  out.close();
  StructureModel structure = import_structure({folder / "Mg.mtx", folder / "Cg.mtx", folder / "Kg.mtx", table});
  std::filesystem::remove(table);
  return structure;
}

// A car in the vertical plane: bounce and pitch of body and bogies, bounce of wheelsets.
VehicleModel planar_car(const ptree& car, const std::vector<double>& axles) {
  constexpr double R0 = 0.46;
  const double half_bogies = 0.5 * (axles[2] - axles[0]), half_base = 0.5 * (axles[1] - axles[0]);
  const auto at = [&](const char* path) { return car.get<double>(path); };
  const auto first = [&](const char* path) { return car.get_child(path).front().second.get_value<double>(); };
  const auto body = [&](const char* name, double m, double I, double x) {
    return RigidBody{name, m, {1.0, I, 1.0}, {x, 0.0, -R0}};
  };
  const double m_wheel = first("Wheels.m");
  std::vector<RigidBody> bodies{body("car-body", at("Body.m"), at("Body.I"), 0.0)};
  for (int b = 0; b < 2; ++b) {
    bodies.push_back(
        body(b == 0 ? "bogie-1" : "bogie-2", first("Bogie.m"), first("Bogie.I"), (1 - 2 * b) * half_bogies));
  }
  std::vector<Suspension> springs;
  for (int b = 0; b < 2; ++b) {
    const double x = (1 - 2 * b) * half_bogies;
    springs.push_back({0, 1 + b, {x, 0, -R0}, {0, 0, first("Susp.Sec.k")}, {0, 0, first("Susp.Sec.c")}});
  }
  for (int w = 0; w < 4; ++w) {
    const double x = (w < 2 ? 1 : -1) * half_bogies + (w % 2 == 0 ? 1 : -1) * half_base;
    bodies.push_back(body("wheelset", m_wheel, 1.0, x));
    springs.push_back({1 + w / 2, 3 + w, {x, 0, -R0}, {0, 0, first("Susp.Prim.k")}, {0, 0, first("Susp.Prim.c")}});
  }
  const DofIndices z_and_pitch{held, held, 0, held, 0, held}, z_only{held, held, 0, held, held, held};
  return assemble_vehicle({"car",
                           bodies,
                           springs,
                           {3, 4, 5, 6},
                           {z_and_pitch, z_and_pitch, z_and_pitch, z_only, z_only, z_only, z_only},
                           R0,
                           25.0,
                           1,
                           {standard_gravity, GeometricStiffness::omitted}});  // as TTB-2D
}

struct Reference {
  std::vector<double> t, u_mid;
  std::vector<std::vector<double>> force;  // per wheelset, up
};

class Ttb2d : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    folder = folder_of(GetParam());
    if (folder.empty() || !std::filesystem::exists(folder / "case.json")) {
      GTEST_SKIP() << "RAILTAB_EXTERNAL_DATA does not name a folder with ttb2d/" << GetParam();
    }
    read_json((folder / "case.json").string(), description);
    const std::vector<std::vector<double>> bridge = read_columns(folder / "bridge.csv.gz");
    reference.t = bridge[0];
    reference.u_mid = bridge[2];
    reference.force = read_columns(folder / "contact_force_applied_to_rail_N.csv.gz");
    reference.force.erase(reference.force.begin());
    time_step = description.get<double>("run.dt_s");
  }

  [[nodiscard]] VsiModel model(NormalContact contact) const {
    VsiModel m;
    const ptree& offsets = description.get_child("run.axle_offset_from_first_axle_m");
    const std::vector<double> axles = list(offsets.front().second);
    const ptree& train = description.get_child("Train.Veh");  // one car, or a list of equal ones
    m.vehicle = planar_car(train.count("Wheels") > 0 ? train : train.front().second, axles);
    const double x0 = description.get<double>("run.x_first_axle_t0_m");
    for (const auto& [key, car] : offsets) {
      const std::vector<double> a = list(car);
      m.vehicle_x.push_back(x0 - 0.5 * (a.front() + a.back()));
    }
    m.structure = share(imported(folder));
    m.contact.speed = description.get<double>("run.v_mps");
    m.contact.friction = 0.0;
    m.normal_contact = contact;
    m.geometry = std::make_shared<const ContactGeometry>(
        ContactSearch(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "cone-1:40", 0.0)),
                                    ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)), {})));
    m.contact.geometry = m.geometry.get();
    if (std::filesystem::exists(folder / "wheel_irregularity_h_m.csv.gz")) m.deviation_history = history();
    return m;
  }

  [[nodiscard]] DeviationHistory history() const {
    const auto h = read_columns(folder / "wheel_irregularity_h_m.csv.gz");
    const auto hd = read_columns(folder / "wheel_irregularity_hd_mps.csv.gz");
    const auto hdd = read_columns(folder / "wheel_irregularity_hdd_mps2.csv.gz");
    DeviationHistory result{.time_step = time_step};
    for (std::size_t w = 1; w < h.size(); ++w) {
      std::vector<VerticalDeviation>& wheelset = result.wheelset.emplace_back();
      for (std::size_t i = 0; i < h[w].size(); ++i) wheelset.push_back({-h[w][i], -hd[w][i], -hdd[w][i]});
    }
    return result;
  }

  struct Found {
    std::vector<double> u_mid;               // up
    std::vector<std::vector<double>> force;  // per wheelset, up on the rail: negative
    RunSummary summary;
    double ms_per_step = 0;  // processor time, without set-up
  };

  [[nodiscard]] Found run(const VsiModel& m) const {
    VsiState state(m);
    EXPECT_TRUE(static_equilibrium(m, state).converged);
    Found found;
    found.force.resize(static_cast<std::size_t>(m.wheelsets()));
    RunObserver observer;
    std::clock_t first = 0;
    observer.record = [&](const StepRecord& record) {
      if (found.u_mid.empty()) first = std::clock();  // the initial state, after set-up
      found.u_mid.push_back(-record.nodes.at(0).displacement[2]);
      for (std::size_t w = 0; w < found.force.size(); ++w)
        found.force[w].push_back(-(record.wheels[2 * w].Q + record.wheels[2 * w + 1].Q));
    };
    IntegrationParameters integration;
    integration.time_step = time_step;
    integration.alpha = 0.0;
    const double duration = time_step * static_cast<double>(reference.t.size() - 1);
    found.summary = simulate(m, integration, duration, 1, state, observer);
    found.ms_per_step =
        1e3 * static_cast<double>(std::clock() - first) / CLOCKS_PER_SEC / static_cast<double>(found.summary.steps);
    EXPECT_TRUE(found.summary.complete) << found.summary.message;
    return found;
  }

  struct Difference {
    double u_mid;  // largest, of the largest displacement
    double force;  // rms, of the rms of the dynamic part, over all wheelsets after the start
  };

  [[nodiscard]] Difference compare(const Found& found) const {
    constexpr double start = 0.3;  // s: the reference starts with a jump of the irregularity's rate
    double u_miss = 0, u_peak = 0, miss = 0, dynamic = 0;
    EXPECT_EQ(found.u_mid.size(), reference.t.size());
    for (std::size_t i = 0; i < reference.t.size(); ++i) {
      u_miss = std::max(u_miss, std::abs(found.u_mid[i] - reference.u_mid[i]));
      u_peak = std::max(u_peak, std::abs(reference.u_mid[i]));
    }
    for (std::size_t w = 0; w < reference.force.size(); ++w) {
      const double static_load =
          -description.get_child("run.static_axle_loads_N").front().second.front().second.get_value<double>();
      for (std::size_t i = 0; i < reference.t.size(); ++i) {
        if (reference.t[i] < start) continue;
        miss += std::pow(found.force[w][i] - reference.force[w][i], 2);
        dynamic += std::pow(reference.force[w][i] + static_load, 2);
      }
    }
    return {u_miss / u_peak, std::sqrt(miss / dynamic)};
  }

  std::filesystem::path folder;
  ptree description;
  Reference reference;
  double time_step = 0;
};

void report(const char* name, const std::string& folder, double u_mid, double force, double ms, const RunSummary& s) {
  const auto steps = static_cast<double>(s.steps);
  std::printf(
      "%s, %s: midspan %.4f %%, forces %.4f %% of the dynamic rms; %.4f ms of processor time per step, %.2f "
      "back-substitutions; wall time structure %.4f, contact %.4f, vehicle %.4f ms, set-up %.2f s\n",
      folder.c_str(), name, 100 * u_mid, 100 * force, ms, static_cast<double>(s.back_substitutions) / steps,
      1e3 * s.seconds_structure / steps, 1e3 * s.seconds_contact / steps, 1e3 * s.seconds_vehicle / steps,
      s.seconds_setup);
  const std::string key = "ttb2d." + folder.substr(0, 5) + (name[0] == 'r' ? ".rigid" : ".hertz");
  testing::measured(key + ".midspan", 100 * u_mid);
  testing::measured(key + ".forces", 100 * force);
}

TEST_P(Ttb2d, RigidWheels) {
  const Found found = run(model(NormalContact::rigid));
  const auto [u_mid, force] = compare(found);
  report("rigid wheels", GetParam(), u_mid, force, found.ms_per_step, found.summary);
  EXPECT_LT(u_mid, 5e-3);
  EXPECT_LT(force, 1e-2);
}

// The same with Hertz's contact: another model, so that only the bridge has to be the same.
TEST_P(Ttb2d, HertzianWheelsGiveTheSameBridge) {
  const Found found = run(model(NormalContact::hertz));
  const auto [u_mid, force] = compare(found);
  report("Hertz", GetParam(), u_mid, force, found.ms_per_step, found.summary);
  EXPECT_LT(u_mid, 1e-2);
}

INSTANTIATE_TEST_SUITE_P(Cases, Ttb2d, ::testing::Values("case1_smooth_1veh", "case2_rough_3veh"),
                         [](const auto& instance) { return instance.param; });

}  // namespace
}  // namespace railtab
