// Bridges by natural modes: those of the built-in bridge, written and read again, carry a train as the bridge itself
// does, but for the static flexibility that the program says is lost.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

#include "../folder_fixture.hpp"
#include "railtab/runtime/base/dense_solvers.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/fe/mode_files.hpp"
#include "railtab/runtime/moving_load/static_deflection.hpp"
#include "railtab/runtime/moving_load/train_passage.hpp"
#include "railtab/runtime/scene/run_plan.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_run.hpp"
#include "railtab/runtime/structure/lowest_modes.hpp"
#include "railtab/runtime/structure/modal_bridge.hpp"
#include "railtab/runtime/structure/mode_output.hpp"
#include "railtab/runtime/structure/stiffness_factor.hpp"
#include "railtab/runtime/structure/structure_summary.hpp"

namespace railtab {
namespace {

/// The built-in span without its track: matrices, and the dofs of its nodes from the first support to the second.
struct BuiltIn {
  BridgeParameters span;
  StructureModel model;
  std::vector<DofIndices> dof;
  ModalBasis basis;

  explicit BuiltIn(int modes) {
    std::vector<double> inner;
    for (int i = 1; i < span.elements; ++i) inner.push_back(span.length * i / span.elements);
    Bridge bridge = beam_bridge({span}, MotionPlane::spatial, inner);
    model.supports.x = bridge.support_x;
    build_matrices(bridge.matrices, static_cast<int>(bridge.dof_x.size()), model);
    const int last = model.dofs() - 3;  // x, pitch, yaw; of the first node pitch and yaw are free
    dof.push_back({held, held, held, held, 0, 1});
    for (const StructureNode& node : bridge.nodes) dof.push_back(node.dof);
    dof.push_back({last, held, held, held, last + 1, last + 2});
    basis = lowest_modes(model.stiffness, model.mass, modes);
  }
  /// Deflection of the midspan under a unit force there [m/N].
  [[nodiscard]] double flexibility() const {
    Eigen::VectorXd load = Eigen::VectorXd::Zero(model.dofs());
    const int middle = dof[dof.size() / 2][2];
    load[middle] = 1.0;
    return stiffness_factor(model.stiffness).solve(load)[middle];
  }
};

/// How a program writes the modes: its unit of length and mass in SI, and the signs of its axes against railtab's.
struct Program {
  std::string units = "m-N-kg", axes = "x y z";
  double length = 1.0, mass = 1.0;
  std::array<double, 3> sign{1.0, 1.0, 1.0};
};

class ModesOfABridge : public testing::InFolder {
 protected:
  /// Writes modes.csv, shapes.csv, nodes.csv and flexibility.csv.
  void write_modes(const BuiltIn& bridge, const Program& program = {}) const {
    std::string modes = "# of the built-in span\nmode,frequency,mass,damping\n",
                shapes = "node,mode,ux,uy,uz,rotx,roty,rotz\n";
    std::string nodes;
    const double modal_mass = 7.0;  // kg: shapes of any size
    for (Eigen::Index m = 0; m < bridge.basis.omega2.size(); ++m) {
      const double omega = std::sqrt(bridge.basis.omega2[m]);
      const Eigen::VectorXd phi = bridge.basis.shape.col(m);
      modes += fmt::format("{},{:.15g},{:.15g},{:.15g}\n", m + 1, omega / (2.0 * std::numbers::pi),
                           modal_mass / program.mass, phi.dot(bridge.model.damping * phi) / (2.0 * omega));
      for (std::size_t n = 0; n < bridge.dof.size(); ++n) {
        shapes += fmt::format("{},{}", 10 + n, m + 1);
        for (std::size_t k = 0; k < 6; ++k) {
          const int row = bridge.dof[n][k];
          const double value = row < 0 ? 0.0 : std::sqrt(modal_mass) * phi[row] * program.sign[k % 3];
          shapes += fmt::format(",{:.15g}", k < 3 ? value : value * program.length);
        }
        shapes += "\n";
      }
    }
    for (std::size_t n = 0; n < bridge.dof.size(); ++n) {
      const double x = bridge.span.length * static_cast<double>(n) / bridge.span.elements, z = bridge.span.axis_depth;
      nodes += fmt::format("{} {:.15g} 0 {:.15g}\n", 10 + n, x / program.length, program.sign[2] * z / program.length);
    }
    write("modes.csv", modes);
    write("shapes.csv", shapes);
    write("nodes.csv", nodes);
    const std::size_t middle = bridge.dof.size() / 2;
    write("flexibility.csv",
          fmt::format("node,flexibility\n{},{:.15g}\n", 10 + middle, bridge.flexibility() * program.mass));
  }

  [[nodiscard]] ImportParameters parameters(const Program& program = {}) const {
    ImportParameters import;
    import.files.format = FeFormat::modes;
    import.files.modes = folder_ / "modes.csv";
    import.files.shapes = folder_ / "shapes.csv";
    import.files.nodes = folder_ / "nodes.csv";
    import.frame = {program.units, program.axes, { { 0.0, 0.0, 0.0 } }};
    import.deck.from = {-1e6, -1e6, -1e6};
    import.deck.to = {1e6, 1e6, 1e6};
    return import;
  }

  [[nodiscard]] std::string message(const ImportParameters& import) const {
    try {
      static_cast<void>(modal_bridge(import));
    } catch (const InputError& wrong) {
      std::string what = wrong.what();
      for (std::size_t at; (at = what.find(folder_.string() + "/")) != std::string::npos;)
        what.erase(at, folder_.string().size() + 1);
      return what;
    }
    return "no error";
  }

  [[nodiscard]] SceneParameters scene(const std::string& bridge) const {
    write("s.toml",
          "[train]\nvehicle = \"manchester-coach\"\nspeed_kmh = 200\nstart = -2.0\n"
          "[contact]\nnormal = \"rigid\"\n[track]\nlength_before = 30\nlength_after = 24\n"
          "[integration]\ntime_step = 1e-3\nduration = 0.9\n" +
              bridge);
    return read_scene(folder_ / "s.toml");
  }
  /// Vertical displacement of the midspan over the run [m].
  [[nodiscard]] std::vector<double> midspan(const std::string& bridge) const { return midspan_of(scene(bridge)); }
  [[nodiscard]] static std::vector<double> midspan_of(const SceneParameters& parsed) {
    const VsiModel model = build_model(parsed);
    EXPECT_EQ(model.structure->nodes.front().name, "deck-midspan-1");
    std::vector<double> history;
    RunObserver observer;
    observer.record = [&](const StepRecord& record) { history.push_back(record.nodes.front().displacement[2]); };
    EXPECT_TRUE(run_scene(parsed, model, observer).complete);
    return history;
  }
};

const std::string by_modes =
    "[structure]\nformat = \"modes\"\nmode_table = \"modes.csv\"\nmode_shapes = \"shapes.csv\"\nnodes = \"nodes.csv\"\n"
    "axes = \"x y z\"\nstatic_flexibility = \"flexibility.csv\"\ndeck.from = [0, 0, 1.9]\ndeck.to = [32, 0, 1.9]\n";

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

TEST_F(ModesOfABridge, CarryATrainAsTheBridgeWithinTheStatedLoss) {
  const std::vector<double> whole = midspan("[[bridge]]\n");
  const double peak = largest(whole);
  ASSERT_GT(peak, 1e-4);
  double error_before = INFINITY;
  for (const int modes : {2, 12, 40}) {
    write_modes(BuiltIn(modes));
    ImportParameters import = parameters();
    import.files.flexibility = folder_ / "flexibility.csv";
    const double lost = static_flexibility(read_modal_structure(import), import).front().lost();
    const std::vector<double> reduced = midspan(by_modes);
    ASSERT_EQ(reduced.size(), whole.size());
    double error = 0.0;
    for (std::size_t i = 0; i < whole.size(); ++i) error = std::max(error, std::abs(reduced[i] - whole[i]));
    constexpr double newton = 1e-5;  // of the contact forces' tolerance
    EXPECT_LT(error, error_before) << modes << " modes";
    if (modes == 2) {  // one bending mode: the second one's own vibration is missing too
      EXPECT_GT(error / peak, 0.5 * lost);
      EXPECT_LT(error / peak, 1.5 * lost);
    } else {
      EXPECT_LE(error / peak, lost + newton) << modes << " modes";
    }
    error_before = error;
    RecordProperty(fmt::format("modes_{}", modes), fmt::format("lost {:.3e} error {:.3e}", lost, error / peak));
  }
}

/// M, K of a bridge, dense.
Eigen::MatrixXd dense(const std::vector<Eigen::Triplet<double>>& entries, Eigen::Index dofs) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(dofs, dofs);
  for (const auto& e : entries) matrix(e.row(), e.col()) += e.value();
  return matrix;
}

TEST_F(ModesOfABridge, ItsFrequenciesAndDampingAreThoseOfTheTable) {
  const BuiltIn built(12);
  write_modes(built);
  ImportParameters import = parameters();
  import.report = {8.0, 16.0, 24.0};
  const Bridge bridge = modal_bridge(import);
  const CholeskyFactor mass(dense(bridge.matrices.mass, 12));
  const auto of_unit_mass = [&](const Eigen::MatrixXd& A) { return mass.solve_L(mass.solve_L(A).transpose()); };
  const SymmetricSpectrum modes = symmetric_spectrum(of_unit_mass(dense(bridge.matrices.stiffness, 12)));
  const Eigen::MatrixXd C =
      modes.vectors.transpose() * of_unit_mass(dense(bridge.matrices.damping, 12)) * modes.vectors;
  for (Eigen::Index m = 0; m < 12; ++m) {
    const Eigen::VectorXd phi = built.basis.shape.col(m);
    EXPECT_NEAR(modes.values[m], built.basis.omega2[m], 1e-9 * built.basis.omega2[m]);
    EXPECT_NEAR(C(m, m), phi.dot(built.model.damping * phi), 1e-6 * C(m, m));
  }
}

TEST_F(ModesOfABridge, ReportedMotionsAreDegreesOfFreedom) {
  write_modes(BuiltIn(12));
  ImportParameters import = parameters();
  import.report = {8.0, 16.0};
  const Bridge bridge = modal_bridge(import);
  ASSERT_EQ(bridge.nodes.size(), 2u);
  for (const StructureNode& node : bridge.nodes) {
    const std::optional<DeckAttachment> at = bridge.attach(node.x, 0.0, 1.9);
    ASSERT_TRUE(at);
    for (std::size_t k = 0; k < at->dof.size(); ++k) {
      EXPECT_NEAR(at->rows(2, static_cast<Eigen::Index>(k)), at->dof[k] == node.dof[2] ? 1.0 : 0.0, 1e-9);
    }
  }
  EXPECT_EQ(bridge.nodes[0].name, "deck-8");
  EXPECT_EQ(bridge.nodes[1].z, 1.9);
  EXPECT_FALSE(bridge.attach(-0.5, 0.0, 1.9)) << "the track before the bridge stands on the ground";
}

TEST_F(ModesOfABridge, UnitsAndAxesOfTheProgramMakeNoDifference) {
  const BuiltIn built(8);
  write_modes(built);
  const Bridge own = modal_bridge(parameters());
  const Program program{"mm-N-t", "x -y -z", 1e-3, 1e3, {1.0, -1.0, -1.0}};
  write_modes(built, program);
  ImportParameters import = parameters(program);
  import.files.flexibility = folder_ / "flexibility.csv";
  const Bridge other = modal_bridge(import);
  const Eigen::MatrixXd K = dense(own.matrices.stiffness, 8), M = dense(own.matrices.mass, 8);
  EXPECT_TRUE(dense(other.matrices.stiffness, 8).isApprox(K, 1e-9));
  EXPECT_TRUE(dense(other.matrices.mass, 8).isApprox(M, 1e-9));
  const DeckAttachment a = *own.attach(5.3, 0.75, 0.4), b = *other.attach(5.3, 0.75, 0.4);
  EXPECT_TRUE(b.rows.isApprox(a.rows, 1e-9));
  EXPECT_TRUE(b.arm.isApprox(a.arm, 1e-9));
  EXPECT_NEAR(own.end, other.end, 1e-9);
  const StaticFlexibility middle = static_flexibility(read_modal_structure(import), import).front();
  EXPECT_NEAR(*middle.whole, built.flexibility(), 1e-12 * built.flexibility());
}

TEST_F(ModesOfABridge, ThePlanStatesWhatIsLost) {
  write_modes(BuiltIn(12));
  const RunPlan plan = plan_run(scene(by_modes), {});
  const std::string all = fmt::format("{}", fmt::join(plan.left_out, "\n"));
  EXPECT_NE(all.find("static flexibility beyond the modes: "), std::string::npos) << all;
  EXPECT_NE(all.find(" % at x = 16 m"), std::string::npos) << all;
  EXPECT_NE(all.find("the modes are orthogonal"), std::string::npos) << all;
  const auto warned = [](const RunPlan& of) {
    return fmt::format("{}", fmt::join(of.warnings, "\n")).find("of the static flexibility") != std::string::npos;
  };
  EXPECT_FALSE(warned(plan));
  const BuiltIn bridge(12);
  write("flexibility.csv",
        fmt::format("node,flexibility\n{},{:.15g}\n", 10 + bridge.dof.size() / 2, 1.2 * bridge.flexibility()));
  EXPECT_TRUE(warned(plan_run(scene(by_modes), {})));
  std::string unknown = by_modes;
  unknown.erase(unknown.find("static_flexibility"), std::string("static_flexibility = \"flexibility.csv\"\n").size());
  const std::string other = fmt::format("{}", fmt::join(plan_run(scene(unknown), {}).left_out, "\n"));
  EXPECT_NE(other.find("how much is not known without structure.static_flexibility; the 12 modes have "),
            std::string::npos)
      << other;
}

/// Two spans, whose axis has two nodes at the pier, as vsi structure writes and reads them.
TEST_F(ModesOfABridge, WhatIsWrittenIsReadAgain) {
  BridgeParameters span;
  span.length = 20.0;
  span.elements = 10;
  span.track_offset = 1.5;
  const ModalStructure written = modes_at_deck({span, span}, 30);
  const std::string section = railtab::write_modes(written, folder_ / "two");
  const SceneParameters parsed = scene(section);
  const ModalStructure read = read_modal_structure(parsed.structure);
  ASSERT_EQ(read.at.nodes.size(), 22u);
  EXPECT_TRUE(read.omega.isApprox(written.omega, 1e-12));
  EXPECT_TRUE(read.damping.isApprox(written.damping, 1e-12));
  EXPECT_TRUE(read.shape.isApprox(written.shape, 1e-12));
  EXPECT_EQ(read.at.nodes.at(1).position[1], -1.5);
  const Bridge bridge = modal_bridge(parsed.structure);
  EXPECT_NEAR(bridge.end, 40.0, 1e-12);
  // a span alone: a force on the one does not move the other
  const Eigen::MatrixXd K = dense(bridge.matrices.stiffness, 30);
  const auto at = [&](double x) -> Eigen::VectorXd { return bridge.attach(x, 0.0, 1.9)->rows.row(2); };
  const Eigen::VectorXd moved = dense_solution(K, at(10.0));
  const double own = at(10.0).dot(moved);
  const double other = at(30.0).dot(moved);
  EXPECT_NEAR(own, std::pow(20.0, 3) / (48.0 * span.E * span.Iy), 0.02 * own);
  EXPECT_LT(std::abs(other), 1e-6 * own);
}

/// Damping in proportion to the stiffness grows with the frequency, beyond what files of modes hold.
TEST_F(ModesOfABridge, ModesAreWrittenBelowCriticalDamping) {
  BridgeParameters span;
  span.length = 20.0;
  span.elements = 10;
  span.damping_ratio = 0.15;
  const ModalStructure written = modes_at_deck({span}, 30);
  EXPECT_GT(written.omega.size(), 5);
  EXPECT_LT(written.omega.size(), 30);
  EXPECT_EQ(written.shape.cols(), written.omega.size());
  EXPECT_LE(written.damping.maxCoeff(), most_damping_ratio);
  const ModalStructure read = read_modal_structure(scene(railtab::write_modes(written, folder_ / "damped")).structure);
  EXPECT_TRUE(read.damping.isApprox(written.damping, 1e-12));
  EXPECT_NEAR(read.whole_flexibility.begin()->second / written.whole_flexibility.begin()->second, 1.0, 1e-12);
}

/// The demo's train and bridge on wheels that follow the rails, and the same on the modes that vsi structure exports.
TEST_F(ModesOfABridge, TheDemosBridgeExportedAndImportedKeepsItsMidspanHistory) {
  const std::filesystem::path examples = RAILTAB_SOURCE_DIR "/docs/examples";
  std::filesystem::copy(examples / "demo_irregularity.csv", folder_ / "demo_irregularity.csv");
  std::ifstream stream(examples / "demo.toml");
  std::string demo((std::istreambuf_iterator<char>(stream)), {});
  const auto replace = [&](const std::string& begin, const std::string& end, const std::string& by) {
    const std::size_t at = demo.find(begin);
    ASSERT_NE(at, std::string::npos) << begin;
    demo.replace(at, demo.find(end, at) - at, by);
  };
  replace("[contact]", "[track]", "[contact]\nnormal = \"rigid\"\n\n");
  replace("[integration]", "\n", "[integration]\nduration = 1.95");  // of both, whose tracks end at other sleepers
  const auto history = [&](const std::string& text) {
    write("demo.toml", text);
    return midspan_of(read_scene(folder_ / "demo.toml"));
  };
  const std::vector<double> whole = history(demo);
  const double peak = largest(whole);
  ASSERT_GT(peak, 1e-4);
  const std::vector<BridgeParameters> spans = read_scene(folder_ / "demo.toml").spans;
  replace("[[bridge]]", "[irregularity]", "SECTION");
  for (const int modes : {12, 40}) {
    const std::string section = railtab::write_modes(modes_at_deck(spans, modes), folder_ / "demo");
    std::string by_its_modes = demo;
    by_its_modes.replace(by_its_modes.find("SECTION"), 7, section + "\n");
    const std::vector<double> reduced = history(by_its_modes);
    const ImportParameters import = read_scene(folder_ / "demo.toml").structure;
    const double lost = static_flexibility(read_modal_structure(import), import).front().lost();
    ASSERT_EQ(reduced.size(), whole.size());
    double error = 0.0;
    for (std::size_t i = 0; i < whole.size(); ++i) error = std::max(error, std::abs(reduced[i] - whole[i]));
    constexpr double newton = 1e-5;  // of the contact forces' tolerance
    std::printf("%d modes: midspan %.1e of %.2e m off, %.1e stated as lost\n", modes, error / peak, peak, lost);
    EXPECT_LE(error / peak, lost + newton) << modes << " modes";
    EXPECT_GT(error, 0.0) << "the same matrices have been compared";
  }
}

/// By one axle at the middle that moves slowly: the deflection of all modes, and their damping.
TEST_F(ModesOfABridge, TheyCarryAxleLoads) {
  const BuiltIn built(40);
  write_modes(built);
  const ModalDeck own = simply_supported_deck(built.span), imported = imported_deck(parameters());
  AxleTrain axle;
  axle.behind = {0.0};
  axle.load = {100e3};
  const double at_rest = largest_static_deflection(own, axle).value;
  EXPECT_NEAR(largest_static_deflection(imported, axle).value, at_rest, 2e-3 * at_rest);
  const StructureSummary summary = summarise(read_modal_structure(parameters()), 3);
  EXPECT_EQ(summary.dofs, 40);
  ASSERT_EQ(summary.frequencies.size(), 3u);
  EXPECT_NEAR(summary.frequencies[0], std::sqrt(built.basis.omega2[0]) / (2.0 * std::numbers::pi), 1e-9);
}

TEST_F(ModesOfABridge, WrongFilesAreNamed) {
  write_modes(BuiltIn(2));
  const auto with = [&](const std::string& name, const std::string& text) {
    write_modes(BuiltIn(2));
    write(name, text);
    return message(parameters());
  };
  EXPECT_EQ(with("modes.csv", "mode,frequency,mass,damping\n1,5,0,0.01\n"),
            "modes.csv:2: found modal mass 0, expected 1e-12 to 1e+15, in the model's unit of mass");
  EXPECT_EQ(with("modes.csv", "mode,frequency,mass,damping\n1,-5,1,0.01\n"),
            "modes.csv:2: found frequency -5, expected 0.001 to 100000 Hz");
  EXPECT_NE(with("modes.csv", "mode,frequency,mass,damping\n1,nan,1,0.01\n").find("modes.csv:2"), std::string::npos);
  EXPECT_EQ(with("modes.csv", "mode,frequency,mass,damping\n1,5,1,0.01\n1,6,1,0.01\n"),
            "modes.csv:3: found mode 1 again, expected each once, first in modes.csv:2");
  EXPECT_EQ(with("modes.csv", "mode,frequency,mass,damping\n1,5,1,0.01\n3,6,1,0.01\n"),
            "shapes.csv: found node 10 without mode 3, expected each node in all 2 modes of structure.mode_table");
  EXPECT_NE(with("modes.csv", "mode,frequency,mass\n1,5,1\n2,6,1\n").find("found modes without damping"),
            std::string::npos);
  EXPECT_NE(with("shapes.csv", "mode,node,rotx\n1,10,0\n").find("found no column ux, uy or uz"), std::string::npos);
  EXPECT_NE(
      with("shapes.csv", "mode,node,uz\n1,99,0\n2,99,0\n").find("found node 99, expected a node of structure.nodes"),
      std::string::npos);
  EXPECT_NE(with("shapes.csv", "mode,node,uz\n1,10,0\n1,10,0\n").find("shapes.csv:3: found node 10 in mode 1 again"),
            std::string::npos);
  EXPECT_NE(with("shapes.csv", "mode,node,ux\n1,10,0\n2,10,0\n").find("no vertical shape"), std::string::npos);
}

TEST_F(ModesOfABridge, ImpossibleDemandsAreNamed) {
  const BuiltIn built(2);
  write_modes(built);
  ImportParameters import = parameters();
  import.report = {4.0, 8.0, 12.0};
  EXPECT_NE(message(import).find("structure.report: found 3 positions with 2 modes"), std::string::npos)
      << message(import);
  import = parameters();
  import.damping.ratio = 0.01;
  EXPECT_NE(message(import).find("damping in the mode table and by another key"), std::string::npos);
  import = parameters();
  import.files.flexibility = write("soft.csv", "node,flexibility\n26,1e-12\n");
  EXPECT_NE(message(import).find("soft.csv: node 26: found 1e-12 m/N, and "), std::string::npos) << message(import);
  const auto rejected = [&](const std::string& text) -> std::string {
    try {
      static_cast<void>(scene(text));
    } catch (const InputError& wrong) {
      return wrong.what();
    }
    return "no error";
  };
  EXPECT_NE(rejected(by_modes + "[[ground_motion]]\nfile = \"modes.csv\"\n").find("supports are not known"),
            std::string::npos);
  EXPECT_NE(rejected(by_modes + "stiffness = \"modes.csv\"\n").find("structure.stiffness"), std::string::npos);
  EXPECT_NE(rejected(by_modes + "[[bridge]]\n").find("structure.format: found a [[bridge]] too"), std::string::npos);
}

}  // namespace
}  // namespace railtab
