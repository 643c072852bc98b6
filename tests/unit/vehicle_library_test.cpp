// Every vehicle of the library against its source's sums and against closed forms of its own.
#include "railtab/runtime/vehicle/vehicle_library.hpp"
#include "railtab/runtime/base/dense_solvers.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <numbers>
#include <set>
#include <sstream>

#include "railtab/runtime/vehicle/vehicle_modes.hpp"
#include "railtab/runtime/vehicle/vehicle_summary.hpp"

namespace railtab {
namespace {

/// Wheels and the static load of each [kN]: the masses of the sources summed by hand, times 9.81 m/s². The axle counts
/// of the locomotives are those with which the masses add up to 138 t and 124 t. metro-gz18: what the program of its
/// source prints, 0.02 % above its masses times 9.81 m/s².
struct Stand {
  std::size_t wheels;
  double load;
};
const std::map<std::string, Stand> stands{
    {"manchester-coach", {8, 54.546}},
    {"manchester-coach-series", {8, 54.546}},
    {"chinese-high-speed-car", {8, 55.917}},
    {"chinese-emu-car", {8, 55.917}},
    {"crh380a", {8, 65.000}},
    {"china-star-power-car", {8, 95.647}},
    {"c0c0-locomotive", {12, 112.815}},
    {"c0c0-locomotive-fast", {12, 101.337}},
    {"speed-raised-coach", {8, 49.786}},
    {"ordinary-coach", {8, 66.843}},
    {"metro-gz18", {8, 68.296}},
    {"ice3-like-coach", {8, 78.480}},
    {"freight-21t", {8, 103.079}},
    {"freight-21t-empty", {8, 26.561}},
    {"freight-25t", {8, 119.697}},
    {"velaro-e-coach", {8, 76.028}},
    {"shinkansen-300", {8, 67.382}},
    {"eurostar-power-car", {8, 76.886}},
    {"traxx-locomotive", {8, 103.005}},
};

/// The vehicle without dampers and without the lean of its weight, so that natural frequencies are those of masses on
/// springs.
VehicleModel undamped(VehicleData data) {
  for (Suspension& unit : data.parts.suspension) unit.damping.setZero();
  return build_vehicle(data, data.motion, {standard_gravity, GeometricStiffness::omitted});
}

bool is_among(const std::vector<VehicleMode>& modes, double frequency) {
  return std::any_of(modes.begin(), modes.end(), [&](const VehicleMode& mode) {
    return std::abs(mode.frequency - frequency) < 1e-6 * frequency && std::abs(mode.damping) < 1e-6;
  });
}

/// Natural frequencies of masses above each other, m[0] on k[0] on m[1] … on the ground [Hz].
std::vector<double> chain(const std::vector<double>& m, const std::vector<double>& k) {
  const auto n = static_cast<Eigen::Index>(m.size());
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double stiffness = k[static_cast<std::size_t>(i)];
    K(i, i) += stiffness;
    if (i + 1 == n) continue;
    K(i + 1, i + 1) += stiffness;
    K(i, i + 1) -= stiffness;
    K(i + 1, i) -= stiffness;
  }
  const Eigen::VectorXd scale = Eigen::Map<const Eigen::VectorXd>(m.data(), n).cwiseSqrt().cwiseInverse();
  const Eigen::VectorXd omega2 = symmetric_spectrum(scale.asDiagonal() * K * scale.asDiagonal()).values;
  std::vector<double> frequencies;
  for (const double value : omega2) frequencies.push_back(std::sqrt(value) / (2.0 * std::numbers::pi));
  return frequencies;
}

/// A natural motion of tests/reference/vehicle_modes.csv.
struct ReferenceMode {
  double undamped, frequency, damping;  ///< [Hz, Hz, -]
};

std::vector<ReferenceMode> reference_modes(const std::string& vehicle) {
  std::ifstream file(RAILTAB_REFERENCE_DIR "/vehicle_modes.csv");
  std::vector<ReferenceMode> modes;
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with(vehicle + ",")) continue;
    std::istringstream fields(line.substr(vehicle.size()));
    char comma = 0;
    std::size_t number = 0;
    ReferenceMode mode{};
    fields >> comma >> number >> comma >> mode.undamped >> comma >> mode.frequency >> comma >> mode.damping;
    EXPECT_TRUE(fields && number == modes.size() + 1) << line;
    modes.push_back(mode);
  }
  return modes;
}

class VehicleLibrary : public ::testing::TestWithParam<std::string> {};

TEST_P(VehicleLibrary, MassesCloseAndWheelsCarryWhatTheSourceSays) {
  const VehicleData data = library_vehicle(GetParam());
  EXPECT_EQ(data.name, GetParam());
  const auto stand = stands.find(GetParam());
  ASSERT_NE(stand, stands.end()) << "a static wheel load of the source for each vehicle of the library";
  const VehicleSummary summary = summarise(build_vehicle(data, data.motion), 0);
  EXPECT_EQ(2 * summary.wheel_load.size(), stand->second.wheels);
  for (const double load : summary.wheel_load) EXPECT_NEAR(1e-3 * load, stand->second.load, 3e-4 * stand->second.load);

  std::set<std::string> stated;
  for (const ClosingCheck& check : closing_checks(data)) {
    EXPECT_TRUE(check.holds()) << check.stated.quantity << ": " << check.found.value_or(NAN);
    stated.insert(check.stated.quantity);
  }
  EXPECT_TRUE(stated.contains("mass") && stated.contains("car body bounce"));
  EXPECT_GT(data.top_speed, 80.0 / 3.6);
}

TEST_P(VehicleLibrary, EveryValueHasASourceAndEveryDoubtANote) {
  const VehicleData data = library_vehicle(GetParam());
  EXPECT_GT(data.sourced.values.size(), 10U);
  for (const SourcedValue& value : data.sourced.values) {
    EXPECT_FALSE(value.provenance.source.empty()) << value.key;
    EXPECT_FALSE(value.provenance.date.empty()) << value.key;
    if (value.provenance.source == "none") {
      EXPECT_NE(value.provenance.standing, Standing::verified) << value.key;
    }
    if (value.provenance.standing == Standing::suspect) {
      EXPECT_FALSE(value.provenance.note.empty()) << value.key;
    }
  }
}

TEST_P(VehicleLibrary, BounceIsThatOfMassesOnSprings) {
  const VehicleData data = library_vehicle(GetParam());
  const std::vector<VehicleMode> modes = natural_modes(undamped(data), 200);
  std::vector<double> expected;
  if (data.coach) {
    const CoachParameters& p = *data.coach;
    expected = chain({p.car_body.mass, 2 * p.bogie.mass}, {4 * p.secondary.kz, 4 * p.axles_per_bogie * p.primary.kz});
  } else {  // car body, bolsters, side frames: centre plates, springs and wedges, adapters
    const auto kz = [&](std::size_t body_a, std::size_t body_b) {
      double sum = 0;
      for (const Suspension& unit : data.parts.suspension) {
        const std::string& a = data.parts.bodies[static_cast<std::size_t>(unit.body_a)].name;
        const std::string& b = data.parts.bodies[static_cast<std::size_t>(unit.body_b)].name;
        const std::string kinds[] = {"wheelset", "side-frame", "bolster", "car-body"};
        if (a.starts_with(kinds[body_a]) && b.starts_with(kinds[body_b])) sum += unit.stiffness.z();
      }
      return sum;
    };
    const auto mass = [&](const std::string& kind) {
      double sum = 0;
      for (const RigidBody& body : data.parts.bodies) sum += body.name.starts_with(kind) ? body.mass : 0.0;
      return sum;
    };
    expected = chain({mass("car-body"), mass("bolster"), mass("side-frame")}, {kz(2, 3), kz(1, 2), kz(0, 1)});
  }
  for (const double frequency : expected) EXPECT_TRUE(is_among(modes, frequency)) << frequency << " Hz";
}

/// The first eight natural motions against an own assembly from energies (tests/reference/vehicle_modes.py): masses on
/// springs without dampers and without the lean of the weight, and the linear vehicle with both, as `vsi vehicle`
/// prints it. Vertical data have six motions, bounce and pitch of the car body and of two bogies.
TEST_P(VehicleLibrary, FirstEightMotionsAreThoseOfAnOwnAssembly) {
  const VehicleData data = library_vehicle(GetParam());
  const std::vector<ReferenceMode> expected = reference_modes(GetParam());
  ASSERT_EQ(expected.size(), data.motion == MotionPlane::vertical ? 6U : 8U);
  const int count = static_cast<int>(expected.size());
  const std::vector<VehicleMode> undamped_modes = natural_modes(undamped(data), count);
  const std::vector<VehicleMode> modes = natural_modes(build_vehicle(data, data.motion), count);
  ASSERT_EQ(undamped_modes.size(), expected.size());
  ASSERT_EQ(modes.size(), expected.size());
  constexpr double tolerance = 1e-6;  // of the nine digits of the reference, and of nearly equal eigenvalues
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_NEAR(undamped_modes[k].frequency / expected[k].undamped, 1.0, tolerance) << "mode " << k + 1;
    EXPECT_NEAR(modes[k].frequency / expected[k].frequency, 1.0, tolerance) << "mode " << k + 1;
    EXPECT_NEAR(modes[k].damping, expected[k].damping, tolerance) << "mode " << k + 1;
  }
}

TEST_P(VehicleLibrary, SpringsHoldEveryMotionAndDampersDampIt) {
  const VehicleData data = library_vehicle(GetParam());
  const VehicleModel vehicle = build_vehicle(data, data.motion);
  EXPECT_LT((vehicle.stiffness - vehicle.stiffness.transpose()).norm(), 1e-14 * vehicle.stiffness.norm());
  EXPECT_LT((vehicle.damping - vehicle.damping.transpose()).norm(), 1e-14 * vehicle.damping.norm());
  const std::vector<VehicleMode> modes = natural_modes(vehicle, 200);
  ASSERT_FALSE(modes.empty());
  EXPECT_GT(modes.front().frequency, 0.1);
  for (const VehicleMode& mode : modes) {
    EXPECT_GT(mode.damping, -1e-9) << mode.motion;
    if (mode.motion.starts_with("car body")) {
      EXPECT_GT(mode.damping, 0.02) << mode.motion;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Of, VehicleLibrary, ::testing::ValuesIn(vehicle_names()), [](const auto& vehicle) {
  std::string name = vehicle.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

/// Longitudinal springs couple the pitch of spatial vehicles; vertical data have none.
TEST(VehiclePitch, OfVerticalDataIsThatOfTheChainAtTheBogieDistance) {
  int vehicles = 0;
  for (const std::string& name : vehicle_names()) {
    const VehicleData data = library_vehicle(name);
    if (data.motion != MotionPlane::vertical) continue;
    ++vehicles;
    const CoachParameters& p = *data.coach;
    const double L = p.half_bogie_distance;
    const std::vector<VehicleMode> modes = natural_modes(undamped(data), 200);
    EXPECT_EQ(modes.size(), 6U);  // bounce and pitch of three bodies
    for (const double frequency :
         chain({p.car_body.Jy / (L * L), 2 * p.bogie.mass}, {4 * p.secondary.kz, 8 * p.primary.kz})) {
      EXPECT_TRUE(is_among(modes, frequency)) << name << ": " << frequency << " Hz";
    }
    const double bogie = std::sqrt(4 * p.primary.kz * p.half_wheelbase * p.half_wheelbase / p.bogie.Jy);
    EXPECT_TRUE(is_among(modes, bogie / (2.0 * std::numbers::pi))) << name;
  }
  EXPECT_EQ(vehicles, 4);
}

/// "| manchester-coach | 44.482 | 4 | 54.5 | 1.08 | 0.13 | spatial |" for each vehicle.
std::string table_of_library() {
  std::string table;
  for (const std::string& name : vehicle_names()) {
    const VehicleData data = library_vehicle(name);
    const VehicleModel vehicle = build_vehicle(data, data.motion);
    const VehicleSummary summary = summarise(vehicle, 0);
    const std::vector<VehicleMode> modes = natural_modes(vehicle, vehicle.dofs());
    // of a pair of motions without oscillation the slower one
    const auto bounce = std::find_if(modes.begin(), modes.end(), [](const VehicleMode& mode) {
      return mode.motion == "car body bounce" && mode.damping < 1.0;
    });
    EXPECT_NE(bounce, modes.end()) << name;
    table += fmt::format("| `{}` | {:.3f} | {} | {:.1f} | {:.2f} | {:.2f} | {} |\n", name, 1e-3 * summary.mass,
                         summary.wheel_load.size(), 1e-3 * summary.wheel_load.front(), bounce->frequency,
                         bounce->damping, data.motion == MotionPlane::vertical ? "vertical" : "spatial");
  }
  return table;
}

/// With RAILTAB_UPDATE_GUIDE set, the test writes the table (tools/regenerate any) and passes.
TEST(VehicleTable, IsThatOfTheTheoryPage) {
  const std::string file = RAILTAB_SOURCE_DIR "/docs/theory/vehicle.md";
  std::ifstream stream(file);
  std::string page((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  const std::size_t heading = page.find("| vehicle | mass in t |");
  ASSERT_NE(heading, page.npos);
  const std::size_t begin = page.find('\n', page.find('\n', heading) + 1) + 1;
  std::size_t end = begin;
  while (page[end] == '|') end = page.find('\n', end) + 1;
  const std::string expected = table_of_library();
  if (std::getenv("RAILTAB_UPDATE_GUIDE") != nullptr) {
    page.replace(begin, end - begin, expected);
    std::ofstream(file) << page;
  } else {
    EXPECT_EQ(page.substr(begin, end - begin), expected) << "tools/regenerate any writes this table";
  }
}

TEST(VehicleModes, AreNamedAfterTheBodyThatMoves) {
  const VehicleData data = library_vehicle("manchester-coach");
  const std::vector<VehicleMode> modes = natural_modes(build_vehicle(data, data.motion), 7);
  std::vector<std::string> names;
  for (const VehicleMode& mode : modes) names.push_back(mode.motion);
  const std::set<std::string> car(names.begin(), names.begin() + 5), bogies(names.begin() + 5, names.end());
  EXPECT_EQ(car, (std::set<std::string>{"car body lower sway", "car body yaw", "car body bounce", "car body upper sway",
                                        "car body pitch"}));
  EXPECT_EQ(bogies, (std::set<std::string>{"bogie bounce, in phase", "bogie bounce, in opposition"}));
}

/// A damped motion: the roots of the characteristic polynomial of two masses on two spring-dampers.
TEST(VehicleModes, DampingIsThatOfTheCharacteristicPolynomial) {
  const VehicleData data = library_vehicle("shinkansen-300");
  const CoachParameters& p = *data.coach;
  const double m1 = p.car_body.mass, m2 = 2 * p.bogie.mass;
  const double k1 = 4 * p.secondary.kz, k2 = 8 * p.primary.kz, c1 = 4 * p.secondary.cz, c2 = 8 * p.primary.cz;
  const auto polynomial = [&](std::complex<double> s) {
    const std::complex<double> upper = c1 * s + k1, lower = c2 * s + k2;
    return (m1 * s * s + upper) * (m2 * s * s + upper + lower) - upper * upper;
  };
  int bounces = 0;
  for (const VehicleMode& mode : natural_modes(build_vehicle(data, MotionPlane::vertical), 12)) {
    const double omega = 2.0 * std::numbers::pi * mode.frequency;
    const std::complex<double> s(-mode.damping * omega, std::sqrt(1.0 - mode.damping * mode.damping) * omega);
    const double scale = m1 * m2 * std::pow(omega, 4) + k1 * k2;
    const bool in_phase = mode.motion == "car body bounce" || mode.motion == "bogie bounce, in phase";
    if (!in_phase) continue;
    EXPECT_LT(std::abs(polynomial(s)), 1e-7 * scale) << mode.motion;
    ++bounces;
  }
  EXPECT_EQ(bounces, 2);
}

TEST(VehicleModes, VerticalDataMakeNoModelWithLateralMotion) {
  const VehicleData data = library_vehicle("velaro-e-coach");
  EXPECT_EQ(build_vehicle(data, MotionPlane::vertical).dofs(), 10);
  EXPECT_ANY_THROW((void)build_vehicle(data, MotionPlane::spatial));
}

}  // namespace
}  // namespace railtab
