// Frequencies of simply supported beams against ω_n = (nπ/L)²·sqrt(EI/m): the test beam of the moving-load solutions,
// and the deck of the three-dimensional track–bridge model.

#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <cmath>
#include <numbers>
#include <string>

#include "../measured.hpp"
#include "railtab/runtime/base/dense_solvers.hpp"
#include "railtab/runtime/structure/simple_beam.hpp"
#include "railtab/runtime/structure/stiffness_factor.hpp"
#include "railtab/runtime/structure/track_bridge.hpp"

namespace railtab {
namespace {

constexpr double pi = std::numbers::pi;

Eigen::VectorXd circular_frequencies(const StructureModel& model) {
  return generalised_eigenvalues(Eigen::MatrixXd(model.stiffness), Eigen::MatrixXd(model.mass)).cwiseSqrt();
}

TEST(SimpleBeam, FirstFrequencyIsThePublishedOne) {
  // [YangYau1997]: 30.02 rad/s
  const SimpleBeamParameters p;
  EXPECT_NEAR(circular_frequencies(build_simple_beam(p))[0], 30.02, 0.005);
}

TEST(SimpleBeam, FrequenciesConvergeWithTheFourthOrder) {
  SimpleBeamParameters p;
  for (int n = 1; n <= 3; ++n) {
    const double exact = std::pow(n * pi / p.length, 2) * std::sqrt(p.E * p.I / p.mass);
    double error[2];
    for (const int refined : {0, 1}) {
      p.elements = refined == 0 ? 8 : 16;
      error[refined] = circular_frequencies(build_simple_beam(p))[n - 1] / exact - 1;
    }
    const double order = std::log2(error[0] / error[1]);
    const std::string mode = "beam.mode_" + std::to_string(n);
    testing::measured(mode + ".order", order);
    testing::measured(mode + ".error", error[1]);
    EXPECT_GT(error[1], 0.0);  // a displacement model is too stiff
    EXPECT_GT(order, 3.8);
    EXPECT_LT(order, 4.2);
  }
}

struct Mode {
  double omega;           // [rad/s]
  Eigen::VectorXd shape;  // of unit modal mass
};

/// The mode that the static deflection under a unit load on the deck's midspan leads to, by Rayleigh quotient
/// iteration.
Mode deck_mode(const StructureModel& model, int direction) {
  const Eigen::VectorXd load = Eigen::VectorXd::Unit(model.dofs(), model.nodes.front().dof[direction]);
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> statics(model.stiffness);
  Mode mode;
  mode.shape = statics.solve(load);
  for (int iteration = 0; iteration < 5; ++iteration) {
    const Eigen::VectorXd inertia = model.mass * mode.shape;
    const double omega2 = mode.shape.dot(model.stiffness * mode.shape) / mode.shape.dot(inertia);
    // next to the eigenvalue, not on it: the shifted matrix stays regular
    const Eigen::SparseMatrix<double> shifted = model.stiffness - omega2 * (1 - 1e-9) * model.mass;
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> inverse(shifted);
    mode.shape = inverse.solve(inertia);
    mode.shape /= std::sqrt(mode.shape.dot(model.mass * mode.shape));
  }
  mode.omega = std::sqrt(mode.shape.dot(model.stiffness * mode.shape));
  return mode;
}

double deck_frequency(const StructureModel& model, int direction) { return deck_mode(model, direction).omega; }

TrackParameters track_without_stiffness() {
  TrackParameters track;
  track.length_before = track.length_after = 6.0;
  track.ballast_deck = {1.0, 1.0, 1.0, 0, 0, 0};
  return track;
}

TEST(TrackBridge, BareDeckHasTheFrequenciesOfASimplySupportedBeam) {
  const BridgeParameters span;
  const StructureModel model = build_track_bridge(track_without_stiffness(), {span});
  const double L = span.length;
  const double vertical = pi * pi / (L * L) * std::sqrt(span.E * span.Iy / span.mass);
  const double lateral = pi * pi / (L * L) * std::sqrt(span.E * span.Iz / span.mass);
  const double torsion = pi / L * std::sqrt(span.G * span.J / span.rotary_inertia);
  const double vertical_found = deck_frequency(model, 2), torsion_found = deck_frequency(model, 3);
  testing::measured("deck.bending_Hz", vertical_found / (2 * pi));
  testing::measured("deck.torsion_Hz", torsion_found / (2 * pi));
  EXPECT_NEAR(vertical_found / vertical, 1.0, 1e-6);
  // linear shapes with consistent mass: relative error (π/elements)²/24 = 4.0e-4
  EXPECT_NEAR(torsion_found / torsion - 1.0, std::pow(pi / span.elements, 2) / 24, 1e-5);
  EXPECT_NEAR(vertical / (2 * pi), 5.12, 0.005);  // the published bridge's frequency
  const double lateral_found = deck_frequency(model, 1);
  EXPECT_NEAR(lateral_found / lateral, 1.0, 1e-6);
}

TEST(TrackBridge, TrackChangesTheFrequencyByItsMassAndStiffness) {
  const BridgeParameters span;
  const StructureModel model = build_track_bridge({}, {span});
  const double bare = pi * pi / (span.length * span.length) * std::sqrt(span.E * span.Iy / span.mass);
  const double found = deck_frequency(model, 2);
  const double track_mass = 2 * 60.21 + 251.0 / 0.6;
  const double by_mass_alone = bare * std::sqrt(span.mass / (span.mass + track_mass));
  testing::measured("deck.bending_with_track_Hz", found / (2 * pi));
  EXPECT_GT(found, by_mass_alone);
  EXPECT_LT(found, 1.05 * bare);
}

TEST(TrackBridge, DeckDampingHasTheRatioAskedForAtTheFirstFrequency) {
  BridgeParameters span;
  span.damping_ratio = 0.02;
  const StructureModel model = build_track_bridge(track_without_stiffness(), {span});
  const Mode mode = deck_mode(model, 2);
  EXPECT_NEAR(mode.shape.dot(model.damping * mode.shape) / (2 * mode.omega), 0.02, 1e-7);
}

}  // namespace
}  // namespace railtab
