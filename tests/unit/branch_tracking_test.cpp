#include "railtab/tablegen/branch_tracking.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "railtab/tablegen/cell_trust.hpp"

namespace railtab {
namespace {

std::vector<double> uniform(double low, double high, int nodes) {
  std::vector<double> x;
  for (int i = 0; i < nodes; ++i) x.push_back(low + (high - low) * i / (nodes - 1));
  return x;
}

template <typename Points>
std::vector<std::vector<BranchPoint>> sample(const GeometryGrid& grid, const Points& points_at) {
  std::vector<std::vector<BranchPoint>> nodes;
  for (double roll : grid.roll)
    for (double q : grid.yaw_squared)
      for (double y : grid.lateral) nodes.push_back(points_at(y, q, roll));
  return nodes;
}

std::size_t existing(const GeometryBranch& b) {
  std::size_t count = 0;
  for (double z : b.z_touch) count += !std::isnan(z);
  return count;
}

// Two straight branches that cross in height: which is lowest jumps, but each is one surface. The second lives only on
// the right of an edge that drifts with yaw².
std::vector<BranchPoint> crossing_branches(double y, double q, double /*roll*/) {
  std::vector<BranchPoint> points{{-0.05 * y, -0.05, 0.080 - y, -1.0, 0.040 - 0.5 * y, -0.5}};
  if (y >= -1e-3 + q) points.push_back({0.2e-3 - 0.4 * y, -0.4, 0.060 + 2 * y, 2.0, 0.025 + y, 1.0});
  return points;
}

TEST(BranchTracking, FollowsBranchesThroughTheCrossing) {
  const GeometryGrid grid{uniform(-3e-3, 3e-3, 61), uniform(0, 0.9e-3, 4), {0.0}};
  const std::vector<std::vector<BranchPoint>> nodes = sample(grid, crossing_branches);
  const std::vector<GeometryBranch> branches = track_branches(grid, nodes);
  ASSERT_EQ(branches.size(), 2u);
  EXPECT_EQ(existing(branches[0]), 61u * 4u);
  std::size_t right = 0;
  for (const auto& points : nodes) right += points.size() == 2;
  EXPECT_EQ(existing(branches[1]), right);
  EXPECT_EQ(branches[1].size[1], 4);
  for (std::size_t n = 0; n < branches[0].z_touch.size(); ++n) EXPECT_EQ(branches[0].z_touch_dy[n], -0.05);
}

TEST(BranchTracking, OrderOfThePointsAtANodeDoesNotMatter) {
  const GeometryGrid grid{uniform(-3e-3, 3e-3, 61), uniform(0, 0.9e-3, 4), {0.0}};
  std::vector<std::vector<BranchPoint>> nodes = sample(grid, crossing_branches);
  for (std::size_t n = 0; n < nodes.size(); n += 2) std::reverse(nodes[n].begin(), nodes[n].end());
  const std::vector<GeometryBranch> branches = track_branches(grid, nodes);
  ASSERT_EQ(branches.size(), 2u);
  EXPECT_EQ(std::max(existing(branches[0]), existing(branches[1])), 61u * 4u);
}

// A branch that dies at the same place at which another, a centimetre away on the wheel, is born: two branches.
TEST(BranchTracking, DoesNotJoinAcrossAJump) {
  const GeometryGrid grid{uniform(-1e-3, 1e-3, 21), {0.0}, {0.0}};
  const std::vector<GeometryBranch> branches =
      track_branches(grid, sample(grid, [](double y, double, double) -> std::vector<BranchPoint> {
                       if (y < 0.05e-3) return {{-0.05 * y, -0.05, 0.080 + y, 1.0, 0.040, 0.0}};
                       return {{-0.05 * y, -0.05, 0.070 + y, 1.0, 0.030, 0.0}};
                     }));
  ASSERT_EQ(branches.size(), 2u);
  EXPECT_EQ(existing(branches[0]) + existing(branches[1]), 21u);
}

TEST(BranchTracking, JoinsAcrossASlopeJumpOfAProfileJoint) {
  const GeometryGrid grid{uniform(-1e-3, 1.03e-3, 21), {0.0}, {0.0}};
  const std::vector<GeometryBranch> branches =
      track_branches(grid, sample(grid, [](double y, double, double) -> std::vector<BranchPoint> {
                       const double speed = y < 0 ? 1.0 : 12.0;
                       return {{-0.05 * y, -0.05, 0.080 + speed * y, speed, 0.040 + speed * y, speed}};
                     }));
  EXPECT_EQ(branches.size(), 1u);
}

TEST(CellTrust, WholeBranchesAreTrustedEverywhere) {
  const GeometryGrid grid{uniform(-3e-3, -1.5e-3, 16), uniform(0, 0.9e-3, 4), {0.0}};
  for (double height : trusted_lowering(grid, track_branches(grid, sample(grid, crossing_branches)))) {
    EXPECT_TRUE(std::isinf(height));
  }
}

// At the edge y_e = -1 mm of the second branch (yaw 0) it stands 0.2 mm + 0.35·1 mm = 0.55 mm above the first. Its
// normal (slope -0.4) leans to +y: no cell on the left is touched, those to the right are limited by the normal through
// the end.
TEST(CellTrust, AnEndLimitsItsCellAndThoseAlongItsNormal) {
  const GeometryGrid grid{uniform(-3e-3, 3e-3, 61), {0.0}, {0.0}};
  const std::vector<double> trust = trusted_lowering(grid, track_branches(grid, sample(grid, crossing_branches)));
  const double slope = 0.4;
  // The first node that has the branch is 20 (y = -1.0 mm), give or take the rounding of the node.
  std::size_t end = 0;
  while (std::isinf(trust[end])) ++end;
  EXPECT_TRUE(end == 19 || end == 20);
  EXPECT_NEAR(trust[end], 0.55e-3, 0.05e-3);  // one cell of 0.1 mm times the difference of slopes, 0.35
  for (std::size_t i = 0; i < end; ++i) EXPECT_TRUE(std::isinf(trust[i]));
  const double cosine = 1 / std::hypot(1.0, slope);
  const double rise = 0.1e-3 / (slope * cosine * cosine);  // of the normal above the tangent, per cell
  for (std::size_t m = 2; m < 5; ++m) {
    const double distance = static_cast<double>(m) * 0.1e-3;
    const double end_height = 0.55e-3 - 0.35 * distance;
    EXPECT_NEAR(trust[end + m], end_height + static_cast<double>(m - 1) * rise, 0.05e-3);
  }
}

}  // namespace
}  // namespace railtab
