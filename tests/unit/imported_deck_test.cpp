// Decks from a finite-element program under axle loads: one span against the built-in one, two against closed forms.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include "../folder_fixture.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/moving_load/deck_modes.hpp"
#include "railtab/runtime/moving_load/static_deflection.hpp"
#include "railtab/runtime/moving_load/train_passage.hpp"
#include "railtab/runtime/structure/beam_element.hpp"
#include "railtab/runtime/structure/deck_nodes.hpp"
#include "railtab/runtime/structure/stiffness_factor.hpp"

namespace railtab {
namespace {

constexpr double pi = std::numbers::pi, span = 20.0, stiffness = 20e9, mass = 10e3;

/// A continuous beam over equal spans of elements of 1 m, z and pitch alone, in Matrix Market; beside the deck posts
/// that vibrate on their own, from 31 Hz on.
class BeamFiles : public testing::InFolder {
 protected:
  [[nodiscard]] ImportParameters beam(int spans, int posts = 0) const {
    const int nodes = spans * 20 + 1;
    BeamSection section;
    section.E = stiffness;
    section.Iy = 1.0;
    section.mass = mass;
    const BeamMatrix k = beam_stiffness(section, 1.0), m = beam_mass(section, 1.0);
    const std::array<int, 4> plane{2, 4, 8, 10};
    std::vector<int> row_of(static_cast<std::size_t>(2 * nodes), -1);
    std::string dofs = "row,node,motion\n", places = "# number, x, y, z\n";
    int rows = 0;
    for (int i = 0; i < nodes; ++i) {
      places += std::to_string(i + 1) + ", " + std::to_string(i) + ", 0, 1\n";
      for (int turn = 0; turn < 2; ++turn) {
        if (turn == 0 && i % 20 == 0) continue;
        row_of[static_cast<std::size_t>(2 * i + turn)] = rows;
        dofs += std::to_string(++rows) + "," + std::to_string(i + 1) + (turn == 0 ? ",z\n" : ",roty\n");
      }
    }
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(rows + posts, rows + posts), M = K;
    for (int p = 0; p < posts; ++p) {
      const std::string node = std::to_string(1001 + p);
      places += node + ", 5, 5, 1\n";
      dofs += std::to_string(rows + p + 1) + "," + node + ",z\n";
      M(rows + p, rows + p) = 100.0;
      K(rows + p, rows + p) = 100.0 * std::pow(2.0 * pi * (31.0 + 0.5 * p), 2);
    }
    for (int e = 0; e + 1 < nodes; ++e) {
      for (int a = 0; a < 4; ++a) {
        for (int b = 0; b < 4; ++b) {
          const int i = row_of[static_cast<std::size_t>(2 * e + a)], j = row_of[static_cast<std::size_t>(2 * e + b)];
          if (i < 0 || j < 0) continue;
          K(i, j) += k(plane[static_cast<std::size_t>(a)], plane[static_cast<std::size_t>(b)]);
          M(i, j) += m(plane[static_cast<std::size_t>(a)], plane[static_cast<std::size_t>(b)]);
        }
      }
    }
    ImportParameters parameters;
    parameters.files = {FeFormat::matrix_market, write("m.mtx", market(M)), write("k.mtx", market(K)), "",
                        write("dofs.csv", dofs), write("nodes.csv", places)};
    parameters.frame = {"m-N-kg", "x y z", {{0.0, 0.0, 0.0}}};
    parameters.damping.ratio = 0.01;
    parameters.deck.from = {0.0, 0.0, 1.0};
    parameters.deck.to = {spans * span, 0.0, 1.0};
    return parameters;
  }

 private:
  static std::string market(const Eigen::MatrixXd& matrix) {
    std::string entries;
    long count = 0;
    char text[80];
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
      for (Eigen::Index i = j; i < matrix.rows(); ++i) {
        if (matrix(i, j) == 0.0) continue;
        ++count;
        std::snprintf(text, sizeof text, "%ld %ld %.17g\n", i + 1, j + 1, matrix(i, j));
        entries += text;
      }
    }
    const std::string n = std::to_string(matrix.rows());
    return "%%MatrixMarket matrix coordinate real symmetric\n" + n + " " + n + " " + std::to_string(count) + "\n" +
           entries;
  }
};

// Modes that do not bend the deck, such as torsion, have no part in the limit of accelerations.
TEST(BendingModes, AreThoseThatMoveTheDeckAsAWhole) {
  const BendingModes of_girder = bending_modes(Eigen::ArrayXd{{1e-9, 0.4, 1.0, 0.0, 0.9, 0.2, 1.0, 0.8}});
  EXPECT_EQ(of_girder.first, 1);
  EXPECT_EQ(of_girder.third, 4);
  EXPECT_EQ(of_girder.found, 3);
  const BendingModes few = bending_modes(Eigen::ArrayXd{{1e-9, 0.8, 0.0}});
  EXPECT_EQ(few.first, 1);
  EXPECT_EQ(few.third, 1);
  EXPECT_EQ(few.found, 1);
}

TEST(DeckOutline, EndsOfASkewDeckFollowTheLine) {
  // ends along x = y and x = 20 + y, with nodes inside and on the edges
  std::vector<Eigen::Vector2d> nodes;
  for (const double y : {-5.0, -2.5, 0.0, 2.5, 5.0}) {
    for (int i = 0; i <= 20; ++i) nodes.emplace_back(i + y, y);
  }
  const DeckOutline outline(std::move(nodes));
  for (const double y : {-5.0, -1.3, 0.0, 0.6, 5.0}) {
    EXPECT_NEAR(outline.at(y).begin, y, 1e-12) << y;
    EXPECT_NEAR(outline.at(y).end, 20.0 + y, 1e-12) << y;
  }
  EXPECT_EQ(outline.at(6.0).begin, -5.0) << "beside the deck its whole length";
  EXPECT_EQ(outline.at(6.0).end, 25.0);
  EXPECT_EQ(DeckOutline({{1.0, 0.3}, {4.0, 0.3}}).at(0.0).end, 4.0) << "a single line of nodes";
}

/// A deck 10 m wide on a track at its edge, whose modes are sin(nπs/L) with s along the deck from its skew end, and
/// twist between the first and the second. Modes of a shell without cross bending.
class SkewDeck : public testing::InFolder {
 protected:
  [[nodiscard]] ImportParameters deck(double skew, double middle, int modes = 4) const {
    std::string places = "# number, x, y, z\n", shapes = "mode,node,uz\n";
    int node = 0;
    for (int j = 0; j <= 8; ++j) {
      const double y = 1.25 * (j - 4);
      for (int i = 0; i <= 40; ++i) {
        const double s = 0.5 * i;
        char text[120];
        std::snprintf(text, sizeof text, "%d, %.12g, %.12g, 0\n", ++node, s + (y + middle) * skew, y + middle);
        places += text;
        constexpr std::array half_waves{1, 1, 2, 3};
        for (int mode = 0; mode < modes; ++mode) {
          const double across = mode == 1 ? 0.3 * y : 1.0;
          std::snprintf(text, sizeof text, "%d,%d,%.12g\n", mode + 1, node,
                        across * std::sin(half_waves[static_cast<std::size_t>(mode)] * pi * s / span));
          shapes += text;
        }
      }
    }
    ImportParameters parameters;
    parameters.files.format = FeFormat::modes;
    std::string table = "mode,frequency,mass,damping\n";
    for (int mode = 0; mode < modes; ++mode) {
      constexpr std::array frequency{4, 6, 16, 36};
      table +=
          std::to_string(mode + 1) + "," + std::to_string(frequency[static_cast<std::size_t>(mode)]) + ",1e5,0.01\n";
    }
    parameters.files.modes = write("modes.csv", table);
    parameters.files.shapes = write("shapes.csv", shapes);
    parameters.files.nodes = write("nodes.csv", places);
    parameters.frame = {"m-N-kg", "x y z", {{0.0, 0.0, 0.0}}};
    parameters.deck.from = {-1e6, -1e6, -1e6};
    parameters.deck.to = {1e6, 1e6, 1e6};
    return parameters;
  }
};

// A deck whose ends are skew begins and ends under the track where a right one of that length does.
TEST_F(SkewDeck, IsAsLongAsOnTheLine) {
  AxleTrain train;
  train.behind = {0.0, 2.5, 18.0, 20.5, 36.0, 38.5};
  train.load.assign(6, 170e3);
  const ModalDeck right = imported_deck(deck(0.0, 0.0)), skew = imported_deck(deck(std::tan(pi / 6.0), 0.0));
  EXPECT_NEAR(skew.start, 0.0, 1e-6);
  EXPECT_NEAR(skew.length(), span, 1e-6);
  const PassagePeaks a = train_passage(right, modal_force(right, train), 60.0),
                     b = train_passage(skew, modal_force(skew, train), 60.0);
  EXPECT_NEAR(b.displacement.value, a.displacement.value, 0.03 * a.displacement.value);
  EXPECT_NEAR(b.acceleration.value, a.acceleration.value, 0.05 * a.acceleration.value);
}

// Twist moves a track beside the middle, and is no bending.
TEST_F(SkewDeck, TwistIsNoBendingBesideTheMiddle) {
  const ModalDeck aside = imported_deck(deck(0.0, -3.0));
  EXPECT_EQ(aside.first_bending, 0);
  EXPECT_EQ(aside.third_bending, 3);
  EXPECT_NEAR(aside.cut_off(), 36.0, 1e-9);
}

TEST_F(SkewDeck, AThirdBendingModeThatIsNotKnownIsToldOf) {
  EXPECT_EQ(doubtful_cut_off(imported_deck(deck(0.0, 0.0))), "");
  const ModalDeck few = imported_deck(deck(0.0, 0.0, 3));
  EXPECT_NEAR(few.cut_off(), 30.0, 1e-9);
  const std::string doubt = doubtful_cut_off(few);
  EXPECT_NE(doubt.find("not among its 3 modes up to 16 Hz"), std::string::npos) << doubt;
}

// Modes of other parts of the structure, 25 of them between the second and the third bending mode.
TEST_F(BeamFiles, TheThirdBendingModeIsSoughtBeyondOtherModes) {
  const ModalDeck alone = imported_deck(beam(1)), among = imported_deck(beam(1, 25));
  EXPECT_EQ(alone.third_bending, 2);
  EXPECT_EQ(among.first_bending, 0);
  EXPECT_EQ(among.third_bending, 27);
  EXPECT_NEAR(among.cut_off(), alone.cut_off(), 1e-6 * alone.cut_off());
  EXPECT_EQ(among.dynamic_modes, 28);
  EXPECT_EQ(doubtful_cut_off(among), "");
}

TEST_F(BeamFiles, OneSpanIsTheBuiltInOne) {
  BridgeParameters p;
  p.length = span;
  p.E = stiffness;
  p.Iy = 1.0;
  p.mass = mass;
  p.damping_ratio = 0.01;
  const ModalDeck own = simply_supported_deck(p), imported = imported_deck(beam(1));
  ASSERT_EQ(imported.dynamic_modes, own.dynamic_modes);
  for (int n = 0; n < own.dynamic_modes; ++n) {
    const double of_elements = std::pow((n + 1) * pi / 20.0, 4) / 1440.0;  // relative, of cubics with consistent mass
    EXPECT_NEAR(imported.omega[n], own.omega[n] * (1.0 + of_elements), 0.1 * of_elements * own.omega[n]);
  }
  EXPECT_NEAR(imported.damping[0], 0.01, 1e-9) << "Rayleigh's at the first and the third mode";
  EXPECT_NEAR(imported.damping[2], 0.01, 1e-9);
  const AxleTrain train = find_axle_train("hslm-a5", span);
  const double v = 22.0 * own.frequency(0) / 2.0;  // resonance of the second order
  const PassagePeaks a = train_passage(own, modal_force(own, train), v);
  const PassagePeaks b = train_passage(imported, modal_force(imported, train), v);
  EXPECT_NEAR(b.displacement.value, a.displacement.value, 1e-3 * a.displacement.value);
  const double at_rest = largest_static_deflection(own, train).value;
  EXPECT_NEAR(largest_static_deflection(imported, train).value, at_rest, 1e-4 * at_rest);
}

/// Two equal spans: first frequency that of one span simply supported, second (3.9266/L)² √(EI/m); a force in the
/// middle of one span deflects it by 23PL³/(1536EI) and the middle of the other by −9PL³/(1536EI).
TEST_F(BeamFiles, TwoContinuousSpans) {
  const ModalDeck deck = imported_deck(beam(2));
  const double unit = std::sqrt(stiffness / mass) / (span * span);
  EXPECT_NEAR(deck.omega[0], pi * pi * unit, 1e-5 * deck.omega[0]);
  EXPECT_NEAR(deck.omega[1], 3.926602 * 3.926602 * unit, 1e-5 * deck.omega[1]);
  AxleTrain axle;
  axle.behind = {0.0};
  axle.load = {100e3};
  const Eigen::ArrayXd q = modal_force_at(deck, axle, 0.5 * span) / deck.omega.square();
  const double scale = 100e3 * span * span * span / (1536.0 * stiffness);
  // elements of cubics are exact at their nodes; the modes found alone lack 2e-4
  EXPECT_NEAR((q * deck.shape_at(0.5 * span)).sum(), 23.0 * scale, 3e-5 * 23.0 * scale);
  EXPECT_NEAR((q * deck.shape_at(1.5 * span)).sum(), -9.0 * scale, 1e-4 * 9.0 * scale);
  // so slowly that the deck follows: the largest deflection is the one at rest
  const PassagePeaks slow = train_passage(deck, modal_force(deck, axle), 1.0);
  const double at_rest = largest_static_deflection(deck, axle).value;
  EXPECT_NEAR(slow.displacement.value, at_rest, 0.02 * at_rest);
}

/// A force P at a: M = Pb·x/L up to it and Pa(L − x)/L from it, with a + b = L. Two continuous spans, P in the middle
/// of the first: 13PL/64 there, −6PL/64 over the pier, half of that in the middle of the second.
TEST_F(BeamFiles, SectionForcesAreThoseOfStatics) {
  constexpr double P = 250e3, L = span;
  const auto forces = [&](int spans, double a, const std::vector<double>& sections) {
    ImportParameters parameters = beam(spans);
    parameters.sections = sections;
    parameters.axis_depth = 1.0;
    const FeStructure structure = read_on_supports(parameters);
    Eigen::VectorXd load = Eigen::VectorXd::Zero(structure.dofs());
    load[structure.nodes.at(static_cast<int>(a) + 1).rows[2].front()] = P;
    const Eigen::VectorXd u = stiffness_factor(structure.stiffness).solve(load);
    std::vector<double> found;
    for (const DeckRow& row : structure.sections) {
      double& sum = found.emplace_back(0.0);
      for (const auto& [dof, factor] : row.sum) sum += factor * u[dof];
    }
    return found;
  };
  constexpr double a = 7.0, b = L - a;
  const std::vector<double> sections{1.5, 4.0, 7.0, 7.3, 12.0, 18.5};
  const std::vector<double> one = forces(1, a, sections);
  ASSERT_EQ(one.size(), 2 * sections.size());
  for (std::size_t s = 0; s < sections.size(); ++s) {
    const double x = sections[s], moment = x <= a ? P * b * x / L : P * a * (L - x) / L;
    const double shear = x < a ? P * b / L : x > a ? -P * a / L : P * (b - a) / (2.0 * L);
    EXPECT_NEAR(one[s], moment, 1e-9 * P * L) << x;
    EXPECT_NEAR(one[sections.size() + s], shear, 1e-9 * P) << x;
  }
  const std::vector<double> two = forces(2, 0.5 * L, {0.5 * L, 1.5 * L});
  EXPECT_NEAR(two[0], 13.0 / 64.0 * P * L, 1e-9 * P * L);
  EXPECT_NEAR(two[1], -3.0 / 64.0 * P * L, 1e-9 * P * L);
  EXPECT_NEAR(two[3], 3.0 / 32.0 * P, 1e-9 * P);
  EXPECT_THROW(static_cast<void>(forces(2, a, {19.5})), InputError) << "beside the pier, whose row of z is left out";
  EXPECT_THROW(static_cast<void>(forces(2, a, {20.0})), InputError) << "over it";
}

TEST_F(BeamFiles, ADeckIsNeeded) {
  ImportParameters parameters = beam(1);
  parameters.deck = {};
  EXPECT_THROW(static_cast<void>(imported_deck(parameters)), InputError);
}

}  // namespace
}  // namespace railtab
