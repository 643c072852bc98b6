// An imported bridge under railtab's own track, against the built-in one that it was written from.

#include "railtab/runtime/structure/imported_bridge.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <tuple>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/scene/scene_run.hpp"
#include "railtab/runtime/structure/bridge.hpp"
#include "railtab/runtime/structure/bridge_damping.hpp"
#include "railtab/runtime/structure/deck_attachment.hpp"
#include "railtab/runtime/structure/deck_nodes.hpp"
#include "railtab/runtime/structure/section_forces.hpp"
#include "railtab/runtime/structure/stiffness_factor.hpp"
#include "railtab/runtime/structure/structure_summary.hpp"

namespace railtab {
namespace {

const std::filesystem::path folder =
    std::filesystem::temp_directory_path() / ("railtab_imported_bridge_" + std::to_string(getpid()));
const struct RemoveFolder {
  ~RemoveFolder() { std::filesystem::remove_all(folder); }
} remove_folder;

// One span of six elements, its axis 2 m below the rail-head tops and 0.3 m left of the track's centre.
BridgeParameters span() {
  BridgeParameters p;
  p.length = 24.0;
  p.elements = 6;
  p.axis_depth = 2.0;
  p.track_offset = 0.3;
  p.damping_ratio = 0.02;
  return p;
}

// The span as a program with axes x forward, y up, z right and units mm, N, t would have it: rows in an order of its
// own, held motions left out or those of the supports kept, matrices in Matrix Market or Harwell-Boeing.
enum class SupportRows { left_out, kept };

class WrittenSpan {
 public:
  explicit WrittenSpan(FeFormat format, SupportRows support_rows = SupportRows::left_out) {
    std::filesystem::create_directories(folder);
    const Bridge bridge = beam_bridge({span()}, MotionPlane::spatial);
    const int unknowns = static_cast<int>(bridge.dof_x.size());
    const bool kept = support_rows == SupportRows::kept;
    const int n = unknowns + (kept ? 4 : 0);
    const auto dense = [&](const std::vector<Eigen::Triplet<double>>& entries) {
      Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
      for (const auto& e : entries) {
        if (!kept && (e.row() < 0 || e.col() < 0)) continue;
        const auto place = [&](int dof) { return dof < 0 ? unknowns + support_column(dof) : dof; };
        matrix(place(e.row()), place(e.col())) += e.value();
      }
      return matrix;
    };
    // what the rows of the built-in span are: nodes in turn, x y z roll held at the first, y z roll at the last
    std::vector<FeRow> rows;
    for (int node = 0; node <= 6; ++node) {
      for (int k = 0; k < 6; ++k) {
        if ((node == 0 && k < 4) || (node == 6 && k >= 1 && k < 4)) continue;
        rows.push_back({node, k});
      }
    }
    if (kept) rows.insert(rows.end(), {{0, 1}, {0, 2}, {6, 1}, {6, 2}});
    EXPECT_EQ(static_cast<int>(rows.size()), n);
    std::vector<int> order(rows.size());
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), std::minstd_rand(3));
    // railtab's x, y, z are the program's x, z, -y: railtab's motion k is the program's `axis[k]`, with a sign
    const std::array<int, 3> axis{0, 2, 1};
    const std::array<double, 3> sign{1, 1, -1};
    const Eigen::MatrixXd K = dense(bridge.matrices.stiffness), M = dense(bridge.matrices.mass);
    Eigen::MatrixXd C = dense(bridge.matrices.damping);
    if (kept) {  // as programs have Rayleigh's: the part in proportion to the mass acts against a point at rest
      const BeamSection section{34.5e9, 8.8889, 10.947, 86.216, 0, 33.9e3, 0};
      const RayleighDamping rayleigh = rayleigh_damping(0.02, simply_supported_frequency(section, 24.0, 1),
                                                        simply_supported_frequency(section, 24.0, 2));
      C = rayleigh.mass_factor * M + rayleigh.stiffness_factor * K;
    }
    Eigen::MatrixXd T = Eigen::MatrixXd::Zero(n, n);  // q_railtab = T q_program
    std::string dofs = format == FeFormat::ansys ? " Matrix Eqn   Node   DOF\n" : "row,node,motion\n";
    for (int i = 0; i < n; ++i) {
      const FeRow row = rows[static_cast<std::size_t>(order[static_cast<std::size_t>(i)])];
      const auto k = static_cast<std::size_t>(row.motion % 3);
      T(order[static_cast<std::size_t>(i)], i) = sign[k] * (row.motion < 3 ? 1e-3 : 1.0);
      const bool turns = row.motion >= 3;
      const std::string letter(1, static_cast<char>((format == FeFormat::ansys ? 'X' : 'x') + axis[k]));
      const std::string motion =
          format == FeFormat::ansys ? (turns ? "ROT" : "U") + letter : (turns ? "rot" : "") + letter;
      const char* const comma = format == FeFormat::ansys ? "  " : ",";
      dofs += std::to_string(i + 1) + comma + std::to_string(row.node + 101) + comma + motion + "\n";
    }
    std::string nodes = "# number, x, y (up), z\n";
    for (int node = 0; node <= 6; ++node)
      nodes += std::to_string(node + 101) + ", " + std::to_string(4000 * node) + ", 0, 0\n";
    parameters.files = {format,
                        write(format, "m", 1e3 * T.transpose() * M * T),
                        write(format, "k", 1e3 * T.transpose() * K * T),
                        write(format, "c", 1e3 * T.transpose() * C * T),
                        folder / "dofs",
                        folder / "nodes"};
    std::ofstream(folder / "dofs") << dofs;
    std::ofstream(folder / "nodes") << nodes;
    parameters.frame = {"mm-N-t", "x z -y", {{0.0, 2000.0, 300.0}}};
    parameters.deck.from = {0, 0, 0};
    parameters.deck.to = {24000, 0, 0};
    if (!kept) return;
    for (const double x : {0.0, 24000.0}) {
      FeSupport support;
      support.nodes.from = support.nodes.to = {x, 0, 0};
      support.holds = {"y", "z"};
      parameters.supports.push_back(support);
    }
  }
  ImportParameters parameters;

 private:
  static std::filesystem::path write(FeFormat format, const std::string& name, const Eigen::MatrixXd& matrix) {
    const auto file = folder / name;
    std::FILE* out = std::fopen(file.c_str(), "w");
    const int n = static_cast<int>(matrix.rows());
    std::string pointers, indices, values;
    char text[64];
    int count = 0;
    for (int j = 0; j < n; ++j) {
      std::snprintf(text, sizeof text, "%14d\n", count + 1);
      pointers += text;
      for (int i = j; i < n; ++i) {
        if (matrix(i, j) == 0.0) continue;
        ++count;
        if (format == FeFormat::ansys) {
          std::snprintf(text, sizeof text, "%14d\n", i + 1);
          indices += text;
          std::snprintf(text, sizeof text, "%25.16E\n", matrix(i, j));
        } else {
          std::snprintf(text, sizeof text, "%d %d %.17g\n", i + 1, j + 1, matrix(i, j));
        }
        values += text;
      }
    }
    if (format == FeFormat::ansys) {
      std::fprintf(out, "%-72s%-8s\n%14d%14d%14d%14d%14d\n%-14s%14d%14d%14d%14d\n%-16s%-16s%-20s\n", "A span", "KEY", 0,
                   0, 0, 0, 0, "RSA", n, n, count, 0, "(1I14)", "(1I14)", "(1E25.16)");
      std::fprintf(out, "%s%14d\n%s%s", pointers.c_str(), count + 1, indices.c_str(), values.c_str());
    } else {
      std::fprintf(out, "%%%%MatrixMarket matrix coordinate real symmetric\n%d %d %d\n%s", n, n, count, values.c_str());
    }
    std::fclose(out);
    return file;
  }
};

TrackParameters short_track() {
  TrackParameters track;
  track.length_before = track.length_after = 6.0;
  return track;
}

class ImportedSpan : public ::testing::TestWithParam<FeFormat> {};

// The number of unknowns per node is that of the built-in model, and those of a node stand at one place.
TEST_P(ImportedSpan, NodesOfTheMeshAreTheBuiltInOnes) {
  TrackParameters track = short_track();
  track.longitudinal = LongitudinalMotion::kept;
  const auto unknowns_of_nodes = [](const StructureModel& model) {
    EXPECT_EQ(model.dof_node.size(), static_cast<std::size_t>(model.dofs()));
    std::map<int, int> count;
    std::map<int, double> place;
    for (std::size_t dof = 0; dof < model.dof_node.size(); ++dof) {
      ++count[model.dof_node[dof]];
      EXPECT_EQ(place.try_emplace(model.dof_node[dof], model.dof_x[dof]).first->second, model.dof_x[dof]) << dof;
    }
    std::vector<int> sizes;
    for (const auto& [node, size] : count) sizes.push_back(size);
    std::sort(sizes.begin(), sizes.end());
    return sizes;
  };
  const WrittenSpan written(GetParam());
  EXPECT_EQ(unknowns_of_nodes(build_track_on_import(track, written.parameters)),
            unknowns_of_nodes(build_track_bridge(track, {span()})));
}

// The vertical and lateral compliance of the rail head over the whole model, from both: signs, units, axes, the order
// of the rows, the arms and the damping all enter.
TEST_P(ImportedSpan, UnderRailtabsTrackIsTheBuiltInOne) {
  const WrittenSpan written(GetParam());
  TrackParameters track = short_track();
  track.longitudinal = LongitudinalMotion::kept;
  const StructureModel imported = build_track_on_import(track, written.parameters);
  const StructureModel built = build_track_bridge(track, {span()});
  ASSERT_EQ(imported.dofs(), built.dofs());
  const auto response = [](const StructureModel& model) {
    const Eigen::SparseMatrix<double> dynamic = model.stiffness + 30.0 * model.damping + 900.0 * model.mass;
    const SparseLdlt factor = stiffness_factor(dynamic);
    Eigen::MatrixXd result(model.rail[0].x.size(), 12);
    for (int k = 0; k < 6; ++k) {
      Eigen::VectorXd load = Eigen::VectorXd::Zero(model.dofs());
      load[model.rail[1].dof[30][static_cast<std::size_t>(k)]] = 1.0;
      const Eigen::VectorXd u = factor.solve(load);
      for (std::size_t n = 1; n + 1 < model.rail[0].x.size(); ++n) {
        result(static_cast<Eigen::Index>(n), 2 * k) = u[model.rail[0].dof[n][2]];
        result(static_cast<Eigen::Index>(n), 2 * k + 1) = u[model.rail[0].dof[n][1]];
      }
      result.row(0).setZero();
      result.bottomRows(1).setZero();
    }
    return result;
  };
  const Eigen::MatrixXd a = response(imported), b = response(built);
  for (Eigen::Index k = 0; k < b.cols(); ++k) {
    // a pair that symmetry keeps apart has only rounding
    EXPECT_LT((a.col(k) - b.col(k)).norm(), 1e-8 * b.col(k).norm() + 1e-20) << k;
  }
  ASSERT_EQ(imported.nodes.size(), built.nodes.size());
  for (std::size_t n = 0; n < built.nodes.size(); ++n) {
    EXPECT_EQ(imported.nodes[n].name, built.nodes[n].name);
    EXPECT_DOUBLE_EQ(imported.nodes[n].x, built.nodes[n].x);
  }
}

TEST_P(ImportedSpan, HasTheMassAndFrequenciesOfTheBuiltInOne) {
  const WrittenSpan written(GetParam());
  const FeStructure structure = read_fe_structure(written.parameters.files, written.parameters.frame);
  const StructureSummary imported = summarise(structure, written.parameters.damping, 6);
  const StructureSummary built = summarise({span()}, 6);
  EXPECT_TRUE(imported.free.empty());
  // without what moves with the held nodes at both ends: 2·264/420 of one of six elements
  EXPECT_NEAR(imported.mass[2], (1.0 - 2.0 * 264.0 / 420.0 / 6.0) * built.mass[2], 1e-9 * built.mass[2]);
  ASSERT_EQ(imported.frequencies.size(), 6u);
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_NEAR(imported.frequencies[k], built.frequencies[k], 1e-8 * built.frequencies[k]);
    EXPECT_NEAR(imported.damping_ratios[k], built.damping_ratios[k], 1e-8);
  }
  const double first = simply_supported_frequency({34.5e9, 8.8889, 10.947, 86.216, 0, 33.9e3, 0}, 24.0, 1);
  EXPECT_NEAR(built.frequencies[0], first / (2 * std::numbers::pi), 1e-4 * first);
}

// The rails' answer to motion of the supports, one by one where their rows are there and of all alike where they are
// not: stiffness, damping and mass of the supports, signs and units enter.
Eigen::MatrixXd answer_to_supports(const StructureModel& model, double with_mass) {
  const Eigen::SparseMatrix<double> dynamic = model.stiffness + 30.0 * model.damping + 900.0 * model.mass;
  const StructureSupports& s = model.supports;
  const Eigen::SparseMatrix<double> load = s.stiffness + 30.0 * s.damping + with_mass * 900.0 * s.mass;
  const Eigen::MatrixXd u = stiffness_factor(dynamic).solve_columns(-Eigen::MatrixXd(load));
  const RailLine& rail = model.rail[1];
  Eigen::MatrixXd result(2 * rail.x.size(), u.cols());
  for (std::size_t n = 0; n < rail.x.size(); ++n) {
    for (int k = 0; k < 2; ++k)
      result.row(static_cast<Eigen::Index>(2 * n) + k) = u.row(rail.dof[n][static_cast<std::size_t>(k + 1)]);
  }
  return result;
}

TEST_P(ImportedSpan, OnMovingSupportsIsTheBuiltInOne) {
  const StructureModel built = build_track_bridge(short_track(), {span()});
  const StructureModel imported =
      build_track_on_import(short_track(), WrittenSpan(GetParam(), SupportRows::kept).parameters);
  EXPECT_FALSE(imported.supports.alike_only());
  ASSERT_EQ(imported.supports.x.size(), built.supports.x.size());
  for (std::size_t i = 0; i < built.supports.x.size(); ++i)
    EXPECT_NEAR(imported.supports.x[i], built.supports.x[i], 1e-9);
  const Eigen::MatrixXd a = answer_to_supports(imported, 1.0), b = answer_to_supports(built, 1.0);
  EXPECT_GT(b.leftCols<4>().colwise().norm().minCoeff(), 1e-3) << "the bridge's own supports";
  for (Eigen::Index k = 0; k < b.cols(); ++k) {
    // a translation that symmetry keeps apart has only rounding
    EXPECT_LT((a.col(k) - b.col(k)).norm(), 1e-8 * b.norm() / std::sqrt(b.cols())) << k;
  }
}

TEST_P(ImportedSpan, WithoutItsSupportsRowsMovesAlike) {
  const StructureModel built = build_track_bridge(short_track(), {span()});
  const StructureModel imported = build_track_on_import(short_track(), WrittenSpan(GetParam()).parameters);
  EXPECT_TRUE(imported.supports.alike_only());
  // The mass between held and free motions of the last elements is not known.
  const Eigen::MatrixXd a = answer_to_supports(imported, 0.0), b = answer_to_supports(built, 0.0);
  for (int component = 0; component < 2; ++component) {
    Eigen::VectorXd of_imported = Eigen::VectorXd::Zero(a.rows()), of_built = of_imported;
    for (Eigen::Index k = component; k < a.cols(); k += 2) of_imported += a.col(k);
    for (Eigen::Index k = component; k < b.cols(); k += 2) of_built += b.col(k);
    EXPECT_GT(of_built.norm(), 1.0);
    EXPECT_LT((of_imported - of_built).norm(), 1e-8 * of_built.norm()) << component;
  }
}

// Under a pull at the free end the moment about an axis half a metre above the beam's is half the force. A support that
// sinks bends its element where the nodes rest, and turns the whole span without forces where they do not.
TEST(ImportedBridge, SectionForcesOfAPullAndOfSinkingSupports) {
  ImportParameters parameters = WrittenSpan(FeFormat::matrix_market, SupportRows::kept).parameters;
  parameters.sections = {10.0, 2.0};
  parameters.axis_depth = span().axis_depth;
  const auto value = [&](const FeStructure& structure, const Eigen::VectorXd& u, const Eigen::VectorXd& supports) {
    std::vector<double> values;
    for (const DeckRow& row : structure.sections) {
      double& sum = values.emplace_back(0.0);
      for (const auto& [dof, factor] : row.sum) {
        sum += factor * (dof < 0 ? supports[support_column(dof)] : u[dof]);
      }
    }
    return values;
  };
  const FeStructure sunk = read_on_supports(parameters);
  ASSERT_EQ(sunk.sections.size(), 4U);
  EXPECT_EQ(sunk.sections[0].at.x, 2.0) << "in the order of x, moments first";
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(sunk.dofs()), down = Eigen::Vector4d(0.0, 1e-3, 0.0, 0.0);
  const double EI = span().E * span().Iy, l = 4.0;
  const std::vector<double> bent = value(sunk, still, down);
  EXPECT_NEAR(bent[0], 0.0, 1e-9 * EI / (l * l)) << "in the middle of the element";
  EXPECT_EQ(bent[1], 0.0);
  EXPECT_NEAR(bent[2], -12.0 * EI / (l * l * l) * 1e-3, 1e-9 * EI / (l * l * l)) << "clamped ends, one of which sinks";
  const Eigen::VectorXd turned =
      stiffness_factor(sunk.stiffness).solve(Eigen::VectorXd(-(sunk.supports.stiffness * down)));
  for (const double force : value(sunk, turned, down))
    EXPECT_NEAR(force, 0.0, 1e-9 * EI / (l * l)) << "statically determinate";

  parameters.sections = {10.0};
  parameters.axis_depth = 1.5;
  const FeStructure pulled = read_on_supports(parameters);
  Eigen::VectorXd load = Eigen::VectorXd::Zero(pulled.dofs());
  load[pulled.nodes.at(107).rows[0].front()] = 1e6;
  const std::vector<double> drawn = value(pulled, stiffness_factor(pulled.stiffness).solve(load), down);
  EXPECT_NEAR(drawn[0], 0.5e6, 1e-3);
  EXPECT_NEAR(drawn[1], 0.0, 1e-3);
}

TEST(ImportedBridge, RejectsSectionsThatAreNotExact) {
  ImportParameters parameters = WrittenSpan(FeFormat::matrix_market, SupportRows::kept).parameters;
  const auto message = [&](double x) -> std::string {
    parameters.sections = {x};
    try {
      static_cast<void>(read_on_supports(parameters));
    } catch (const InputError& wrong) {
      return wrong.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message(10.0),
            "structure.sections: found no structure.axis_depth, expected the depth about which moments are taken");
  parameters.axis_depth = 1.5;
  EXPECT_EQ(message(24.0),
            "structure.sections: found 24 m, expected between 0 and 24 m, nodes with rows of the matrices");
  EXPECT_EQ(message(-3.0),
            "structure.sections: found -3 m, expected between 0 and 24 m, nodes with rows of the matrices");
  const std::string strained = "structure.sections: x = 2 m: found elements with constrained nodes or prestress";
  EXPECT_EQ(message(2.0).substr(0, strained.size()), strained) << "x of node 101 has no row";
  parameters.axis_depth = 2.0;
  EXPECT_EQ(message(2.0), "accepted") << "in the beam's axis that row has no part in it";
  EXPECT_EQ(message(4.0), "accepted");
  parameters = WrittenSpan(FeFormat::matrix_market).parameters;
  parameters.axis_depth = 2.0;
  for (const double x : {2.0, 4.0, 20.0, 23.0}) {
    EXPECT_NE(message(x).find("with constrained nodes or prestress"), std::string::npos) << x << ", by the support";
  }
  for (const double x : {4.1, 12.0, 19.9}) EXPECT_EQ(message(x), "accepted");

  FeStructure structure = read_fe_structure(parameters.files, parameters.frame);
  structure.nodes.at(104).rows[2].push_back(0);
  EXPECT_THROW(static_cast<void>(section_forces(structure, {12.0}, 2.0)), InputError) << "expanded";
  EXPECT_NO_THROW(static_cast<void>(section_forces(structure, {6.0}, 2.0))) << "elsewhere";
  structure = read_fe_structure(parameters.files, parameters.frame);
  structure.stiffness.prune([&](int i, int j, double) {
    const auto x = row_positions(structure);
    return (x[static_cast<std::size_t>(i)] < 10.0) == (x[static_cast<std::size_t>(j)] < 10.0);
  });
  try {
    static_cast<void>(section_forces(structure, {10.0}, 2.0));
    ADD_FAILURE() << "two parts that nothing joins";
  } catch (const InputError& wrong) {
    EXPECT_NE(std::string(wrong.what()).find("x = 10 m: found no stiffness between"), std::string::npos)
        << wrong.what();
  }
}

// What supports leave free is named, with the axis it turns about, before anything is factorised.
TEST(ImportedBridge, FreeMotionsAreNamed) {
  const auto rejection = [](const ImportParameters& parameters) -> std::string {
    try {
      static_cast<void>(build_track_on_import(TrackParameters{}, parameters));
    } catch (const InputError& wrong) {
      return wrong.what();
    }
    return "no error";
  };
  ImportParameters parameters = WrittenSpan(FeFormat::matrix_market, SupportRows::kept).parameters;
  parameters.damping.ratio = 0.01;
  parameters.files.damping.clear();
  EXPECT_EQ(rejection(parameters), "no error");
  parameters.supports[1].holds = {"z"};
  EXPECT_NE(rejection(parameters)
                .find("k: found a structure that turns about z (yaw) through x = 0 m, y = -0.3 m "
                      "without resistance, expected supports against that (y of a support at another x)"),
            std::string::npos)
      << rejection(parameters);
  parameters.supports[0].holds = {"z"};
  EXPECT_NE(rejection(parameters).find("a structure that moves along y; turns about z (yaw) through x = 12 m"),
            std::string::npos)
      << rejection(parameters);
  const StructureSummary summary = summarise(read_on_supports(parameters), parameters.damping, 3);
  EXPECT_EQ(summary.free.size(), 2U);
  EXPECT_TRUE(summary.frequencies.empty());
  parameters.supports.pop_back();
  EXPECT_NE(rejection(parameters).find("turns about y (pitch) through x = 0 m, z = 2 m"), std::string::npos)
      << rejection(parameters);
}

TEST(ImportedBridge, RejectsSupportsThatDoNotFit) {
  const ImportParameters good = WrittenSpan(FeFormat::matrix_market, SupportRows::kept).parameters;
  const auto message = [&](auto&& change) -> std::string {
    ImportParameters parameters = good;
    change(parameters);
    try {
      static_cast<void>(read_on_supports(parameters));
    } catch (const InputError& wrong) {
      return wrong.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message([](auto&) {}), "accepted");
  EXPECT_NE(
      message([](auto& p) { p.supports[1] = p.supports[0]; }).find("[[support]] 2 of 2: found y of node 101 again"),
      std::string::npos);
  EXPECT_NE(message([](auto& p) { p.supports[0].holds = {"x"}; }).find("none of which has a row of x"),
            std::string::npos);
  EXPECT_NE(message([](auto& p) { p.supports[0].holds = {"y", "y"}; }).find("with \"y\" twice"), std::string::npos);
  EXPECT_NE(message([](auto& p) { p.supports[0].holds.clear(); }).find("holds without a motion"), std::string::npos);
  EXPECT_NE(message([](auto& p) { p.supports[0].holds = {"up"}; }).find("support.holds with \"up\""),
            std::string::npos);
  EXPECT_NE(
      message([](auto& p) { p.supports[0].nodes.set = "PIER"; }).find("[[support]] 1 of 2: found no set \"PIER\""),
      std::string::npos);
}

// A coach over the built-in span and over its matrices: moments at the nodes, shear forces in the elements' middles.
TEST_P(ImportedSpan, HasTheSectionForcesOfTheBuiltInOneUnderACoach) {
  SceneParameters scene;
  scene.contact.normal = NormalContact::rigid;
  scene.track = short_track();
  scene.track.length_before = scene.track.length_after = 60.0;
  scene.train.start = -1.0;
  scene.train.speed = 70.0;
  scene.integration.time_step = 1e-3;
  scene.integration.duration = 0.7;
  scene.output.deck_envelope = true;
  SceneParameters with_matrices = scene;
  scene.spans = {span()};
  with_matrices.structure = WrittenSpan(GetParam(), SupportRows::kept).parameters;
  with_matrices.structure.axis_depth = span().axis_depth;
  for (int i = 1; i < 12; ++i) with_matrices.structure.sections.push_back(2.0 * i);
  const auto extremes = [](const SceneParameters& run, std::string_view quantity) {
    std::map<double, std::array<double, 2>> found;
    ResultHeader header;
    RunObserver observer;
    observer.start = [&](const ResultHeader& of_run) { header = of_run; };
    const RunSummary summary = run_scene(run, observer);
    EXPECT_TRUE(summary.complete) << summary.message;
    for (std::size_t q = 0; q < header.deck.size(); ++q) {
      if (header.deck[q].quantity != quantity) continue;
      for (std::size_t i = 0; i < header.deck[q].x.size(); ++i) {
        found[header.deck[q].x[i]] = {summary.deck[q].smallest[i], summary.deck[q].largest[i]};
      }
    }
    return found;
  };
  for (const auto& [quantity, first, least] :
       {std::tuple{"bending_moment", 4.0, 1e6}, std::tuple{"shear_force", 2.0, 1e5}}) {
    const auto built = extremes(scene, quantity), imported = extremes(with_matrices, quantity);
    EXPECT_EQ(imported.size(), 11U);
    double largest = 0.0;
    for (const auto& [x, of_built] : built) {
      for (const double value : of_built) largest = std::max(largest, std::abs(value));
    }
    EXPECT_GT(largest, least);
    for (double x = first; x < 24.0; x += 4.0) {
      for (std::size_t end = 0; end < 2; ++end) {
        // The built track is solved in sections, whose factor is one of floats.
        EXPECT_NEAR(imported.at(x)[end], built.at(x)[end], 1e-5 * largest) << quantity << " at " << x;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, ImportedSpan, ::testing::Values(FeFormat::matrix_market, FeFormat::ansys),
                         [](const auto& format) { return format.param == FeFormat::ansys ? "Ansys" : "MatrixMarket"; });

TEST(ImportedBridge, RejectsWhatDoesNotFit) {
  const ImportParameters good = WrittenSpan(FeFormat::matrix_market).parameters;
  const auto message = [](ImportParameters parameters) -> std::string {
    try {
      static_cast<void>(build_track_on_import(short_track(), parameters));
    } catch (const InputError& wrong) {
      return wrong.what();
    }
    return "accepted";
  };
  const auto changed = [&](auto&& change) {
    ImportParameters parameters = good;
    change(parameters);
    return message(parameters);
  };
  EXPECT_EQ(message(good), "accepted");
  EXPECT_NE(changed([](auto& p) { p.frame.axes = "x y -z"; }).find("left-handed"), std::string::npos);
  EXPECT_NE(changed([](auto& p) { p.frame.axes = "x x z"; }).find("an axis twice"), std::string::npos);
  EXPECT_NE(changed([](auto& p) { p.frame.axes = "x up"; }).find("structure.axes"), std::string::npos);
  EXPECT_NE(changed([](auto& p) { p.frame.units = "m-N-kg"; }).find("structure.units"), std::string::npos);
  EXPECT_NE(changed([](auto& p) { p.frame.axes = "x -z y"; }).find("above the rail-head tops"), std::string::npos);
  EXPECT_NE(changed([](auto& p) { p.deck.set = "DECK"; }).find("structure.deck: found no set \"DECK\""),
            std::string::npos);
  EXPECT_NE(changed([](auto& p) { p.deck.from = p.deck.to = {0, 5e3, 0}; }).find("structure.deck"), std::string::npos);
  const std::string one = changed([](auto& p) { p.deck.from = p.deck.to = {12e3, 0, 0}; });
  EXPECT_TRUE(one.starts_with("structure.deck: found node ") && one.find(" alone, ") != one.npos) << one;
  EXPECT_NE(changed([](auto& p) {
              p.damping.frequencies = {1.0, 2.0};
            }).find("no ratio that would hold"),
            std::string::npos);
  EXPECT_NE(changed([](auto& p) { p.files.mass = p.files.stiffness; }).find("structure.mass: found "),
            std::string::npos);
  EXPECT_NE(changed([](auto& p) { p.damping.ratio = 0.01; }).find("damping in 2 ways"), std::string::npos);
  EXPECT_NE(changed([](auto& p) { p.files.damping.clear(); }).find("damping in 0 ways"), std::string::npos);
  EXPECT_NE(changed([](auto& p) { p.report = {99.0}; }).find("structure.report"), std::string::npos);
  EXPECT_NE(changed([](auto& p) { p.files.mass = p.files.dofs; }).find("dofs:1"), std::string::npos);
}

TEST(ImportedBridge, MassesAndFrequenciesOfNoBridgeAreDoubted) {
  ImportParameters parameters = WrittenSpan(FeFormat::matrix_market).parameters;
  parameters.files.damping.clear();
  parameters.damping.ratio = 0.01;
  EXPECT_TRUE(build_track_on_import(short_track(), parameters).warnings.empty());
  // 33.9 t/m less about half an element at each support
  EXPECT_NEAR(mass_per_length(read_on_supports(parameters)), 33.9e3 * 5.0 / 6.0, 33.9e3 * 0.1);
  EXPECT_EQ(plausibility_warnings(33.9, 5.0).size(), 1U);
  EXPECT_EQ(plausibility_warnings(33.9e6, 5e-3).size(), 2U);
  EXPECT_EQ(plausibility_warnings(33.9e3, 5e3).size(), 1U);
  EXPECT_TRUE(plausibility_warnings(33.9e3, 0.0).empty());
}

TEST(ImportedBridge, ADeckFarFromTheTrainIsDoubted) {
  ImportParameters parameters = WrittenSpan(FeFormat::matrix_market).parameters;
  parameters.files.damping.clear();
  parameters.damping.ratio = 0.01;
  parameters.report.clear();
  (*parameters.frame.origin)[0] += 30e3;  // mm: more than the span's length
  const std::vector<std::string> warnings = build_track_on_import(short_track(), parameters).warnings;
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("structure.origin is the point of the model that is to be at x = 0"), std::string::npos);
  EXPECT_TRUE(deck_place_warnings({500.0, 530.0}).empty());
  EXPECT_EQ(deck_place_warnings({1500.0, 1530.0}).size(), 1U);
}

// A mass on equal springs in all directions has any three directions at right angles as modes; dampers along axes of
// their own damp three of them.
TEST(ImportedBridge, DampingRatiosOfEqualFrequenciesAreThoseOfTheDampers) {
  constexpr double mass = 2e3, stiffness = 8e6;
  const double critical = 2.0 * std::sqrt(stiffness * mass);
  const Eigen::Vector3d ratios(0.01, 0.02, 0.05);
  const Eigen::Matrix3d axes = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
  const Eigen::MatrixXd damping = critical * axes * ratios.asDiagonal() * axes.transpose();
  FeStructure structure;
  structure.mass = (mass * Eigen::MatrixXd::Identity(3, 3)).sparseView();
  structure.stiffness = (stiffness * Eigen::MatrixXd::Identity(3, 3)).sparseView();
  structure.damping = damping.sparseView();
  structure.motion = {0, 1, 2};
  structure.node_of_row = {1, 1, 1};
  for (std::size_t k = 0; k < 3; ++k) structure.nodes[1].rows[k] = {static_cast<int>(k)};
  const StructureSummary summary = summarise(structure, {}, 3);
  ASSERT_EQ(summary.damping_ratios.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(summary.damping_ratios[k], ratios[static_cast<Eigen::Index>(k)], 1e-9);
    EXPECT_NEAR(summary.frequencies[k], std::sqrt(stiffness / mass) / (2.0 * std::numbers::pi), 1e-9);
  }
}

TEST(ImportedBridge, DampingByRatioTypeAndCoefficients) {
  ImportParameters parameters = WrittenSpan(FeFormat::matrix_market).parameters;
  parameters.files.damping.clear();
  const FeStructure structure = read_fe_structure(parameters.files, parameters.frame);
  const auto ratios = [&](const FeDamping& damping) { return summarise(structure, damping, 4).damping_ratios; };
  FeDamping by_ratio, by_factors;
  by_ratio.ratio = 0.03;
  EXPECT_NEAR(ratios(by_ratio)[0], 0.03, 1e-8);
  EXPECT_LT(ratios(by_ratio)[1], 0.03);
  EXPECT_NEAR(ratios(by_ratio)[2], 0.03, 1e-8);
  FeDamping by_type;
  by_type.type = "steel-composite";
  by_type.span = 12.0;
  EXPECT_NEAR(ratios(by_type)[0], 0.015, 1e-8);
  const double f = summarise(structure, by_type, 1).frequencies[0];
  by_type.frequencies = {f, 10 * f};
  EXPECT_NEAR(ratios(by_type)[0], 0.015, 1e-8);
  by_factors.mass_factor = 0.5;
  by_factors.stiffness_factor = 1e-3;
  EXPECT_NEAR(ratios(by_factors)[0], 0.5 * (0.5 / (2 * std::numbers::pi * f) + 1e-3 * 2 * std::numbers::pi * f), 1e-9);
}

// [EN1991-2, Table 6.6]
TEST(BridgeDamping, LowerBounds) {
  EXPECT_DOUBLE_EQ(damping_lower_bound("k", "steel-composite", 25.0), 0.005);
  EXPECT_DOUBLE_EQ(damping_lower_bound("k", "steel-composite", 10.0), 0.0175);
  EXPECT_DOUBLE_EQ(damping_lower_bound("k", "prestressed-concrete", 20.0), 0.010);
  EXPECT_DOUBLE_EQ(damping_lower_bound("k", "prestressed-concrete", 5.0), 0.0205);
  EXPECT_DOUBLE_EQ(damping_lower_bound("k", "reinforced-concrete", 15.0), 0.0185);
  EXPECT_THROW(static_cast<void>(damping_lower_bound("k", "wood", 15.0)), InputError);
  EXPECT_THROW(static_cast<void>(damping_lower_bound("k", "steel-composite", 0.0)), InputError);
}

// A deck of scattered nodes, numbers of which are the places of their three rows.
FeStructure scattered_deck(double slope) {
  FeStructure structure;
  std::minstd_rand generator(5);
  std::uniform_real_distribution<double> shift(-0.2, 0.2);
  int row = 0;
  for (int i = 0; i <= 20; ++i) {
    for (int j = 0; j <= 10; ++j) {
      FeNode& node = structure.nodes[row / 3 + 1];
      node.position = {0.6 * i + (i > 0 && i < 20 ? shift(generator) : 0.0), 0.5 * j - 2.5 + shift(generator), 0.0};
      node.position[2] = 0.8 + slope * node.position[1];
      for (std::size_t k = 0; k < 3; ++k) node.rows[k] = {row++};
    }
  }
  structure.stiffness.resize(row, row);
  return structure;
}

// Every rigid motion of the nodes is the same motion of the attachment, whatever the mesh: no spring is strained by it.
TEST(DeckSurface, FollowsRigidMotionsAndSlopes) {
  const FeStructure structure = scattered_deck(0.02);
  std::vector<int> numbers;
  for (const auto& [number, node] : structure.nodes) numbers.push_back(number);
  const DeckFunction deck = deck_function(structure, numbers);
  for (const auto& [x, y] : {std::pair{0.0, -0.75}, {3.1, 0.75}, {6.0, 0.0}, {11.9, 1.5}}) {
    const auto at = deck(x, y, 0.4);
    ASSERT_TRUE(at) << x;
    const Eigen::Vector3d point(x, y, 0.4), foot = point - at->arm;
    EXPECT_NEAR(foot[2], 0.8 + 0.02 * y, 1e-9);
    for (int k = 0; k < 6; ++k) {
      const Eigen::Vector3d turn = k < 3 ? Eigen::Vector3d::Zero() : Eigen::Vector3d(Eigen::Vector3d::Unit(k - 3));
      const Eigen::Vector3d move = k < 3 ? Eigen::Vector3d(Eigen::Vector3d::Unit(k)) : Eigen::Vector3d::Zero();
      Eigen::VectorXd q = Eigen::VectorXd::Zero(structure.dofs());
      for (const auto& [number, node] : structure.nodes) {
        for (std::size_t d = 0; d < 3; ++d)
          q[node.rows[d][0]] = (move + turn.cross(node.position))[static_cast<int>(d)];
      }
      Eigen::VectorXd own(at->dof.size());
      for (std::size_t i = 0; i < at->dof.size(); ++i) own[static_cast<int>(i)] = q[at->dof[i]];
      const Eigen::Matrix<double, 6, 1> motion = at->rows * own;
      const Eigen::Vector3d found = motion.head<3>() + motion.tail<3>().cross(at->arm);
      EXPECT_LT((found - move - turn.cross(point)).norm(), 1e-9) << x << ' ' << k;
    }
  }
  EXPECT_FALSE(deck(-0.1, 0.0, 0.4));
  EXPECT_FALSE(deck(12.0, 0.0, 0.4));
  EXPECT_THROW(static_cast<void>(deck(6.0, 4.5, 0.4)), InputError) << "beyond the edge";
}

}  // namespace
}  // namespace railtab
