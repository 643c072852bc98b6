// Supports that the ground moves, and models of the vertical plane alone.

#include <gtest/gtest.h>

#include <cmath>

#include "railtab/runtime/structure/fe_supports.hpp"
#include "railtab/runtime/structure/stiffness_factor.hpp"
#include "railtab/runtime/structure/track_bridge.hpp"
#include "railtab/runtime/vehicle/vehicle_library.hpp"
#include "railtab/runtime/vsi/rail_contact.hpp"
#include "railtab/runtime/vsi/vehicle_response.hpp"

namespace railtab {
namespace {

std::vector<BridgeParameters> two_spans(double offset) {
  BridgeParameters first, second;
  first.length = 12.0;
  second.length = 9.0;
  first.elements = second.elements = 6;
  first.track_offset = second.track_offset = offset;
  return {first, second};
}

TrackParameters short_track() {
  TrackParameters track;
  track.length_before = 6.0;
  track.length_after = 4.8;
  return track;
}

// A unit translation of everything along y (component 0) or z (1), rotations zero: over the unknowns, found from the
// stiffness itself as the answer to supports that all move by 1.
struct Translation {
  Eigen::VectorXd unknowns, supports;
};
Translation translation(const StructureModel& m, int component) {
  Translation t{Eigen::VectorXd::Zero(m.dofs()), Eigen::VectorXd::Zero(m.supports.columns())};
  for (int i = component; i < m.supports.columns(); i += 2) t.supports[i] = 1.0;
  const SparseLdlt factor = stiffness_factor(m.stiffness);
  t.unknowns = factor.solve(-(m.supports.stiffness * t.supports));
  return t;
}

TEST(Supports, SupportsThatMoveAlikeMoveEverythingAlike) {
  const StructureModel m = build_track_bridge(short_track(), two_spans(1.5));
  // two per span, and the ground under the sleepers at x < 0 and x >= 21 m, 0.6 m apart from -6 m to 25.8 m
  EXPECT_EQ(m.supports.x.size(), 4u + 10u + 9u);
  for (int component = 0; component < 2; ++component) {
    const Translation t = translation(m, component);
    for (const RailLine& rail : m.rail) {
      for (const DofIndices& dof : rail.dof) {
        EXPECT_NEAR(t.unknowns[dof[static_cast<std::size_t>(1 + component)]], 1.0, 1e-9);
        EXPECT_NEAR(t.unknowns[dof[3]], 0.0, 1e-9);
      }
    }
    for (const StructureNode& node : m.nodes) {
      EXPECT_NEAR(t.unknowns[node.dof[static_cast<std::size_t>(1 + component)]], 1.0, 1e-9) << node.name;
    }
    // No damper resists it, that in proportion to the deck's mass neither.
    const Eigen::VectorXd damping = m.damping * t.unknowns + m.supports.damping * t.supports;
    EXPECT_LT(damping.cwiseAbs().maxCoeff(), 1e-9 * m.damping.diagonal().maxCoeff());
    // And the inertia is that of the whole: the unknowns' part of it is the mass but for half an element per support.
    const double inertia = t.unknowns.dot(m.mass * t.unknowns + m.supports.mass * t.supports);
    const double sleepers = std::round((25.8 + 6.0) / 0.6) + 1;
    const double at_supports = 0.5 * 33.9e3 * 2.0 * (2.0 + 1.5);
    const double whole = 33.9e3 * 21.0 + 251.0 * sleepers + 2.0 * 60.21 * 0.6 * (sleepers - 1);
    EXPECT_NEAR(inertia, whole - at_supports, 1e-6 * whole) << component;
  }
}

TEST(Supports, OneSupportThatSettlesTurnsItsSpan) {
  const StructureModel m = build_track_bridge(short_track(), two_spans(0.0));
  // supports in order: both ends of the first span, both ends of the second
  Eigen::VectorXd settled = Eigen::VectorXd::Zero(m.supports.columns());
  settled[2 * 1 + 1] = settled[2 * 2 + 1] = 0.01;  // the pier between them
  const SparseLdlt factor = stiffness_factor(m.stiffness);
  const Eigen::VectorXd u = factor.solve(-(m.supports.stiffness * settled));
  // nearly rigid spans: the rails hold them back by less than a thousandth
  EXPECT_NEAR(u[m.nodes[0].dof[2]], 0.005, 5e-6) << m.nodes[0].name;
  EXPECT_NEAR(u[m.nodes[3].dof[2]], 0.005, 5e-6) << m.nodes[3].name;
}

// A deck node of a model of the vertical plane has z alone: what has no row is what is named.
TEST(Supports, ADeckNodeThatNothingMovesNamesTheMissingMotion) {
  const auto beyond = [](const FeNode& node) {
    FeStructure structure;
    structure.nodes[7] = node;
    StructureSupports supports;
    stand_on_ground({7}, structure, supports);
    return supports.beyond;
  };
  FeNode node;
  EXPECT_EQ(beyond(node), "whose deck node 7 has no row of y and none of z, and no [[support]] that holds it there");
  node.rows[2] = {0};
  EXPECT_EQ(beyond(node), "whose deck node 7 has no row of y, and no [[support]] that holds it there");
  node.support[0] = 0;
  EXPECT_EQ(beyond(node), "");
}

TEST(VerticalPlane, TrackAndBridgeDeflectAsInThreeDimensions) {
  const StructureModel plane = build_track_bridge(short_track(), two_spans(0.0), MotionPlane::vertical);
  const StructureModel space = build_track_bridge(short_track(), two_spans(0.0));
  EXPECT_LT(plane.dofs(), 0.55 * space.dofs());
  std::array<Eigen::VectorXd, 2> deflection;
  for (const StructureModel* m : {&plane, &space}) {
    Eigen::VectorXd load = Eigen::VectorXd::Zero(m->dofs());
    for (const RailSide side : {RailSide::left, RailSide::right}) {
      add_rail_load(rail_contact(*m, side, 5.13), {0.0, 50e3, 0.0}, load);
    }
    const SparseLdlt factor = stiffness_factor(m->stiffness);
    const Eigen::VectorXd u = factor.solve(load);
    Eigen::VectorXd& line = deflection[m == &plane ? 0 : 1];
    line.resize(60);
    for (int i = 0; i < 60; ++i) {
      line[i] = rail_head(rail_contact(*m, RailSide::left, -5.0 + 0.5 * i), u)[1];
    }
  }
  EXPECT_LT((deflection[0] - deflection[1]).norm(), 1e-9 * deflection[1].norm());
}

TEST(VerticalPlane, CoachHasTheSameVerticalCompliance) {
  const VehicleModel plane = build_coach(coach_parameters("manchester-coach"), MotionPlane::vertical);
  const VehicleModel space = build_coach(coach_parameters("manchester-coach"));
  EXPECT_EQ(plane.dofs(), 16);
  EXPECT_EQ(space.dofs(), 41);
  const HhtScheme scheme{.alpha = -0.05, .time_step = 1e-3};
  const VehicleResponse a(plane, plane.damping, scheme), b(space, space.damping, scheme);
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      const double expected = b.compliance()(6 * i + 2, 6 * j + 2);
      EXPECT_NEAR(a.compliance()(6 * i + 2, 6 * j + 2), expected, 1e-9 * b.compliance()(2, 2));
    }
    EXPECT_NEAR(plane.static_load[plane.dof[static_cast<std::size_t>(3 + i)][2]],
                space.static_load[space.dof[static_cast<std::size_t>(3 + i)][2]], 1e-6);
  }
}

}  // namespace
}  // namespace railtab
