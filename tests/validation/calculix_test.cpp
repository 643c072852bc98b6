// A bridge that CalculiX has assembled, against the built-in beams and beam theory. CalculiX has no beam elements of
// its own: B31, B32 and B32R are expanded into solids (8 nodes with incompatible modes; 20 nodes; 20 nodes with reduced
// integration) whose nodes share the beam node's number. They have shear deformation and rotary inertia: the theory is
// Timoshenko's, and Euler and Bernoulli's only where the beam is slender. Skipped where there is no ccx.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include "../folder_fixture.hpp"
#include "../measured.hpp"
#include "abaqus_rewriting.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/start/static_equilibrium.hpp"
#include "railtab/runtime/structure/beam_element.hpp"
#include "railtab/runtime/structure/imported_bridge.hpp"
#include "railtab/runtime/structure/stiffness_factor.hpp"
#include "railtab/runtime/structure/structure_summary.hpp"
#include "railtab/runtime/vehicle/vehicle_library.hpp"
#include "railtab/runtime/vsi/external_load.hpp"
#include "railtab/runtime/vsi/simulation.hpp"

namespace railtab {
namespace {

constexpr double nu = 0.2;

struct RectangularBeam {
  double length, width, height;
  int elements;
  double E = 34.5e9, density = 2500.0;
  [[nodiscard]] double A() const { return width * height; }
  [[nodiscard]] double Iy() const { return width * std::pow(height, 3) / 12.0; }
  [[nodiscard]] double Iz() const { return height * std::pow(width, 3) / 12.0; }
};

/// A simply supported beam, x forward, y left, z up; lateral motion held where `plane`.
class CalculixBeam {
 public:
  CalculixBeam(const std::string& name, const RectangularBeam& beam, const std::string& type, bool plane)
      : folder_(std::filesystem::temp_directory_path() / ("railtab_ccx_" + name)) {
    std::filesystem::create_directories(folder_);
    const int per_element = type == "B31" ? 1 : 2, last = per_element * beam.elements + 1;
    std::ofstream deck(folder_ / "beam.inp");
    deck << "*NODE, NSET=DECK\n";
    for (int i = 1; i <= last; ++i) deck << i << ", " << beam.length * (i - 1) / (last - 1) << ", 0, 0\n";
    deck << "*ELEMENT, TYPE=" << type << ", ELSET=ALL\n";
    for (int e = 0; e < beam.elements; ++e) {
      deck << e + 1;
      for (int k = 0; k <= per_element; ++k) deck << ", " << per_element * e + k + 1;
      deck << "\n";
    }
    deck << "*MATERIAL, NAME=CONCRETE\n*ELASTIC\n" << beam.E << ", " << nu << "\n*DENSITY\n" << beam.density << "\n";
    // local axis 1 is z: the first dimension is the height
    deck << "*BEAM SECTION, ELSET=ALL, MATERIAL=CONCRETE, SECTION=RECT\n"
         << beam.height << ", " << beam.width << "\n0, 0, 1\n";
    deck << "*BOUNDARY\n1, 1, 4\n" << last << ", 2, 4\n";
    if (plane) deck << "DECK, 2\n";
    deck << "*STEP\n*FREQUENCY, SOLVER=MATRIXSTORAGE\n10\n*END STEP\n";
    deck.close();
    const std::string command = "cd '" + folder_.string() + "' && ccx beam > ccx.log 2>&1";
    ran_ = std::system(command.c_str()) == 0 && std::filesystem::exists(folder_ / "beam.dof");
    parameters.files = {FeFormat::calculix,   folder_ / "beam.mas", folder_ / "beam.sti", {},
                        folder_ / "beam.dof", folder_ / "beam.inp"};
    parameters.damping.ratio = 0.01;
    parameters.deck.set = "deck";
  }
  ~CalculixBeam() { std::filesystem::remove_all(folder_); }
  CalculixBeam(const CalculixBeam&) = delete;
  CalculixBeam& operator=(const CalculixBeam&) = delete;

  [[nodiscard]] static bool installed() { return std::system("command -v ccx > /dev/null 2>&1") == 0; }
  [[nodiscard]] bool ran() const { return ran_; }

  ImportParameters parameters;

 private:
  std::filesystem::path folder_;
  bool ran_ = false;
};

#define RAILTAB_NEEDS_CALCULIX() \
  if (!CalculixBeam::installed()) GTEST_SKIP() << "no ccx (Debian: calculix-ccx)"

BridgeParameters built_in(const RectangularBeam& beam) {
  BridgeParameters span;
  span.length = beam.length;
  span.E = beam.E;
  span.G = beam.E / (2.0 * (1.0 + nu));
  span.A = beam.A();
  span.Iy = beam.Iy();
  span.Iz = beam.Iz();
  span.mass = beam.density * beam.A();
  span.rotary_inertia = beam.density * (beam.Iy() + beam.Iz());
  span.elements = 40;
  return span;
}

/// n-th circular frequency of a simply supported Timoshenko beam: the lower root of
/// r²ρ/G ω⁴ − (1 + r²k²(1 + E/G)) ω² + r²k⁴E/ρ = 0 with k = nπ/L, r² = I/A [TimoshenkoYoungWeaver1974, Sect. 5.12]. The
/// shear coefficient is 1: one quadratic element over the height has the same shear strain everywhere.
double timoshenko(const RectangularBeam& beam, int n) {
  const double k = n * std::numbers::pi / beam.length, r2 = beam.Iy() / beam.A();
  const double G = beam.E / (2.0 * (1.0 + nu));
  const double a = r2 * beam.density / G, b = 1.0 + r2 * k * k * (1.0 + beam.E / G),
               c = r2 * std::pow(k, 4) * beam.E / beam.density;
  return std::sqrt(2.0 * c / (b + std::sqrt(b * b - 4.0 * a * c)));
}

std::vector<double> frequencies(const ImportParameters& parameters, int modes) {
  return summarise(read_fe_structure(parameters.files, parameters.frame), parameters.damping, modes).frequencies;
}

// Slender (1:125): the theories are the same to 0.25 % in the fifth mode.
TEST(Calculix, FirstFiveBendingFrequenciesOfASlenderBridge) {
  RAILTAB_NEEDS_CALCULIX();
  const RectangularBeam beam{25.0, 0.4, 0.2, 20};
  const CalculixBeam written("slender", beam, "B32R", true);
  ASSERT_TRUE(written.ran());
  const std::vector<double> found = frequencies(written.parameters, 5);
  ASSERT_EQ(found.size(), 5u);
  std::vector<double> expected;
  for (double f : summarise({built_in(beam)}, 30).frequencies) {
    // the built-in span moves out of its plane too
    const double n =
        std::round(std::sqrt(f / (simply_supported_frequency(
                                      {beam.E, beam.A(), beam.Iy(), 0, 0, beam.density * beam.A(), 0}, beam.length, 1) /
                                  (2 * std::numbers::pi))));
    const double bending = simply_supported_frequency({beam.E, beam.A(), beam.Iy(), 0, 0, beam.density * beam.A(), 0},
                                                      beam.length, static_cast<int>(n)) /
                           (2 * std::numbers::pi);
    if (std::abs(f / bending - 1.0) < 1e-3 && expected.size() < 5) expected.push_back(f);
  }
  ASSERT_EQ(expected.size(), 5u);
  for (std::size_t n = 0; n < 5; ++n) {
    testing::measured("calculix.mode_" + std::to_string(n + 1), 100 * (found[n] / expected[n] - 1));
    EXPECT_NEAR(found[n], expected[n], 0.005 * expected[n]) << "mode " << n + 1;
  }
}

// Stout (1:12.5): what the solids have and Euler-Bernoulli beams do not is shear and rotary inertia.
TEST(Calculix, AStoutBridgeFollowsTimoshenko) {
  RAILTAB_NEEDS_CALCULIX();
  const RectangularBeam beam{25.0, 1.0, 2.0, 20};
  const CalculixBeam written("stout", beam, "B32R", true);
  ASSERT_TRUE(written.ran());
  const std::vector<double> found = frequencies(written.parameters, 8);
  const BeamSection section{beam.E, beam.A(), beam.Iy(), 0, 0, beam.density * beam.A(), 0};
  for (int n = 1; n <= 3; ++n) {
    const double omega = timoshenko(beam, n), euler = simply_supported_frequency(section, beam.length, n);
    double nearest = 0.0;  // modes along x stand between those of bending
    for (double f : found) {
      if (std::abs(2 * std::numbers::pi * f - omega) < std::abs(nearest - omega)) nearest = 2 * std::numbers::pi * f;
    }
    testing::measured("calculix.stout_" + std::to_string(n), 100 * (nearest / omega - 1));
    EXPECT_NEAR(nearest, omega, 5e-4 * omega) << n;
    EXPECT_GT(euler / omega - 1.0, 0.008 * n * n) << "the theories differ here";
  }
}

/// A beam of 12 × 2 × 2 solids C3D8I of 1 m × 0.5 m × 0.5 m, whose inner modes have rows; x forward, y left, z up, held
/// on the lower edges of both ends.
class SolidBeam : public testing::InFolder {
 protected:
  static int number(int i, int j, int k) { return 9 * i + 3 * j + k + 1; }
  [[nodiscard]] ImportParameters written() const {
    std::ofstream input(folder_ / "solid.inp");
    input << "*NODE, NSET=ALL\n";
    for (int i = 0; i <= 12; ++i) {
      for (int j = 0; j < 3; ++j) {
        for (int k = 0; k < 3; ++k) input << number(i, j, k) << ", " << i << ", " << 0.5 * j << ", " << 0.5 * k << "\n";
      }
    }
    input << "*ELEMENT, TYPE=C3D8I, ELSET=ALL\n";
    for (int i = 0; i < 12; ++i) {
      for (const auto& [j, k] : {std::pair{0, 0}, {0, 1}, {1, 0}, {1, 1}}) {
        input << 4 * i + 2 * j + k + 1;
        for (const int z : {k, k + 1}) {
          for (const auto& [x, y] : {std::pair{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}})
            input << ", " << number(x, y, z);
        }
        input << "\n";
      }
    }
    input << "*MATERIAL, NAME=CONCRETE\n*ELASTIC\n34.5e9, 0.2\n*DENSITY\n2500.\n"
          << "*SOLID SECTION, ELSET=ALL, MATERIAL=CONCRETE\n*BOUNDARY\n";
    for (int j = 0; j < 3; ++j) input << number(0, j, 0) << ", 1, 3\n" << number(12, j, 0) << ", 2, 3\n";
    input << "*STEP\n*FREQUENCY, SOLVER=MATRIXSTORAGE\n2\n*END STEP\n";
    input.close();
    const std::string command = "cd '" + folder_.string() + "' && ccx solid > ccx.log 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0);
    ImportParameters parameters;
    parameters.files = {FeFormat::calculix,    folder_ / "solid.mas", folder_ / "solid.sti", {},
                        folder_ / "solid.dof", folder_ / "solid.inp"};
    return parameters;
  }
};

// A force P = 1 MN at x = 7 m, beside the axis: statics, in planes of nodes and between them, about any axis.
TEST_F(SolidBeam, SectionForcesAreThoseOfStatics) {
  RAILTAB_NEEDS_CALCULIX();
  ImportParameters parameters = written();
  parameters.sections = {1.5, 3.0, 5.25, 7.0, 9.9};
  for (const double depth : {-0.5, 0.0}) {
    parameters.axis_depth = depth;
    const FeStructure structure = read_on_supports(parameters);
    EXPECT_GT(std::ranges::count(structure.node_of_row, no_node), 0);
    Eigen::VectorXd load = Eigen::VectorXd::Zero(structure.dofs());
    load[structure.nodes.at(number(7, 2, 2)).rows[2].front()] = 1e6;
    const Eigen::VectorXd u = stiffness_factor(structure.stiffness).solve(load);
    double worst = 0.0;
    ASSERT_EQ(structure.sections.size(), 10U);
    for (const DeckRow& row : structure.sections) {
      double found = 0.0;
      for (const auto& [dof, factor] : row.sum) found += factor * u[dof];
      const double x = row.at.x;
      const double moment = 1e6 * std::min(x * 5.0, (12.0 - x) * 7.0) / 12.0;
      const double shear = 1e6 * (x < 7.0 ? 5.0 : x > 7.0 ? -7.0 : -1.0) / 12.0;
      const double error = row.at.quantity == DeckQuantity::shear_force ? found - shear : found - moment;
      worst = std::max(worst, std::abs(error) / 1e6);
    }
    std::printf("sections of solids: %.1e of the force (times 1 m)\n", worst);
    EXPECT_LT(worst, 1e-9);
  }
  parameters.sections = {0.5};
  EXPECT_THROW(static_cast<void>(read_on_supports(parameters)), InputError) << "elements at the constraint";
}

// A deck that is cut off within its nodes: the rows of those that it lacks are no inner modes.
TEST_F(SolidBeam, ADeckThatIsCutOffWithinItsNodesIsRejected) {
  RAILTAB_NEEDS_CALCULIX();
  const ImportParameters parameters = written();
  std::ifstream whole(folder_ / "solid.inp");
  std::string cut, line;
  for (int lines = 0; lines < 100 && std::getline(whole, line); ++lines) cut += line + "\n";
  std::ofstream(folder_ / "solid.inp") << cut;
  try {
    static_cast<void>(read_fe_structure(parameters.files, {}));
    ADD_FAILURE() << "accepted";
  } catch (const InputError& wrong) {
    const std::string message = wrong.what();
    EXPECT_NE(message.find("solid.inp: found nodes up to 99 and 0 elements"), std::string::npos) << message;
    EXPECT_NE(message.find("the whole input deck"), std::string::npos) << message;
  }
}

void expect_same_bits(const Eigen::SparseMatrix<double>& a, const Eigen::SparseMatrix<double>& b) {
  ASSERT_TRUE(a.isCompressed() && b.isCompressed());
  ASSERT_EQ(a.rows(), b.rows());
  ASSERT_EQ(a.nonZeros(), b.nonZeros());
  EXPECT_TRUE(std::equal(a.outerIndexPtr(), a.outerIndexPtr() + a.cols() + 1, b.outerIndexPtr()));
  EXPECT_TRUE(std::equal(a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros(), b.innerIndexPtr()));
  EXPECT_TRUE(std::equal(a.valuePtr(), a.valuePtr() + a.nonZeros(), b.valuePtr()));
}

// CalculiX's matrices in Abaqus's two formats, by names of nodes in one triangle and by numbers of rows in both: the
// same structure to the last bit, inner modes of the elements and constraints included.
TEST_F(SolidBeam, ItsMatricesInAbaqussFormatsAreTheSameStructure) {
  RAILTAB_NEEDS_CALCULIX();
  const ImportParameters parameters = written();
  const FeFrame frame{"mm-N-t", "x -y -z", {{6000.0, 500.0, 1500.0}}};
  const FeStructure of_calculix = read_fe_structure(parameters.files, frame);
  ASSERT_GT(std::ranges::count(of_calculix.node_of_row, no_node), 0);
  for (const auto format : {testing::AbaqusFormat::matrix_input, testing::AbaqusFormat::coordinate}) {
    const testing::AbaqusRewriting rewriting(parameters.files, format);
    EXPECT_EQ(rewriting.held().size(), 15U) << "on the lower edges of both ends";
    const FeStructure read = read_fe_structure(rewriting.written(), frame);
    expect_same_bits(read.stiffness, of_calculix.stiffness);
    expect_same_bits(read.mass, of_calculix.mass);
    EXPECT_EQ(read.motion, of_calculix.motion);
    EXPECT_EQ(read.node_of_row, of_calculix.node_of_row);
    for (const auto& [number, node] : of_calculix.nodes) EXPECT_EQ(read.nodes.at(number).rows, node.rows) << number;
  }
}

TEST(Calculix, ExpandedBeamsHaveNoSections) {
  RAILTAB_NEEDS_CALCULIX();
  CalculixBeam written("sections", {25.0, 0.4, 0.2, 20}, "B32R", true);
  ASSERT_TRUE(written.ran());
  written.parameters.sections = {12.0};
  written.parameters.axis_depth = 0.0;
  try {
    static_cast<void>(read_on_supports(written.parameters));
    ADD_FAILURE() << "accepted";
  } catch (const InputError& wrong) {
    EXPECT_NE(std::string(wrong.what()).find("expanded into solids"), std::string::npos) << wrong.what();
  }
}

/// Largest deflection and acceleration at midspan while a coach crosses.
struct Response {
  double deflection = 0.0, acceleration = 0.0;
};

Response crossing(const StructureModel& structure, double length) {
  VsiModel model;
  model.vehicle = build_coach(coach_parameters("manchester-coach"));
  model.vehicle_x = {-20.0};
  model.normal_contact = NormalContact::rigid;
  model.contact.speed = 55.0;
  model.structure = share(structure);
  VsiState state(model);
  IntegrationParameters integration;
  integration.time_step = 1e-3;
  EXPECT_TRUE(steady_start(model, state).converged);
  Response response;
  RunObserver observer;
  const auto deck =
      static_cast<std::size_t>(std::find_if(structure.nodes.begin(), structure.nodes.end(),
                                            [](const StructureNode& node) { return node.name == "deck-midspan-1"; }) -
                               structure.nodes.begin());
  observer.record = [&](const StepRecord& step) {
    response.deflection = std::max(response.deflection, std::abs(step.nodes[deck].displacement[2]));
    response.acceleration = std::max(response.acceleration, std::abs(step.nodes[deck].acceleration[2]));
  };
  EXPECT_TRUE(simulate(model, integration, (length + 32.0) / model.contact.speed, 1, state, observer).complete);
  return response;
}

// Midspan against the ground, vertical, while all supports are shaken alike.
std::vector<double> shaken(const StructureModel& structure) {
  std::vector<double> time;
  std::vector<GroundVector> acceleration;
  for (int i = 0; i <= 100; ++i) {
    time.push_back(0.01 * i);
    const double a = 2.0 * std::sin(std::numbers::pi * time.back()) * std::sin(12.0 * time.back());
    acceleration.emplace_back(a, a);
  }
  VsiModel model;
  model.ground_motion.emplace(GroundRecord::from_acceleration(time, acceleration));
  model.structure = share(structure);
  const HhtScheme hht{.alpha = -0.05, .time_step = 1e-3};
  const StructureResponse response(structure, hht);
  LinearMotion motion(structure.dofs());
  Eigen::VectorXd load;
  const auto vertical = [&](const Eigen::VectorXd& u) { return node_motion(structure, 0, 2, u); };
  std::vector<double> relative;
  for (int step = 0; step < 1000; ++step) {
    past_contact_load(hht, motion, {0, structure.dofs()}, load);
    add_ground_load(model, hht, step * hht.time_step, {0, structure.dofs()}, load);
    update(hht, response.increment(motion, load), motion);
    const double ground = model.ground_motion->at(0.0, (step + 1) * hht.time_step).displacement[1];
    relative.push_back(vertical(motion.displacement) - ground);
  }
  return relative;
}

TEST(Calculix, MidspanUnderATrainAndOnMovingGroundIsThatOfTheBuiltInBridge) {
  RAILTAB_NEEDS_CALCULIX();
  // stiff and heavy, so that it can be slender: shear, which the built-in span does not have, is small
  const RectangularBeam beam{30.0, 3.0, 0.5, 20, 8.0 * 34.5e9, 5000.0};
  CalculixBeam written("train", beam, "B32R", false);
  ASSERT_TRUE(written.ran());
  written.parameters.frame.origin = {{0.0, 0.0, 1.2}};  // rail-head tops over the axis
  // the same damping: at the first two bending frequencies
  const BeamSection section{beam.E, beam.A(), beam.Iy(), 0, 0, beam.density * beam.A(), 0};
  for (int n = 1; n <= 2; ++n) {
    written.parameters.damping.frequencies[static_cast<std::size_t>(n - 1)] =
        simply_supported_frequency(section, beam.length, n) / (2 * std::numbers::pi);
  }
  TrackParameters track;
  track.length_before = track.length_after = 48.0;
  BridgeParameters span = built_in(beam);
  span.axis_depth = 1.2;
  const StructureModel of_calculix = build_track_on_import(track, written.parameters);
  const StructureModel built_in_span = build_track_bridge(track, {span});
  const Response imported = crossing(of_calculix, beam.length);
  const Response built = crossing(built_in_span, beam.length);
  testing::measured("calculix.deflection", 100 * (imported.deflection / built.deflection - 1));
  testing::measured("calculix.acceleration", 100 * (imported.acceleration / built.acceleration - 1));
  EXPECT_GT(built.deflection, 1e-4);
  EXPECT_NEAR(imported.deflection, built.deflection, 0.01 * built.deflection);
  EXPECT_NEAR(imported.acceleration, built.acceleration, 0.01 * built.acceleration);

  EXPECT_TRUE(of_calculix.supports.alike_only()) << "the rows of its supports are not in the matrices";
  const std::vector<double> found = shaken(of_calculix), expected = shaken(built_in_span);
  double worst = 0.0, size = 0.0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    worst = std::max(worst, std::abs(found[i] - expected[i]));
    size = std::max(size, std::abs(expected[i]));
  }
  std::printf("on moving ground: %.2e of the largest deflection %.2e m\n", worst / size, size);
  testing::measured("calculix.ground", 100 * worst / size);
  EXPECT_GT(size, 1e-4);
  EXPECT_LT(worst, 0.02 * size);
}

}  // namespace
}  // namespace railtab
