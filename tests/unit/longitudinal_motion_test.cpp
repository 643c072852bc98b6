#include "railtab/runtime/structure/longitudinal_motion.hpp"
#include "railtab/runtime/structure/stiffness_factor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace railtab {
namespace {

TrackParameters track_with(LongitudinalMotion motion) {
  TrackParameters track;
  track.length_before = track.length_after = 24.0;
  track.longitudinal = motion;
  return track;
}

/// Displacement of the left rail's nodes, y and z by turns, under loads on both rail heads at x.
Eigen::VectorXd rail_under(const StructureModel& model, double x, double left, double right) {
  Eigen::VectorXd load = Eigen::VectorXd::Zero(model.dofs());
  for (const RailSide side : {RailSide::left, RailSide::right}) {
    const RailInterpolation rows = rail_interpolation(model.rail[static_cast<std::size_t>(side)], x);
    for (std::size_t k = 0; k < 12; ++k) {
      if (rows.dof[k] != held) load[rows.dof[k]] += (side == RailSide::left ? left : right) * rows.z[k];
    }
  }
  const SparseLdlt factor = stiffness_factor(model.stiffness);
  const Eigen::VectorXd moved = factor.solve(load);
  Eigen::VectorXd rail(2 * static_cast<Eigen::Index>(model.rail[0].dof.size()));
  for (std::size_t i = 0; i < model.rail[0].dof.size(); ++i) {
    for (std::size_t k : {1U, 2U}) {
      rail[static_cast<Eigen::Index>(2 * i + k - 1)] = moved[model.rail[0].dof[i][k]];
    }
  }
  return rail;
}

// Pads at a sleeper's top and ballast at its bottom: the balance of its moments about y, with no other restraint of its
// pitch, leaves no force along x in either, so that a load on both rails meets the same structure without them.
TEST(LongitudinalMotion, ASleeperAtRestPassesNoForceOnAlongTheTrack) {
  for (const std::vector<BridgeParameters>& spans : {std::vector<BridgeParameters>{}, {BridgeParameters{}}}) {
    const StructureModel kept = build_track_bridge(track_with(LongitudinalMotion::kept), spans);
    const StructureModel left_out = build_track_bridge(track_with(LongitudinalMotion::left_out), spans);
    for (const double x : {0.3, 7.8}) {
      const Eigen::VectorXd expected = rail_under(kept, x, 6e4, 6e4);
      EXPECT_LT((rail_under(left_out, x, 6e4, 6e4) - expected).norm(), 1e-8 * expected.norm()) << "x = " << x;
    }
  }
}

// Unlike loads turn the sleepers: in yaw they do pass something on.
TEST(LongitudinalMotion, TheChangeBoundsThatOfUnlikeLoads) {
  const double bound = longitudinal_change({}, {BridgeParameters{}}, MotionPlane::spatial);
  EXPECT_GT(bound, 1e-4);
  EXPECT_LT(bound, 0.5 * longitudinal_tolerance);
  const StructureModel kept = build_track_bridge(track_with(LongitudinalMotion::kept), {BridgeParameters{}});
  const StructureModel left_out = build_track_bridge(track_with(LongitudinalMotion::left_out), {BridgeParameters{}});
  const auto sleeper = static_cast<Eigen::Index>(
      std::lower_bound(kept.rail[0].x.begin(), kept.rail[0].x.end(), 7.8 - 1e-9) - kept.rail[0].x.begin());
  for (const double right : {-6e4, 0.0, 3e4}) {
    const double before = rail_under(kept, 7.8, 6e4, right)[2 * sleeper + 1];
    const double after = rail_under(left_out, 7.8, 6e4, right)[2 * sleeper + 1];
    EXPECT_LT(std::abs(after / before - 1.0), bound) << "right wheel: " << right;
  }
}

TEST(LongitudinalMotion, LeavesOutWhatThePlanNames) {
  for (const MotionPlane plane : {MotionPlane::spatial, MotionPlane::vertical}) {
    const StructureModel kept = build_track_bridge(track_with(LongitudinalMotion::kept), {}, plane);
    const StructureModel automatic = build_track_bridge(track_with(LongitudinalMotion::automatic), {}, plane);
    EXPECT_TRUE(kept.left_out.empty());
    ASSERT_EQ(automatic.left_out.size(), 1U);
    const std::string& line = automatic.left_out.front();
    EXPECT_EQ(line.find(std::to_string(kept.dofs() - automatic.dofs()) + " degrees of freedom"), 0U) << line;
    for (const RailLine& rail : automatic.rail) {
      EXPECT_TRUE(std::all_of(rail.dof.begin(), rail.dof.end(), [](const DofIndices& dof) { return dof[0] == held; }));
    }
  }
}

TEST(LongitudinalMotion, IsKeptWhereItChangesMoreThanTheTolerance) {
  TrackParameters stiff = track_with(LongitudinalMotion::automatic);
  stiff.pad.kx = stiff.ballast_ground.kx = stiff.ballast_deck.kx = 1e10;
  EXPECT_GT(longitudinal_change(stiff, {}, MotionPlane::spatial), longitudinal_tolerance);
  EXPECT_TRUE(build_track_bridge(stiff, {}).left_out.empty());
  EXPECT_NE(build_track_bridge(stiff, {}).rail[0].dof[1][0], held);
  stiff.longitudinal = LongitudinalMotion::left_out;
  EXPECT_EQ(build_track_bridge(stiff, {}).rail[0].dof[1][0], held);
}

}  // namespace
}  // namespace railtab
