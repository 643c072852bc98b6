#include "railtab/runtime/structure/track_bridge.hpp"
#include "railtab/runtime/base/dense_solvers.hpp"
#include "railtab/runtime/structure/stiffness_factor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "../measured.hpp"
#include "railtab/runtime/base/input_error.hpp"

namespace railtab {
namespace {

Eigen::VectorXd deflection(const StructureModel& model, const Eigen::VectorXd& load) {
  return stiffness_factor(model.stiffness).solve(load);
}

/// Adds a force at the rail head, lateral (to the right) and vertical (down) [N].
void add_head_force(Eigen::VectorXd& load, const RailLine& rail, double x, double lateral, double vertical) {
  const RailInterpolation rows = rail_interpolation(rail, x);
  for (int k = 0; k < 12; ++k) {
    if (rows.dof[k] != held) load[rows.dof[k]] += lateral * rows.y[k] + vertical * rows.z[k];
  }
}

double head_z(const StructureModel& model, RailSide side, double x, const Eigen::VectorXd& a) {
  const RailInterpolation rows = rail_interpolation(model.rail[static_cast<size_t>(side)], x);
  double z = 0;
  for (int k = 0; k < 12; ++k) {
    if (rows.dof[k] != held) z += rows.z[k] * a[rows.dof[k]];
  }
  return z;
}

const StructureNode& node(const StructureModel& model, const std::string& name) {
  for (const StructureNode& candidate : model.nodes) {
    if (candidate.name == name) return candidate;
  }
  throw std::out_of_range(name);
}

double asymmetry(const Eigen::SparseMatrix<double>& matrix) {
  const Eigen::SparseMatrix<double> transposed = matrix.transpose();
  return (matrix - transposed).norm() / matrix.norm();
}

TEST(TrackBridge, MatricesAreSymmetricAndStiffnessAndMassPositiveDefinite) {
  BridgeParameters eccentric;
  eccentric.track_offset = 2.2;
  for (const std::vector<BridgeParameters>& spans :
       {std::vector<BridgeParameters>{}, {eccentric, BridgeParameters{}}}) {
    const StructureModel model = build_track_bridge({}, spans);
    for (const Eigen::SparseMatrix<double>* matrix : {&model.mass, &model.damping, &model.stiffness}) {
      ASSERT_EQ(matrix->rows(), model.dofs());
      EXPECT_LT(asymmetry(*matrix), 1e-15);
    }
    for (const Eigen::SparseMatrix<double>* matrix : {&model.mass, &model.stiffness}) {
      EXPECT_NO_THROW(SparseLdlt(*matrix, "not positive definite"));
    }
  }
}

TEST(TrackBridge, MassIsThatOfRailsAndSleepers) {
  TrackParameters track;
  track.length_before = track.length_after = 30.0;
  // ballast of next to no stiffness, so that rails moved down by 1 take the sleepers along
  track.ballast_ground = {1e-3, 1e-3, 1e-3, 0, 0, 0};
  const StructureModel model = build_track_bridge(track, {});
  std::vector<char> of_rail(model.dofs(), 0);
  Eigen::VectorXd down = Eigen::VectorXd::Zero(model.dofs());
  for (const RailLine& rail : model.rail) {
    for (const DofIndices& dof : rail.dof) {
      for (const int i : dof) {
        if (i != held) of_rail[i] = 1;
      }
      down[dof[2]] = 1;
    }
    for (const int i : rail.twist_rate) {
      if (i != held) of_rail[i] = 1;
    }
  }
  const double rails = down.dot(model.mass * down);
  EXPECT_NEAR(rails, 2 * 60.21 * 60.0, 1e-9 * rails);

  const Eigen::VectorXd force = model.stiffness * down;
  std::vector<int> sleeper_dofs;
  for (int i = 0; i < model.dofs(); ++i) {
    if (!of_rail[i]) sleeper_dofs.push_back(i);
  }
  ASSERT_EQ(sleeper_dofs.size(), 3u * 101u);
  const Eigen::MatrixXd K = Eigen::MatrixXd(model.stiffness)(sleeper_dofs, sleeper_dofs);
  const Eigen::VectorXd pulled = symmetric_solution(K, -force(sleeper_dofs));
  for (size_t i = 0; i < sleeper_dofs.size(); ++i) down[sleeper_dofs[i]] = pulled[static_cast<Eigen::Index>(i)];
  EXPECT_NEAR(down.dot(model.mass * down), rails + 101 * 251.0, 1e-6 * rails);
}

/// Beam on a Winkler foundation under a point load: w(x) = Pβ/(2k)·e^{-β|x|}(cos βx + sin β|x|).
double winkler(double force, double EI, double k, double x) {
  const double beta = std::pow(k / (4 * EI), 0.25);
  return force * beta / (2 * k) * std::exp(-beta * x) * (std::cos(beta * x) + std::sin(beta * x));
}

TEST(TrackBridge, RailBendsAsABeamOnWinklerFoundation) {
  const double force = 1e5;
  // denser sleepers of accordingly less stiffness: the same foundation, closer to the continuum
  double worst[2];
  for (const int density : {1, 8}) {
    TrackParameters track;
    track.length_before = track.length_after = 18.0;
    track.sleeper_spacing = 0.6 / density;
    for (SupportParameters* support : {&track.pad, &track.ballast_ground}) support->kz /= density;
    const StructureModel model = build_track_bridge(track, {});
    Eigen::VectorXd load = Eigen::VectorXd::Zero(model.dofs());
    for (const RailLine& rail : model.rail) add_head_force(load, rail, 0.0, 0.0, force);
    const Eigen::VectorXd a = deflection(model, load);

    const double k = 1 / (1 / track.pad.kz + 1 / track.ballast_ground.kz) / track.sleeper_spacing;
    const double EI = track.rail.E * track.rail.Iy;
    const double peak = winkler(force, EI, k, 0);
    double& error = worst[density == 1 ? 0 : 1];
    error = 0;
    for (const double x : {0.0, 0.3, 0.6, 1.2, 2.4}) {
      error = std::max(error, std::abs(head_z(model, RailSide::right, x, a) - winkler(force, EI, k, x)) / peak);
    }
    EXPECT_NEAR(head_z(model, RailSide::left, 0.6, a), head_z(model, RailSide::right, 0.6, a), 1e-9 * peak);
    testing::measured(density == 1 ? "track.winkler.apart" : "track.winkler.close", error);
  }
  // the error of the discrete supports falls with the fourth power of their spacing: 8⁴ = 4096
  EXPECT_LT(worst[0], 5e-3);
  EXPECT_GT(worst[0] / worst[1], 2000.0);
  EXPECT_LT(worst[0] / worst[1], 8000.0);
}

/// Rails so limp that each sleeper passes its own load on to the deck.
TrackParameters limp_rails() {
  TrackParameters track;
  track.length_before = track.length_after = 12.0;
  track.rail.E = 1e5;
  track.rail.GJ = 1e-2;
  return track;
}

/// 50 bays: a sleeper stands at midspan, and the sum over the sleepers is the trapezoidal rule on the bridge.
BridgeParameters thirty_metre_span() {
  BridgeParameters span;
  span.length = 30.0;
  return span;
}

/// Half of the given force per length [N/m] on each rail head, gathered at the sleepers of the bridge.
Eigen::VectorXd uniform_load(const StructureModel& model, const TrackParameters& track, double lateral,
                             double vertical) {
  Eigen::VectorXd load = Eigen::VectorXd::Zero(model.dofs());
  for (const RailLine& rail : model.rail) {
    for (int i = 0; i < 50; ++i) {
      const double half = 0.5 * track.sleeper_spacing;
      add_head_force(load, rail, i * track.sleeper_spacing, lateral * half, vertical * half);
    }
  }
  return load;
}

/// Euler–Maclaurin on the influence line of the midspan deflection, whose end slopes are ±L²/(16EI): a load gathered at
/// distance h bends the deck less by the share 0.8·(h/L)². The influence line of the twist is a triangle: no error.
constexpr double sleeper_sum_error = 0.8 * (0.6 / 30.0) * (0.6 / 30.0);

TEST(TrackBridge, DeckUnderUniformVerticalLoadFollowsBeamTheory) {
  const TrackParameters track = limp_rails();
  BridgeParameters span = thirty_metre_span();
  span.track_offset = 2.5;
  const StructureModel model = build_track_bridge(track, {span});
  const double q = 1e5, L = span.length;
  const Eigen::VectorXd a = deflection(model, uniform_load(model, track, 0.0, q));
  const DofIndices& deck = node(model, "deck-midspan-1").dof;
  const double bending = a[deck[2]] / (5 * q * std::pow(L, 4) / (384 * span.E * span.Iy));
  // a track right of the axis turns the deck clockwise as seen forwards
  const double twist = a[deck[3]] / (q * span.track_offset * L * L / (8 * span.G * span.J));
  testing::measured("deck.vertical_load.bending", bending);
  testing::measured("deck.vertical_load.twist", twist);
  EXPECT_NEAR(bending, 1.0 - sleeper_sum_error, 1e-5);
  EXPECT_NEAR(twist, 1.0, 1e-5);
}

TEST(TrackBridge, DeckUnderUniformLateralLoadBendsAndTwistsByItsDepth) {
  const TrackParameters track = limp_rails();
  const BridgeParameters span = thirty_metre_span();
  const StructureModel model = build_track_bridge(track, {span});
  const double q = 1e4, L = span.length;
  const Eigen::VectorXd a = deflection(model, uniform_load(model, track, q, 0.0));
  const DofIndices& deck = node(model, "deck-midspan-1").dof;
  const double bending = a[deck[1]] / (5 * q * std::pow(L, 4) / (384 * span.E * span.Iz));
  const double twist = a[deck[3]] / (q * span.axis_depth * L * L / (8 * span.G * span.J));
  testing::measured("deck.lateral_load.bending", bending);
  testing::measured("deck.lateral_load.twist", twist);
  EXPECT_NEAR(bending, 1.0 - sleeper_sum_error, 1e-5);
  EXPECT_NEAR(twist, 1.0, 1e-5);
}

TEST(TrackBridge, UnitLoadAtMidspanFollowsBeamTheory) {
  TrackParameters track = limp_rails();
  for (SupportParameters* ballast : {&track.ballast_deck, &track.ballast_ground}) ballast->kx = 1e-3;
  const BridgeParameters span = thirty_metre_span();
  const StructureModel model = build_track_bridge(track, {span});
  Eigen::VectorXd load = Eigen::VectorXd::Zero(model.dofs());
  const DofIndices& deck = node(model, "deck-midspan-1").dof;
  load[deck[2]] = 1.0;
  const double expected = std::pow(span.length, 3) / (48 * span.E * span.Iy);
  EXPECT_NEAR(deflection(model, load)[deck[2]] / expected, 1.0, 1e-6);
}

TEST(TrackBridge, TrackStiffensTheDeckOnlySlightly) {
  // the real rails at their real height take a share of the deck's bending through the ballast
  const BridgeParameters span = thirty_metre_span();
  const StructureModel model = build_track_bridge({}, {span});
  Eigen::VectorXd load = Eigen::VectorXd::Zero(model.dofs());
  const DofIndices& deck = node(model, "deck-midspan-1").dof;
  load[deck[2]] = 1.0;
  const double share = deflection(model, load)[deck[2]] * 48 * span.E * span.Iy / std::pow(span.length, 3);
  testing::measured("deck.track_takes_percent", 100.0 * (1.0 - share));
  EXPECT_LT(share, 1.0);
  EXPECT_GT(share, 0.9);
}

TEST(TrackBridge, NamesItsNodesAndCoversTheTrack) {
  TrackParameters track;
  track.length_before = 10.0;  // 16.7 bays: 17
  track.length_after = 12.0;   // 20 bays
  BridgeParameters short_span;
  short_span.length = 24.0;
  const StructureModel model = build_track_bridge(track, {BridgeParameters{}, short_span});
  EXPECT_NEAR(model.rail[0].x.front(), -10.2, 1e-12);
  EXPECT_NEAR(model.rail[0].x.back(), 68.4, 1e-12);
  EXPECT_DOUBLE_EQ(node(model, "deck-midspan-1").x, 16.0);
  EXPECT_DOUBLE_EQ(node(model, "deck-midspan-2").x, 44.0);
  EXPECT_NEAR(node(model, "rail-left-midspan-2").x, 44.0, 0.15 + 1e-12);
  EXPECT_NE(node(model, "rail-left-midspan-1").dof[2], node(model, "rail-right-midspan-1").dof[2]);
  EXPECT_EQ(node(build_track_bridge(track, {}), "rail-right-origin").x, 0.0);
}

TEST(TrackBridge, UnknownsOfARailsNodeAreOneNodeOfTheMesh) {
  const StructureModel model = build_track_bridge(TrackParameters{}, {BridgeParameters{}});
  std::set<int> nodes;
  for (const RailLine& rail : model.rail) {
    for (std::size_t i = 0; i < rail.x.size(); ++i) {
      const auto node_of = [&](int dof) { return model.dof_node[static_cast<std::size_t>(dof)]; };
      const int node = node_of(rail.dof[i][2]);
      EXPECT_TRUE(nodes.insert(node).second) << i;
      for (const int dof : head_dofs(rail, i)) {
        if (dof != held) {
          EXPECT_EQ(node_of(dof), node) << i;
        }
      }
    }
  }
}

TEST(TrackBridge, EndsOfTheRailsAreGuided) {
  const StructureModel model = build_track_bridge({}, {});
  for (const RailLine& rail : model.rail) {
    for (const DofIndices& dof : {rail.dof.front(), rail.dof.back()}) {
      EXPECT_EQ(dof[0], held);
      EXPECT_NE(dof[1], held);
      EXPECT_NE(dof[2], held);
      EXPECT_NE(dof[3], held);
      EXPECT_EQ(dof[4], held);
      EXPECT_EQ(dof[5], held);
    }
    EXPECT_EQ(rail.twist_rate.front(), held);
    EXPECT_EQ(rail.twist_rate.back(), held);
    EXPECT_EQ(std::count(rail.twist_rate.begin(), rail.twist_rate.end(), held), 2);
  }
}

std::string message_of(const std::function<void(TrackParameters&, BridgeParameters&)>& change) {
  TrackParameters track;
  BridgeParameters span;
  change(track, span);
  try {
    (void)build_track_bridge(track, {span});
  } catch (const InputError& error) {
    return error.what();
  }
  return "no InputError";
}

TEST(TrackBridge, RejectsWrongParameters) {
  EXPECT_EQ(message_of([](auto& track, auto&) { track.elements_per_bay = 1; }), "no InputError");
  EXPECT_NE(message_of([](auto& track, auto&) { track.pad.kz = 0; }).find("track.pad.kz: found 0"), std::string::npos);
  EXPECT_NE(message_of([](auto& track, auto&) { track.ballast_deck.cy = -1; }).find("track.ballast_deck.cy: found -1"),
            std::string::npos);
  EXPECT_NE(message_of([](auto& track, auto&) { track.sleeper_spacing = 0; }).find("track.sleeper_spacing: found 0"),
            std::string::npos);
  EXPECT_NE(message_of([](auto& track, auto&) { track.rail.head_height = 0.2; }).find("track.rail.head_height"),
            std::string::npos);
  EXPECT_NE(message_of([](auto& track, auto&) { track.length_before = 1e9; }).find("track.length_before"),
            std::string::npos);
  EXPECT_NE(
      message_of([](auto& track, auto&) { track.elements_per_bay = 21; }).find("track.elements_per_bay: found 21"),
      std::string::npos);
  EXPECT_NE(message_of([](auto&, auto& span) { span.elements = 7; }).find("bridge.elements: found 7"),
            std::string::npos);
  EXPECT_NE(message_of([](auto&, auto& span) { span.E = NAN; }).find("bridge.E: found nan"), std::string::npos);
  EXPECT_NE(message_of([](auto&, auto& span) { span.damping_ratio = 5; }).find("bridge.damping_ratio: found 5"),
            std::string::npos);
}

}  // namespace
}  // namespace railtab
