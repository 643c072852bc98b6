#pragma once

// A continuous deck of shells with two girders, its track to one side of them, that CalculiX assembles and computes.

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "../folder_fixture.hpp"
#include "railtab/runtime/structure/imported_bridge.hpp"

namespace railtab {

/// x forward, y left, z up [m]. S8R elements; the girders are strips of greater thickness. Nodes stand under the
/// ballast of all sleepers. The track runs 2.25 m to the right of the deck's middle.
class ShellDeck : public testing::InFolder {
 protected:
  static constexpr double span = 18.0, bay = 0.6, dy = 0.375, right_edge = -3.7, track = -2.2, load = 10e3;
  static constexpr double rail_head = 0.9, stiffness_damping = 1e-4;  // above the shells' middle [m]; [s]
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

  /// Shares of the nodes around a place under the ballast in a load there: bells of the radius that deck_function()
  /// describes, times the plane that puts the shares' centre to the load's place also where nodes lie to one side.
  [[nodiscard]] static std::map<int, double> spread(int i, int j) {
    struct Near {
      int number;
      double x, y;  // from the load [m]
    };
    std::vector<Near> near;
    for (int a = std::max(0, i - 4); a <= std::min(along, i + 4); ++a) {
      for (int b = std::max(0, j - 4); b <= std::min(across, j + 4); ++b) {
        if (is_node(a, b) && !is_support(a, b)) near.push_back({number(a, b), bay * (a - i), dy * (b - j)});
      }
    }
    std::sort(near.begin(), near.end(),
              [](const Near& a, const Near& b) { return std::hypot(a.x, a.y) < std::hypot(b.x, b.y); });
    const double radius = std::max(0.5, 1.2 * std::hypot(near[5].x, near[5].y));
    const auto bell = [&](const Near& n) {
      return std::pow(std::max(0.0, 1.0 - (n.x * n.x + n.y * n.y) / (radius * radius)), 2);
    };
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    for (const Near& n : near) {
      const Eigen::Vector3d p(1.0, n.x, n.y);
      moments += bell(n) * p * p.transpose();
    }
    const Eigen::Vector3d plane = moments.inverse() * Eigen::Vector3d::UnitX();
    std::map<int, double> shares;
    for (const Near& n : near) {
      if (bell(n) > 0.0) shares[n.number] = bell(n) * plane.dot(Eigen::Vector3d(1.0, n.x, n.y));
    }
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
    return downward(printed("statics").back());
  }

  /// Displacements x, y, z that CalculiX has printed of one instant, or one mode [m].
  using Printed = std::map<int, std::array<double, 3>>;
  [[nodiscard]] std::vector<Printed> printed(const std::string& name) const {
    std::vector<Printed> instants;
    std::set<std::string> headings;  // of the last instant: its sets of nodes and its time
    std::ifstream in(folder_ / (name + ".dat"));
    for (std::string row; std::getline(in, row);) {
      int n = 0;
      std::array<double, 3> u{};
      if (row.find("displacements") != std::string::npos) {
        const std::string time = row.substr(row.find("time"));
        if (headings.count(time) == 0 || headings.count(row) > 0) {
          instants.emplace_back();
          headings = {time};
        }
        headings.insert(row);
      } else if (!instants.empty() && std::sscanf(row.c_str(), "%d %lf %lf %lf", &n, &u[0], &u[1], &u[2]) == 4) {
        instants.back()[n] = u;
      }
    }
    return instants;
  }
  [[nodiscard]] static std::map<int, double> downward(const Printed& instant) {
    std::map<int, double> down;
    for (const auto& [n, u] : instant) down[n] = -u[2];
    return down;
  }

  /// Largest difference from CalculiX, and largest value of CalculiX, of what is added.
  struct Difference {
    double most = 0.0, largest = 0.0;
    void add(double found, double expected) {
      most = std::max(most, std::abs(found - expected));
      largest = std::max(largest, std::abs(expected));
    }
    [[nodiscard]] double percent() const { return 100.0 * most / largest; }
  };
  /// Both edges, roll and twist under the track; twist where both ends of its base are on the deck.
  struct DeckDifference {
    Difference edge, roll, twist;
    int edges = 0, twists = 0;  // places
  };
  /// @param channels of the deck as railtab has them @param down of nodes at the edges and under the ballast
  static void add(const StructureModel& model, const Eigen::VectorXd& channels, const std::map<int, double>& down,
                  DeckDifference& difference) {
    const auto cross_level = [&](int i) {  // between the nodes under both sides of the ballast, over their distance
      return (down.at(number(i, under(track - 0.75))) - down.at(number(i, under(track + 0.75)))) / 1.5;
    };
    difference.edges = difference.twists = 0;
    for (std::size_t c = 0; c < model.deck.channel.size(); ++c) {
      const DeckChannel& at = model.deck.channel[c];
      const double value = channels[static_cast<Eigen::Index>(c)];
      const int i = static_cast<int>(std::lround(at.x / bay)), j = under(track - at.y);
      if (at.quantity == DeckQuantity::displacement && (j == 0 || j == across)) {
        difference.edge.add(value, down.at(number(i, j)));
        ++difference.edges;
      }
      if (at.quantity == DeckQuantity::roll) {
        difference.roll.add(value, cross_level(i));
      }
      if (at.quantity != DeckQuantity::twist || i < 0 || i + 5 >= along) continue;
      difference.twist.add(value, 1.435 * (cross_level(i + 5) - cross_level(i)));
      ++difference.twists;
    }
  }

  /// Under loads that only the deck bears: CalculiX's statics() have no rails.
  [[nodiscard]] static TrackParameters rails_that_bear_nothing() {
    TrackParameters rails;
    rails.rail.A = 1e-8;
    rails.rail.Iy = rails.rail.Iz = 1e-10;
    rails.rail.GJ = 1.0;
    rails.ballast_deck.kx = rails.ballast_deck.ky = 1.0;
    rails.length_before = rails.length_after = 6.0;
    return rails;
  }

  [[nodiscard]] StructureModel imported(const TrackParameters& rails) const {
    calculate("deck", mesh() + "*STEP\n*FREQUENCY, SOLVER=MATRIXSTORAGE\n2\n*END STEP\n");
    ImportParameters parameters;
    parameters.files = {FeFormat::calculix,   folder_ / "deck.mas", folder_ / "deck.sti", {},
                        folder_ / "deck.dof", folder_ / "deck.inp"};
    parameters.frame.origin = {{0.0, track, rail_head}};
    parameters.damping.mass_factor = 0.0;
    parameters.damping.stiffness_factor = stiffness_damping;
    parameters.deck.set = "deck";
    parameters.report = {9.0, 27.0};
    return build_track_on_import(rails, parameters, DeckRecord::everywhere);
  }

  static constexpr const char* missing = "no ccx (Debian: calculix-ccx)";
  [[nodiscard]] static bool installed() { return std::system("command -v ccx > /dev/null 2>&1") == 0; }

  [[nodiscard]] static bool is_support(int i, int j) {
    return i % (along / 2) == 0 && (j == girder_right || j == girder_left);
  }
  void calculate(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / (name + ".inp")) << text;
    const std::string command = "cd '" + folder_.string() + "' && ccx " + name + " > ccx.log 2>&1";
    if (std::system(command.c_str()) != 0) throw std::runtime_error("ccx has failed at " + name);
  }
};

}  // namespace railtab
