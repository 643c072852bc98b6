#include "railtab/runtime/contact/contact_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <new>
#include <random>
#include <vector>

#include "contact_test_pairs.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/contact/paper_search.hpp"

namespace {
std::atomic<long> allocations{0};
}

// Every allocation of this program is counted, for the proof that queries make none.
void* operator new(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace railtab {
namespace {

using contact_test::cone_on_circle;
using contact_test::s1002_on_60e1;

const ContactSearch& search() {
  static const ContactSearch s(s1002_on_60e1());
  return s;
}

std::vector<WheelsetPose> random_poses(int count, double lowering) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<WheelsetPose> poses;
  for (int i = 0; i < count; ++i) {
    WheelsetPose p;
    p.y = -0.010 + 0.020 * unit(engine);
    p.roll = -0.010 + 0.020 * unit(engine);
    p.yaw = -0.030 + 0.060 * unit(engine);
    p.z = search().touch_height(p.y, p.roll, p.yaw) + lowering * unit(engine);
    poses.push_back(p);
  }
  return poses;
}

/// Lowest z at which the wheel's true surface, sampled over arc length and angle, meets the rail; the sampling closes
/// in on the lowest point until it is resolved to rounding.
double touch_height_by_sampling(const WheelRailPair& pair, double y, double roll, double yaw) {
  double s_from = pair.wheel().s_begin();
  double s_to = pair.wheel().s_end();
  double theta_from = -0.25;
  double theta_to = 0.25;
  double best = std::numeric_limits<double>::infinity();
  for (int level = 0; level < 10; ++level) {
    const int n_s = level == 0 ? 500 : 40;
    const int n_theta = level == 0 ? 80 : 40;
    double s_best = 0.0;
    double theta_best = 0.0;
    for (int i = 0; i <= n_s; ++i) {
      const double s = s_from + (s_to - s_from) * i / n_s;
      const CurvePoint w = pair.wheel().at(s);
      const double a = pair.tape_circle_offset() + w.y;
      const double R = pair.nominal_radius() + w.z;
      for (int j = 0; j <= n_theta; ++j) {
        const double theta = theta_from + (theta_to - theta_from) * j / n_theta;
        const double py = std::sin(yaw) * R * std::sin(theta) + std::cos(yaw) * a;
        const double pz = R * std::cos(theta);
        const double y_rail = y - pair.rail_offset() + std::cos(roll) * py - std::sin(roll) * pz;
        const double z = -pair.nominal_radius() + std::sin(roll) * py + std::cos(roll) * pz;
        if (y_rail < pair.rail().at(pair.rail().s_begin()).y || y_rail > pair.rail().at(pair.rail().s_end()).y)
          continue;
        const double gap = pair.rail().at(pair.rail().s_at_y(y_rail)).z - z;
        if (gap >= best) continue;
        best = gap;
        s_best = s;
        theta_best = theta;
      }
    }
    const double ds = 3.0 * (s_to - s_from) / n_s;
    const double dtheta = 3.0 * (theta_to - theta_from) / n_theta;
    s_from = std::max(s_best - ds, pair.wheel().s_begin());
    s_to = std::min(s_best + ds, pair.wheel().s_end());
    theta_from = theta_best - dtheta;
    theta_to = theta_best + dtheta;
  }
  return best;
}

TEST(ContactSearch, TouchHeightIsThatOfTheThreeDimensionalConeOnACircle) {
  const WheelRailPair pair = cone_on_circle(0.1, 0.05);
  const ContactSearch cone(pair);
  for (const auto& [y, roll, yaw] :
       {std::array{0.0, 0.0, 0.0}, std::array{0.004, 0.01, 0.03}, std::array{-0.007, -0.008, -0.02}}) {
    EXPECT_NEAR(cone.touch_height(y, roll, yaw), touch_height_by_sampling(pair, y, roll, yaw), 1e-11);
  }
}

TEST(ContactSearch, TouchHeightIsThatOfTheThreeDimensionalWheelInFlangeAndTreadContact) {
  for (const auto& [y, roll, yaw] : {std::array{0.0085, -0.006, 0.03}, std::array{0.003, 0.002, -0.03}}) {
    EXPECT_NEAR(search().touch_height(y, roll, yaw), touch_height_by_sampling(s1002_on_60e1(), y, roll, yaw), 1e-10);
  }
}

// Deepest pairs by sampling, for poses with one patch or more: every wheel point's nearest rail point, both outlines
// 2 µm fine, local maxima of the depth. A sampled nearest distance is too large by at most (1 µm)²/(2·depth).
TEST(ContactSearch, PenetrationIsTheDeepestNearestDistance) {
  const WheelRailPair& pair = s1002_on_60e1();
  for (const WheelsetPose& base :
       {WheelsetPose{0.0, 0, 0, 0}, WheelsetPose{0.0049, 0, -0.0003, 0.012}, WheelsetPose{0.0075, 0, -0.006, 0.02}}) {
    WheelsetPose pose = base;
    pose.z = search().touch_height(base.y, base.roll, base.yaw) + 2.5e-4;
    const ContactPatches patches = search().patches(pose);
    ASSERT_GT(patches.count, 0);
    const PoseTrigonometry trig(pose);
    for (const ContactPatch& patch : patches) {
      double deepest = 0.0;
      for (int i = -100; i <= 100; ++i) {
        const CurvePoint w = pair.wheel().at(patch.s_wheel + 2e-6 * i);
        const SilhouettePoint S = placed(silhouette_point(w, pair.tape_circle_offset(), pair.nominal_radius(), trig),
                                         wheelset_centre(pair, pose), trig);
        double nearest = std::numeric_limits<double>::infinity();
        for (int j = -400; j <= 400; ++j) {
          const CurvePoint C = pair.rail().at(patch.s_rail + 2e-6 * j);
          nearest = std::min(nearest, std::hypot(S.y - C.y, S.z - C.z));
        }
        deepest = std::max(deepest, nearest);
      }
      EXPECT_NEAR(deepest, patch.penetration, 1e-12 / (2.0 * patch.penetration) + 1e-11);
      EXPECT_GE(deepest, patch.penetration - 1e-13);
    }
  }
}

TEST(ContactSearch, PenetrationIsThatOfTheShiftedTouch) {
  // d along the normal from the touch at the shifted pose: y* = y - d n_y, z - z_touch(y*) = d n_z.
  for (const WheelsetPose& pose : random_poses(200, 3e-4)) {
    const ContactPatches patches = search().patches(pose);
    for (const ContactPatch& p : patches) {
      const double y = pose.y + p.penetration * std::sin(p.angle);
      const double z = pose.z - p.penetration * std::cos(p.angle);
      double nearest = std::numeric_limits<double>::infinity();
      for (const TouchPoint& t : search().touches(y, pose.roll, pose.yaw)) {
        if (std::abs(t.s_wheel - p.s_wheel) < 1e-6) nearest = std::min(nearest, std::abs(t.z_touch - z));
      }
      EXPECT_LT(nearest, 1e-13) << pose.y << ' ' << pose.roll << ' ' << pose.yaw;
    }
  }
}

TEST(ContactSearch, IsEvenInYaw) {
  for (const WheelsetPose& pose : random_poses(100, 3e-4)) {
    WheelsetPose turned = pose;
    turned.yaw = -pose.yaw;
    const ContactPatches a = search().patches(pose);
    const ContactPatches b = search().patches(turned);
    ASSERT_EQ(a.count, b.count);
    for (int i = 0; i < a.count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      EXPECT_EQ(a.patch[k].s_wheel, b.patch[k].s_wheel);
      EXPECT_EQ(a.patch[k].penetration, b.patch[k].penetration);
      EXPECT_EQ(a.patch[k].x, -b.patch[k].x);
    }
  }
}

TEST(ContactSearch, PatchesBeginAtTheTouchHeight) {
  for (WheelsetPose pose : random_poses(300, 0.0)) {
    const double touch = pose.z;
    pose.z = touch - 1e-9;
    EXPECT_EQ(search().patches(pose).count, 0);
    const ContactPatches near = search().patches(pose, 1e-8);
    EXPECT_GE(near.count, 1);
    pose.z = touch + 1e-9;
    const ContactPatches patches = search().patches(pose);
    ASSERT_GE(patches.count, 1) << pose.y << ' ' << pose.roll << ' ' << pose.yaw;
    double deepest = 0.0;
    for (const ContactPatch& p : patches) deepest = std::max(deepest, p.penetration / std::cos(p.angle));
    EXPECT_NEAR(deepest, 1e-9, 1e-12);
  }
}

TEST(ContactSearch, ReportsGapsUpToTheNearMiss) {
  for (WheelsetPose pose : random_poses(200, 3e-4)) {
    const ContactPatches near = search().patches(pose, 5e-4);
    const ContactPatches touching = search().patches(pose);
    int expected = 0;
    for (const ContactPatch& p : near) {
      EXPECT_GT(p.penetration, -5e-4);
      if (p.penetration > 0.0) ++expected;
    }
    EXPECT_EQ(touching.count, expected);
  }
}

TEST(ContactSearch, FindsWhatAScanTwelveTimesFinerFinds) {
  static const ContactSearch fine(s1002_on_60e1(), 0.02e-3);
  for (const WheelsetPose& pose : random_poses(2000, 3e-4)) {
    const ContactPatches a = search().patches(pose);
    const ContactPatches b = fine.patches(pose);
    ASSERT_EQ(a.count, b.count) << pose.y << ' ' << pose.z << ' ' << pose.roll << ' ' << pose.yaw;
    for (int i = 0; i < a.count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      EXPECT_NEAR(a.patch[k].penetration, b.patch[k].penetration, 1e-14);
    }
  }
}

TEST(ContactSearch, TouchDerivativesAgreeWithDifferences) {
  const double h = 1e-7;
  int compared = 0;
  for (const WheelsetPose& pose : random_poses(100, 0.0)) {
    const auto at = [&](double dy, double droll, double s_near) -> const TouchPoint* {
      static TouchPoints found;
      found = search().touches(pose.y + dy, pose.roll + droll, pose.yaw);
      const TouchPoint* nearest = nullptr;
      for (const TouchPoint& t : found) {
        if (std::abs(t.s_wheel - s_near) < 2e-5) nearest = &t;
      }
      return nearest;
    };
    for (const TouchPoint t : search().touches(pose.y, pose.roll, pose.yaw)) {
      const TouchPoint* p = at(h, 0.0, t.s_wheel);
      if (!p) continue;  // the branch ends or moves fast here
      const TouchPoint above = *p;
      p = at(-h, 0.0, t.s_wheel);
      if (!p) continue;
      const TouchPoint below = *p;
      EXPECT_NEAR((above.z_touch - below.z_touch) / (2 * h), t.z_touch_dy, 3e-4);
      // A joint of the profiles in between changes the derivative of the arc lengths by a jump.
      const bool joint = std::abs(above.s_wheel_dy - below.s_wheel_dy) > 1e-2 * std::abs(t.s_wheel_dy);
      if (joint) continue;
      EXPECT_NEAR((above.s_wheel - below.s_wheel) / (2 * h), t.s_wheel_dy, 1e-2 * std::abs(t.s_wheel_dy) + 1e-6);
      EXPECT_NEAR((above.s_rail - below.s_rail) / (2 * h), t.s_rail_dy, 1e-2 * std::abs(t.s_rail_dy) + 1e-6);
      p = at(0.0, h, t.s_wheel);
      if (!p) continue;
      const double z_above = p->z_touch;
      p = at(0.0, -h, t.s_wheel);
      if (!p) continue;
      EXPECT_NEAR((z_above - p->z_touch) / (2 * h), t.z_touch_droll, 3e-4);
      ++compared;
    }
  }
  EXPECT_GT(compared, 100);
}

TEST(ContactSearch, TouchesHoldTheFirstTouchAndAllWithinTheHeight) {
  for (const WheelsetPose& pose : random_poses(100, 0.0)) {
    const TouchPoints low = search().touches(pose.y, pose.roll, pose.yaw, 1e-3);
    const TouchPoints high = search().touches(pose.y, pose.roll, pose.yaw, 3e-3);
    double least = std::numeric_limits<double>::infinity();
    for (const TouchPoint& t : high) least = std::min(least, t.z_touch);
    EXPECT_NEAR(least, pose.z, 1e-14);
    int within = 0;
    for (const TouchPoint& t : high) within += t.z_touch <= least + 1e-3 ? 1 : 0;
    EXPECT_EQ(low.count, within);
    for (int i = 1; i < high.count; ++i) {
      EXPECT_GT(high.touch[static_cast<std::size_t>(i)].s_wheel, high.touch[static_cast<std::size_t>(i - 1)].s_wheel);
    }
  }
}

TEST(ContactSearch, AnOpenEndIsNoContact) {
  // A cone whose radius grows outwards touches a circle of 50 mm at y_rail = 50 mm sin(atan 0.1) = 4.975 mm. Its cut
  // end stands before that point in the first pose, beyond it in the second: then the least gap is at the cut.
  const ContactSearch cone(cone_on_circle(-0.1, 0.05));
  const WheelRailPair& pair = cone.pair();
  const double cut = pair.tape_circle_offset() + pair.wheel().at(pair.wheel().s_begin()).y - pair.rail_offset();
  EXPECT_EQ(cone.touches(0.0048 - cut, 0.0, 0.0).count, 1);
  const double z = cone.touch_height(0.0048 - cut, 0.0, 0.0) + 1e-4;
  EXPECT_EQ(cone.patches({0.0048 - cut, z, 0.0, 0.0}).count, 1);
  EXPECT_EQ(cone.touches(0.0052 - cut, 0.0, 0.0).count, 0);
  EXPECT_EQ(cone.patches({0.0052 - cut, z, 0.0, 0.0}).count, 0);
  EXPECT_TRUE(std::isnan(cone.touch_height(0.3, 0.0, 0.0)));
  EXPECT_EQ(cone.patches({0.3, 0.5, 0.0, 0.0}).count, 0);
  EXPECT_EQ(cone.touches(0.3, 0.0, 0.0).count, 0);
}

TEST(ContactSearch, PatchesAreCommonNormalsInWideRanges) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const WheelRailPair& pair = s1002_on_60e1();
  for (int i = 0; i < 3000; ++i) {
    const WheelsetPose pose{0.05 * unit(engine), 0.02 * unit(engine), 0.05 * unit(engine), 0.06 * unit(engine)};
    const PoseTrigonometry trig(pose);
    const ContactPatches patches = search().patches(pose);
    for (const ContactPatch& p : patches) {
      EXPECT_GT(p.penetration, 0.0);
      EXPECT_TRUE(pair.wheel().contains(p.s_wheel));
      EXPECT_TRUE(pair.rail().contains(p.s_rail));
      const SilhouettePoint S =
          placed(silhouette_point(pair.wheel().at(p.s_wheel), pair.tape_circle_offset(), pair.nominal_radius(), trig),
                 wheelset_centre(pair, pose), trig);
      // At depths of the rail's radius (beyond all use) the foot is found to less than rounding.
      EXPECT_NEAR(S.y, p.y_rail - p.penetration * std::sin(p.angle), p.penetration > 2e-3 ? 1e-9 : 1e-12);
      EXPECT_NEAR(S.z, p.z_rail + p.penetration * std::cos(p.angle), p.penetration > 2e-3 ? 1e-9 : 1e-12);
    }
    for (int k = 1; k < patches.count; ++k) {
      EXPECT_GT(patches.patch[static_cast<std::size_t>(k)].y_rail,
                patches.patch[static_cast<std::size_t>(k - 1)].y_rail);
    }
  }
}

TEST(ContactSearch, QueriesDoNotAllocate) {
  const std::vector<WheelsetPose> poses = random_poses(200, 3e-4);
  static const PaperSearch paper(s1002_on_60e1());
  const long before = allocations;
  double sum = 0.0;
  for (const WheelsetPose& pose : poses) {
    sum += search().patches(pose, 1e-4).count + search().touches(pose.y, pose.roll, pose.yaw).count;
    sum += search().touch_height(pose.y, pose.roll, pose.yaw) + paper.patches(pose).count;
  }
  sum += rigid_position(search(), 0.004, 0.01).z;
  EXPECT_EQ(allocations, before);
  EXPECT_GT(sum, 0.0);
}

TEST(ContactSearch, RejectsASpacingThatCannotBe) {
  EXPECT_THROW(ContactSearch(s1002_on_60e1(), 0.0), InputError);
  EXPECT_THROW(ContactSearch(s1002_on_60e1(), 0.02), InputError);
}

TEST(RigidPosition, PutsBothWheelsOnTheirRails) {
  for (const double y : {-0.011, -0.0063, -0.002, 0.0, 0.0025, 0.0062, 0.00635, 0.010}) {
    for (const double yaw : {0.0, 0.024}) {
      const RigidPosition r = rigid_position(search(), y, yaw);
      ASSERT_TRUE(r.converged) << y;
      EXPECT_NEAR(search().touch_height(y, r.roll, yaw), r.z, 1e-12);
      EXPECT_NEAR(search().touch_height(-y, -r.roll, yaw), r.z, 1e-12);
      const RigidPosition mirrored = rigid_position(search(), -y, -yaw);
      EXPECT_NEAR(mirrored.roll, -r.roll, 1e-12);
      EXPECT_NEAR(mirrored.z, r.z, 1e-12);
    }
  }
}

TEST(RigidPosition, SaysWhereAWheelIsOffItsRail) { EXPECT_FALSE(rigid_position(search(), 0.3, 0.0).converged); }

// A minimum born at a joint of a profile between two scan points: here the 80 mm and 300 mm arcs of the rail meet under
// the tread.
TEST(ContactSearch, FindsMinimaJustBorn) {
  const ContactSearch search(s1002_on_60e1());
  const ContactSearch finer(s1002_on_60e1(), 0.02e-3);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> y(-0.5e-3, 0.0), yaw(-0.03, 0.03), dz(0, 3e-4);
  const auto touching = [](const ContactPatches& patches) {
    return std::count_if(patches.begin(), patches.end(), [](const ContactPatch& p) { return p.penetration > 1e-7; });
  };
  long two = 0;
  for (int n = 0; n < 10000; ++n) {
    WheelsetPose pose{y(random), 0, 0, yaw(random)};
    pose.z = search.touch_height(pose.y, pose.roll, pose.yaw) + dz(random);
    const auto found = touching(search.patches(pose));
    EXPECT_EQ(found, touching(finer.patches(pose))) << pose.y << " " << pose.yaw << " " << pose.z;
    two += found == 2;
  }
  EXPECT_GT(two, 1000);
}

}  // namespace
}  // namespace railtab
