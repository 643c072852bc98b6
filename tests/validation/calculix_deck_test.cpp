// A continuous deck of shells with two girders, its track to one side of them, that CalculiX has assembled: edges,
// twist and roll of the deck under loads on the rails against CalculiX's own statics, which does not know railtab's
// track; the ballast spreads loads over the deck as docs/theory/structure.md says. Skipped where there is no ccx.

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "../measured.hpp"
#include "railtab/runtime/structure/stiffness_factor.hpp"
#include "railtab/runtime/vehicle/vehicle_library.hpp"
#include "railtab/runtime/vsi/simulation.hpp"
#include "shell_deck.hpp"

namespace railtab {
namespace {

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
  return stiffness_factor(model.stiffness).solve(load);
}

TEST_F(ShellDeck, EdgesTwistAndRollAreThoseOfCalculix) {
  if (!installed()) GTEST_SKIP() << missing;
  const std::map<int, double> down = statics(Load::spread_by_ballast), by_points = statics(Load::at_points);
  ASSERT_GT(down.size(), 900U);
  const StructureModel model = imported(rails_that_bear_nothing());
  const Eigen::VectorXd u = under_train(model, bay, span - bay, bay, load);
  const Eigen::VectorXd found = model.deck.rows * u;
  const double largest = down.at(number(15, 0));  // the edge beside the track
  EXPECT_GT(largest, 1e-3);
  DeckDifference by_spread, by_point;
  add(model, found, down, by_spread);
  add(model, found, by_points, by_point);
  EXPECT_EQ(by_spread.edges, 2 * (along + 1));
  EXPECT_GT(by_spread.twists, 40);
  testing::measured("calculix.deck_edge", 100.0 * by_spread.edge.most / largest);
  testing::measured("calculix.deck_edge_points", 100.0 * by_point.edge.most / largest);
  testing::measured("calculix.deck_twist", by_spread.twist.percent());
  testing::measured("calculix.deck_roll", by_spread.roll.percent());
  testing::measured("calculix.deck_edge_mm", 1e3 * largest);
  testing::measured("calculix.deck_track_mm", 1e3 * down.at(number(15, under(track))));
  EXPECT_LT(by_spread.edge.most, 0.005 * largest);
  EXPECT_LT(by_point.edge.most, 0.005 * largest) << "of the edges it matters little how the ballast spreads the loads";
  EXPECT_LT(by_spread.twist.percent(), 0.5);
  EXPECT_LT(by_spread.roll.percent(), 0.5);
}

// A node of shells has no rotation of its own; the record has that of the deck around it.
TEST_F(ShellDeck, RecordedNodesRoll) {
  if (!installed()) GTEST_SKIP() << missing;
  VsiModel model;
  model.vehicle = build_coach(coach_parameters("manchester-coach"));
  model.vehicle_x = {0.0};
  model.structure = share(imported(rails_that_bear_nothing()));
  VsiState state(model);
  state.structure.whole().displacement = under_train(*model.structure, bay, span - bay, bay, load);
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
