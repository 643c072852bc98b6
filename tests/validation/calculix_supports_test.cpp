// A slab of solids with incompatible modes (C3D8I) that CalculiX has assembled without constraints, on supports that
// the ground moves differently. Its matrices couple inner modes and translations by rounding alone, in which no
// single row shows whether the slab stands on anything else. Skipped where there is no ccx.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "../measured.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/scene/scene_run.hpp"
#include "railtab/runtime/structure/stiffness_factor.hpp"
#include "railtab/runtime/vsi/simulation.hpp"
#include "railtab/runtime/vsi/step_record.hpp"

namespace railtab {
namespace {

/// 16 m x 4 m x 0.9 m of 32 x 6 x 3 elements in mm, N and t; x forward, y left, z up.
class CalculixSlab : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::system("command -v ccx > /dev/null 2>&1") != 0) GTEST_SKIP() << "no ccx (Debian: calculix-ccx)";
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  static constexpr int nx = 32, ny = 6, nz = 3;
  static int node(int i, int j, int k) { return (k * (ny + 1) + j) * (nx + 1) + i + 1; }

  /// @param constraints a *BOUNDARY block, or nothing
  [[nodiscard]] ImportParameters assembled(const std::string& name, const std::string& constraints = "") const {
    std::ofstream deck(folder_ / (name + ".inp"));
    deck << "*NODE\n";
    for (int k = 0; k <= nz; ++k) {
      for (int j = 0; j <= ny; ++j) {
        for (int i = 0; i <= nx; ++i) {
          deck << node(i, j, k) << ", " << 500.0 * i << ", " << 4000.0 * j / ny - 2000.0 << ", " << 300.0 * k << "\n";
        }
      }
    }
    deck << "*ELEMENT, TYPE=C3D8I, ELSET=ALL\n";
    for (int k = 0, e = 0; k < nz; ++k) {
      for (int j = 0; j < ny; ++j) {
        for (int i = 0; i < nx; ++i) {
          deck << ++e;
          for (const int up : {0, 1}) {
            for (const auto& [di, dj] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
              deck << ", " << node(i + di, j + dj, k + up);
          }
          deck << "\n";
        }
      }
    }
    deck << "*NSET, NSET=DECK, GENERATE\n" << node(0, 0, nz) << ", " << node(nx, ny, nz) << "\n";
    for (const auto& [set, i] : {std::pair{"FIRST", 0}, {"LAST", nx}}) {
      deck << "*NSET, NSET=" << set << "\n";
      for (int j = 0; j <= ny; ++j) deck << node(i, j, 0) << ",\n";
    }
    deck << "*NSET, NSET=MIDDLE\n" << node(nx / 2, ny / 2, 0) << "\n";
    deck << "*MATERIAL, NAME=CONCRETE\n*ELASTIC\n34500, 0.2\n*DENSITY\n2.5e-9\n"
         << "*SOLID SECTION, ELSET=ALL, MATERIAL=CONCRETE\n"
         << constraints << "*STEP\n*FREQUENCY, SOLVER=MATRIXSTORAGE\n10\n*END STEP\n";
    deck.close();
    const std::string command = "cd '" + folder_.string() + "' && ccx " + name + " > ccx.log 2>&1";
    const auto file = [&](const char* suffix) { return folder_ / (name + suffix); };
    EXPECT_EQ(std::system(command.c_str()), 0);
    EXPECT_TRUE(std::filesystem::exists(file(".dof")));
    ImportParameters parameters;
    parameters.files = {FeFormat::calculix, file(".mas"), file(".sti"), {}, file(".dof"), file(".inp")};
    parameters.frame.units = "mm-N-t";
    parameters.frame.origin = {{0.0, 0.0, 1800.0}};
    parameters.deck.set = "DECK";
    parameters.supports.resize(2);
    parameters.supports[0].nodes.set = "FIRST";
    parameters.supports[1].nodes.set = "LAST";
    parameters.supports[1].holds = {"y", "z"};
    return parameters;
  }

  /// The stiffness again with fewer digits.
  [[nodiscard]] ImportParameters rounded(ImportParameters parameters, int digits) const {
    std::ifstream in(parameters.files.stiffness);
    parameters.files.stiffness = folder_ / ("rounded_" + std::to_string(digits) + ".sti");
    std::ofstream out(parameters.files.stiffness);
    out.precision(digits - 1);
    out << std::scientific;
    int row = 0, column = 0;
    for (double value = 0.0; in >> row >> column >> value;) out << row << " " << column << " " << value << "\n";
    return parameters;
  }

  [[nodiscard]] std::filesystem::path record() const {
    std::ofstream out(folder_ / "record.csv");
    out << "t[s],y[m/s2],z[m/s2]\n";
    for (int i = 0; i <= 60; ++i) {
      const double t = 0.005 * i, a = 2.0 * std::sin(std::numbers::pi * t / 0.3) * std::sin(40.0 * t);
      out << t << "," << a << "," << 0.5 * a << "\n";
    }
    return folder_ / "record.csv";
  }

  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("railtab_ccx_slab_" + std::to_string(getpid()));
};

StructureModel laid(ImportParameters parameters) {
  if (!parameters.damping.mass_factor && !parameters.damping.stiffness_factor) parameters.damping.ratio = 0.01;
  TrackParameters track;
  track.length_before = track.length_after = 24.0;
  return build_track_on_import(track, parameters);
}

/// Departure from a unit translation along z of the deck's midspan where all supports move so at rest.
double departure(const StructureModel& model) {
  Eigen::VectorXd alike = Eigen::VectorXd::Zero(model.supports.columns());
  for (Eigen::Index k = 1; k < alike.size(); k += 2) alike[k] = 1.0;
  const SparseLdlt factor = stiffness_factor(model.stiffness);
  const Eigen::VectorXd u = factor.solve(-(model.supports.stiffness * alike));
  return std::abs(u[model.nodes.front().dof[2]] - 1.0);
}

TEST_F(CalculixSlab, SupportsCarryItWithAnyDamping) {
  const ImportParameters slab = assembled("slab");
  const StructureModel by_ratio = laid(slab);
  EXPECT_FALSE(by_ratio.supports.alike_only()) << by_ratio.supports.beyond;
  EXPECT_LT(departure(by_ratio), 1e-9);
  for (const auto& [a, b] : {std::pair{0.5, 0.0}, {0.0, 1e-3}, {0.5, 1e-3}}) {
    ImportParameters rayleigh = slab;
    rayleigh.damping.mass_factor = a;
    rayleigh.damping.stiffness_factor = b;
    const StructureModel model = laid(rayleigh);
    EXPECT_FALSE(model.supports.alike_only()) << a << " " << b << ": " << model.supports.beyond;
  }
}

TEST_F(CalculixSlab, TenDigitsAreEnough) {
  const ImportParameters slab = assembled("slab");
  const StructureModel ten = laid(rounded(slab, 10));
  EXPECT_FALSE(ten.supports.alike_only()) << ten.supports.beyond;
  const StructureModel seven = laid(rounded(slab, 7));
  EXPECT_NE(seven.supports.beyond.find("few digits"), std::string::npos) << seven.supports.beyond;
  std::printf("midspan stays behind by %.1e with 14 digits, %.1e with 10\n", departure(laid(slab)), departure(ten));
  EXPECT_LT(departure(ten), 1e-5);
}

// One node at midspan held by the model itself.
TEST_F(CalculixSlab, OnOtherGroundTooItIsRejected) {
  const StructureModel held = laid(assembled("held", "*BOUNDARY\nMIDDLE, 3, 3\n"));
  EXPECT_TRUE(held.supports.alike_only());
  EXPECT_NE(held.supports.beyond.find("stands on more than its [[support]]s"), std::string::npos)
      << held.supports.beyond;
  EXPECT_NE(held.supports.beyond.find("along z stays behind by"), std::string::npos) << held.supports.beyond;
  // the missing support makes up for it where all move alike
  EXPECT_LT(departure(held), 1e-9);
}

/// Lateral and vertical motion of the deck at midspan while a coach comes and the ground shakes.
std::vector<double> deck_motion(const SceneParameters& scene) {
  std::vector<double> motion;
  RunObserver observer;
  observer.record = [&](const StepRecord& step) {
    for (const std::size_t k : {1U, 2U}) motion.push_back(step.nodes.front().displacement[k]);
  };
  const RunSummary summary = run_scene(scene, observer);
  EXPECT_TRUE(summary.complete) << summary.message;
  return motion;
}

TEST_F(CalculixSlab, StationsWithOneRecordAreGroundThatMovesAlike) {
  SceneParameters scene;
  scene.track_kind = TrackKind::flexible;
  scene.contact.mode = ContactMode::online;
  scene.contact.creep_law = "polach";
  scene.contact.normal = NormalContact::rigid;
  scene.train.start = -3.0;
  scene.track.length_before = scene.track.length_after = 48.0;
  scene.integration.time_step = 2e-3;
  scene.integration.duration = 0.3;
  scene.structure = assembled("slab");
  scene.structure.damping.ratio = 0.01;
  scene.ground_motion.resize(1);
  scene.ground_motion[0].file = record();
  const std::vector<double> alike = deck_motion(scene);
  SceneParameters stations = scene;
  stations.ground_motion.push_back(scene.ground_motion[0]);
  stations.ground_motion[1].x = 16.0;
  const std::vector<double> apart = deck_motion(stations);
  SceneParameters wave = scene;
  wave.ground_motion[0].wave_speed = 500.0;
  const std::vector<double> travelling = deck_motion(wave);
  ASSERT_EQ(apart.size(), alike.size());
  ASSERT_EQ(travelling.size(), alike.size());
  double size = 0.0, worst = 0.0, of_wave = 0.0;
  for (std::size_t i = 0; i < alike.size(); ++i) {
    size = std::max(size, std::abs(alike[i]));
    worst = std::max(worst, std::abs(apart[i] - alike[i]));
    of_wave = std::max(of_wave, std::abs(travelling[i] - alike[i]));
  }
  std::printf("deck moves by %.2e m; stations %.1e m off, a wave %.1e m\n", size, worst, of_wave);
  EXPECT_GT(size, 1e-3);
  EXPECT_LT(worst, 1e-9 * size);
  EXPECT_GT(of_wave, 0.01 * size) << "96 ms later at one end of the track than at the other";
}

}  // namespace
}  // namespace railtab
