// A continuous deck of shells with two girders, its track to one side of them, that CalculiX has assembled: edges,
// twist and roll of the deck under loads on the rails against CalculiX's own statics, which knows neither railtab's
// track nor its fits. Skipped where there is no ccx.

#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "../folder_fixture.hpp"
#include "../measured.hpp"
#include "railtab/runtime/structure/imported_bridge.hpp"
#include "railtab/runtime/vehicle/vehicle_library.hpp"
#include "railtab/runtime/vsi/simulation.hpp"

namespace railtab {
namespace {

/// x forward, y left, z up [m]. S8R elements; the girders are strips of greater thickness. Nodes stand under the
/// ballast of all sleepers.
class ShellDeck : public testing::InFolder {
 protected:
  static constexpr double span = 18.0, bay = 0.6, dy = 0.375, right_edge = -4.45, track = -2.2, load = 10e3;
  static constexpr int along = 60, across = 20, girder_right = 4, girder_left = 16;  // intervals between nodes

  [[nodiscard]] static int number(int i, int j) { return i * (across + 1) + j + 1; }
  [[nodiscard]] static double y_of(int j) { return right_edge + dy * j; }
  /// Not in the middle of an element of eight nodes.
  [[nodiscard]] static bool is_node(int i, int j) { return i % 2 == 0 || j % 2 == 0; }
  [[nodiscard]] static int under(double y) { return static_cast<int>(std::lround((y - right_edge) / dy)); }

  [[nodiscard]] std::string mesh() const {
    std::string text = "*NODE, NSET=EVERY\n", thickness = "*NODAL THICKNESS\n", set = "*NSET, NSET=DECK\n";
    const auto line = [](std::string& to, const std::string& what) { to += what + "\n"; };
    for (int i = 0; i <= along; ++i) {
      for (int j = 0; j <= across; ++j) {
        if (!is_node(i, j)) continue;
        const std::string n = std::to_string(number(i, j));
        line(text, n + ", " + std::to_string(bay * i) + ", " + std::to_string(y_of(j)) + ", 0.");
        const bool girder = std::abs(j - girder_right) <= 1 || std::abs(j - girder_left) <= 1;
        line(thickness, n + (girder ? ", 1.1" : ", 0.35"));
        if (!is_support(i, j)) line(set, n + ",");
      }
    }
    text += "*ELEMENT, TYPE=S8R, ELSET=ALL\n";
    for (int i = 0, e = 0; i < along; i += 2) {
      for (int j = 0; j < across; j += 2) {
        text += std::to_string(++e);
        for (const auto& [a, b] : {std::pair{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 0}, {2, 1}, {1, 2}, {0, 1}}) {
          text += ", " + std::to_string(number(i + a, j + b));
        }
        text += "\n";
      }
    }
    text += set +
            "*MATERIAL, NAME=CONCRETE\n*ELASTIC\n34.5e9, 0.2\n*DENSITY\n2500.\n"
            "*SHELL SECTION, ELSET=ALL, MATERIAL=CONCRETE, NODAL THICKNESS\n0.35\n" +
            thickness + "*BOUNDARY\n";
    for (const int i : {0, along / 2, along}) {
      for (const int j : {girder_right, girder_left}) line(text, std::to_string(number(i, j)) + ", 2, 3");
    }
    for (const int j : {girder_right, girder_left}) line(text, std::to_string(number(0, j)) + ", 1, 1");
    return text;
  }

  /// Shares of the nodes in a load on one of them, by bells of the radius that deck_function() describes; the mesh is
  /// alike to all sides, so that the shares' centre is the load's place.
  [[nodiscard]] static std::map<int, double> spread(int i, int j) {
    std::map<double, std::vector<int>> by_distance;
    std::vector<double> distances;
    for (int a = std::max(0, i - 4); a <= std::min(along, i + 4); ++a) {
      for (int b = std::max(0, j - 4); b <= std::min(across, j + 4); ++b) {
        if (!is_node(a, b) || is_support(a, b)) continue;
        distances.push_back(std::hypot(bay * (a - i), dy * (b - j)));
        by_distance[distances.back()].push_back(number(a, b));
      }
    }
    std::sort(distances.begin(), distances.end());
    const double radius = std::max(0.5, 1.2 * distances[5]);
    std::map<int, double> shares;
    double sum = 0.0;
    for (const auto& [distance, nodes] : by_distance) {
      if (distance >= radius) break;
      for (const int n : nodes) sum += shares[n] = std::pow(1.0 - std::pow(distance / radius, 2), 2);
    }
    for (auto& [n, share] : shares) share /= sum;
    return shares;
  }

  enum class Load { at_points, spread_by_ballast };
  /// Vertical displacement of every node in CalculiX's statics [m], down; the same load on both sides of the ballast
  /// under every sleeper of the first span.
  [[nodiscard]] std::map<int, double> statics(Load kind) const {
    std::map<int, double> force;
    for (int i = 1; i < along / 2; ++i) {
      for (const double side : {-0.75, 0.75}) {
        const int j = under(track + side);
        if (kind == Load::at_points) force[number(i, j)] += load;
        if (kind == Load::at_points) continue;
        for (const auto& [n, share] : spread(i, j)) force[n] += share * load;
      }
    }
    std::string text = mesh() + "*STEP\n*STATIC\n*CLOAD\n";
    for (const auto& [n, value] : force) text += std::to_string(n) + ", 3, " + std::to_string(-value) + "\n";
    calculate("statics", text + "*NODE PRINT, NSET=EVERY\nU\n*END STEP\n");
    std::ifstream in(folder_ / "statics.dat");
    std::map<int, double> down;
    for (std::string row; std::getline(in, row);) {
      int n = 0;
      double x = 0, y = 0, z = 0;
      if (std::sscanf(row.c_str(), "%d %lf %lf %lf", &n, &x, &y, &z) == 4) down[n] = -z;
    }
    return down;
  }

  [[nodiscard]] StructureModel imported() const {
    calculate("deck", mesh() + "*STEP\n*FREQUENCY, SOLVER=MATRIXSTORAGE\n2\n*END STEP\n");
    ImportParameters parameters;
    parameters.files = {FeFormat::calculix,   folder_ / "deck.mas", folder_ / "deck.sti", {},
                        folder_ / "deck.dof", folder_ / "deck.inp"};
    parameters.frame.origin = {{0.0, track, 0.9}};
    parameters.damping.mass_factor = 0.0;
    parameters.damping.stiffness_factor = 1e-4;
    parameters.deck.set = "deck";
    parameters.report = {9.0, 27.0};
    TrackParameters rails;  // that bear nothing themselves: CalculiX has none
    rails.rail.A = 1e-8;
    rails.rail.Iy = rails.rail.Iz = 1e-10;
    rails.rail.GJ = 1.0;
    rails.ballast_deck.kx = rails.ballast_deck.ky = 1.0;
    rails.length_before = rails.length_after = 6.0;
    return build_track_on_import(rails, parameters, DeckRecord::everywhere);
  }

  static constexpr const char* missing = "no ccx (Debian: calculix-ccx)";
  [[nodiscard]] static bool installed() { return std::system("command -v ccx > /dev/null 2>&1") == 0; }

 private:
  [[nodiscard]] static bool is_support(int i, int j) {
    return i % (along / 2) == 0 && (j == girder_right || j == girder_left);
  }
  void calculate(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / (name + ".inp")) << text;
    const std::string command = "cd '" + folder_.string() + "' && ccx " + name + " > ccx.log 2>&1";
    ASSERT_EQ(std::system(command.c_str()), 0);
  }
};

/// Displacements under the same vertical force on both rails above every sleeper of the first span.
Eigen::VectorXd under_train(const StructureModel& model, double from, double to, double bay, double force) {
  Eigen::VectorXd load = Eigen::VectorXd::Zero(model.dofs());
  for (const RailLine& rail : model.rail) {
    for (double x = from; x < to + 0.5 * bay; x += bay) {
      const RailInterpolation rows = rail_interpolation(rail, x);
      for (std::size_t k = 0; k < rows.dof.size(); ++k) {
        if (rows.dof[k] != held) load[rows.dof[k]] += force * rows.z[k];
      }
    }
  }
  return Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(model.stiffness).solve(load);
}

TEST_F(ShellDeck, EdgesTwistAndRollAreThoseOfCalculix) {
  if (!installed()) GTEST_SKIP() << missing;
  const std::map<int, double> down = statics(Load::spread_by_ballast), by_points = statics(Load::at_points);
  ASSERT_GT(down.size(), 900U);
  const StructureModel model = imported();
  const Eigen::VectorXd u = under_train(model, bay, span - bay, bay, load);
  const Eigen::VectorXd found = model.deck.rows * u;
  const double largest = down.at(number(15, 0));  // the edge beside the track
  EXPECT_GT(largest, 1e-3);
  double edge_error = 0.0, spread_error = 0.0, twist_error = 0.0, largest_twist = 0.0, roll_error = 0.0,
         largest_roll = 0.0;
  int edges = 0, twists = 0;
  const auto cross_level = [&](int i) {  // between the nodes under both sides of the ballast, over their distance
    return (down.at(number(i, under(track - 0.75))) - down.at(number(i, under(track + 0.75)))) / 1.5;
  };
  // supports, one of which stands under the ballast, are no nodes of the deck
  const auto at_pier = [](int i) { return i == along / 2; };
  for (std::size_t c = 0; c < model.deck.channel.size(); ++c) {
    const DeckChannel& at = model.deck.channel[c];
    const double value = found[static_cast<Eigen::Index>(c)];
    const int i = static_cast<int>(std::lround(at.x / bay)), j = under(track - at.y);
    if (at.quantity == DeckQuantity::displacement && (j == 0 || j == across)) {
      edge_error = std::max(edge_error, std::abs(value - down.at(number(i, j))));
      spread_error = std::max(spread_error, std::abs(value - by_points.at(number(i, j))));
      ++edges;
    }
    if (at.quantity == DeckQuantity::roll && i > 0 && i < along && !at_pier(i)) {
      roll_error = std::max(roll_error, std::abs(value - cross_level(i)));
      largest_roll = std::max(largest_roll, std::abs(cross_level(i)));
    }
    const bool at_supports = i < 1 || i + 5 >= along || at_pier(i) || at_pier(i + 5);
    if (at.quantity != DeckQuantity::twist || at_supports) continue;
    const double twist = 1.435 * (cross_level(i + 5) - cross_level(i));
    twist_error = std::max(twist_error, std::abs(value - twist));
    largest_twist = std::max(largest_twist, std::abs(twist));
    ++twists;
  }
  EXPECT_EQ(edges, 2 * (along + 1));
  EXPECT_GT(twists, 40);
  testing::measured("calculix.deck_edge", 100.0 * edge_error / largest);
  testing::measured("calculix.deck_edge_points", 100.0 * spread_error / largest);
  testing::measured("calculix.deck_twist", 100.0 * twist_error / largest_twist);
  testing::measured("calculix.deck_roll", 100.0 * roll_error / largest_roll);
  testing::measured("calculix.deck_edge_mm", 1e3 * largest);
  testing::measured("calculix.deck_track_mm", 1e3 * down.at(number(15, under(track))));
  EXPECT_LT(edge_error, 0.005 * largest);
  EXPECT_LT(spread_error, 0.005 * largest) << "of the edges it matters little how the ballast spreads the loads";
  EXPECT_LT(twist_error, 0.005 * largest_twist);
  EXPECT_LT(roll_error, 0.005 * largest_roll);
}

// A node of shells has no rotation of its own; the record has that of the deck around it.
TEST_F(ShellDeck, RecordedNodesRoll) {
  if (!installed()) GTEST_SKIP() << missing;
  VsiModel model;
  model.vehicle = build_coach(coach_parameters("manchester-coach"));
  model.vehicle_x = {0.0};
  model.structure = imported();
  VsiState state(model);
  state.structure.displacement = under_train(*model.structure, bay, span - bay, bay, load);
  StepRecord record;
  fill_record(model, state, record);
  const std::map<int, double> down = statics(Load::spread_by_ballast);
  for (std::size_t n = 0; n < record.nodes.size(); ++n) {
    const StructureNode& node = model.structure->nodes[n];
    if (!is_deck(node.name)) continue;
    const int i = static_cast<int>(std::lround(node.x / bay)), j = under(track - node.y);
    const double roll = (down.at(number(i, j - 2)) - down.at(number(i, j + 2))) / (4.0 * dy);
    const auto quarter = [&](int k) {  // between the nodes next to 0.75 m
      return 0.75 * down.at(number(i + k, j)) + 0.25 * down.at(number(i + 2 * k, j));
    };
    const double pitch = -(quarter(1) - quarter(-1)) / 1.5;
    testing::measured("calculix.node_roll_" + node.name, 100.0 * (record.nodes[n].displacement[3] / roll - 1.0));
    EXPECT_NEAR(record.nodes[n].displacement[3], roll, 0.005 * std::abs(roll)) << node.name;
    EXPECT_NEAR(record.nodes[n].displacement[4], pitch, 0.005 * std::abs(roll)) << node.name;
    EXPECT_GT(std::abs(roll), 1e-5);
  }
}

}  // namespace
}  // namespace railtab
