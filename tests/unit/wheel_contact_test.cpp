#include "railtab/runtime/contact/wheel_contact.hpp"
#include "contact_power.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numeric>

#include "railtab/runtime/contact/mean_force.hpp"
#include "railtab/runtime/contact/overlap.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"

namespace railtab {
namespace {

std::shared_ptr<const ContactGeometry> s1002_on_60e1() {
  return std::make_shared<const ContactGeometry>(
      ContactSearch(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "S1002", 0.0)),
                                  ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)), {})));
}

WheelContactModel contact_model(const ContactGeometry& geometry) {
  WheelContactModel model;
  model.geometry = &geometry;
  model.speed = 30.0;
  return model;
}

double total_force(const ContactGeometry& geometry, const WheelsetPose& pose) {
  const ContactPatches patches = geometry.patches(pose);
  const PatchLoads loads = patch_loads({}, geometry, pose, patches);
  return std::accumulate(loads.begin(), loads.begin() + patches.count, 0.0,
                         [](double sum, const PatchLoad& load) { return sum + load.elastic_force; });
}

// Largest jump of the normal force as a wheel held at one height, roll and yaw moves sideways: every change of more
// than 1 kN in 20 um is halved down to 1e-12 m, always towards the half in which the force changes more.
double largest_jump(const ContactGeometry& geometry, const WheelsetPose& line) {
  const auto force = [&](double y) { return total_force(geometry, {y, line.z, line.roll, line.yaw}); };
  constexpr double step = 20e-6;
  double largest = 0.0;
  double previous = force(-8e-3);
  for (int i = 1; i <= 800; ++i) {
    double low = -8e-3 + (i - 1) * step, high = low + step;
    double at_low = previous, at_high = force(high);
    previous = at_high;
    if (std::abs(at_high - at_low) < 1e3 || at_high > 3e5) continue;
    while (high - low > 1e-12) {
      const double middle = 0.5 * (low + high);
      const double at_middle = force(middle);
      const bool left = std::abs(at_middle - at_low) > std::abs(at_high - at_middle);
      (left ? high : low) = middle;
      (left ? at_high : at_low) = at_middle;
    }
    largest = std::max(largest, std::abs(at_high - at_low));
  }
  return largest;
}

TEST(PatchLoads, NormalForceIsContinuousWherePatchesMergeAndArcsJoin) {
  const auto geometry = s1002_on_60e1();
  double largest = 0.0;
  for (int n = 0; n < 72; ++n) {
    const double share = (n + 0.5) / 72.0;
    const WheelsetPose line{0.0, 0.25e-3 + 0.2e-3 * share, -5e-3 + 1e-2 * std::fmod(29.0 * share, 1.0),
                            -0.02 + 0.04 * std::fmod(17.0 * share, 1.0)};
    largest = std::max(largest, largest_jump(*geometry, line));
  }
  std::printf("largest jump of the normal force %.3f N\n", largest);
  EXPECT_LT(largest, 1.0);
}

TEST(PatchLoads, SeparatePatchesCarryTheirFullHertzForce) {
  const auto geometry = s1002_on_60e1();
  const ContactSearch search(geometry->pair());
  int separate = 0;
  for (double y = 4e-3; y < 5e-3; y += 2e-6) {  // the contact jumps from tread to root: there both touch
    const WheelsetPose pose{.y = y, .z = search.touch_height(y, 0.0, 0.0) + 1e-4};
    const ContactPatches patches = geometry->patches(pose);
    if (patches.count != 2) continue;
    if (Overlap(geometry->pair(), pose).saddle(patches.patch[0], patches.patch[1]).penetration > 0.0) continue;
    ++separate;
    const PatchLoads loads = patch_loads({}, *geometry, pose, patches);
    for (std::size_t i = 0; i < 2; ++i) {
      const double d = patches.patch[i].penetration;
      EXPECT_DOUBLE_EQ(loads[i].elastic_force, loads[i].hertz.stiffness * (d * std::sqrt(d)));
    }
  }
  EXPECT_GT(separate, 10);
}

TEST(WheelForce, RailCarriesTheOppositeForceAndTheLeftWheelMirrorsTheRight) {
  const auto geometry = s1002_on_60e1();
  const WheelContactModel model = contact_model(*geometry);
  WheelsetMotion right;
  right.displacement << 0.0, 3e-3, 0.28e-3, 2e-4, 0.0, 3e-3;
  right.velocity << 0.01, 0.02, -0.01, 0.003, 0.05, 0.02;
  RailHeadMotion rail;
  rail.displacement << 2e-4, 1e-4, 1e-3;
  const auto force = [&](WheelSide side, const WheelsetMotion& w, const RailHeadMotion& r) {
    return wheel_force(model, side, w, r, geometry->patches(relative_pose(geometry->pair(), side, w, r)));
  };
  const WheelForce a = force(WheelSide::right, right, rail);
  ASSERT_GT(a.rail[1], 1e4);
  EXPECT_NEAR(a.rail[0], -a.wheelset[1], 1e-9 * a.rail[1]);
  EXPECT_NEAR(a.rail[1], -a.wheelset[2], 1e-9 * a.rail[1]);
  EXPECT_NEAR(a.rail_x, -a.wheelset[0], 1e-9 * a.rail[1]);

  WheelsetMotion left = right;
  RailHeadMotion left_rail = rail;
  for (int k : {1, 3, 5}) {
    left.displacement[k] *= -1.0;
    left.velocity[k] *= -1.0;
  }
  left_rail.displacement[0] *= -1.0;
  left_rail.displacement[2] *= -1.0;
  const WheelForce b = force(WheelSide::left, left, left_rail);
  for (int k = 0; k < 6; ++k) EXPECT_DOUBLE_EQ(b.wheelset[k], (k % 2 == 1 ? -1.0 : 1.0) * a.wheelset[k]) << k;
}

// Without friction the normal forces alone have a power; what friction adds to it is what creep takes.
TEST(WheelForce, CreepPowerIsWhatFrictionTakesFromTheMotion) {
  using testing::power;
  const auto geometry = s1002_on_60e1();
  WheelsetMotion w;
  w.displacement << 0.0, 4.4e-3, 0.28e-3, 2e-4, 0.0, 3e-3;  // tread and root
  w.velocity << 0.01, 0.02, -0.01, 0.03, 0.05, 0.02;
  RailHeadMotion rail;
  rail.displacement << 2e-4, 1e-4, 1e-3;
  rail.velocity << 3e-3, -2e-3, 4e-2;
  rail.yaw = 1e-3;
  rail.slope = -2e-3;
  for (const WheelSide side : {WheelSide::right, WheelSide::left}) {
    if (side == WheelSide::left) {
      for (int k : {1, 3, 5}) w.displacement[k] *= -1.0;
      for (int k : {0, 2}) rail.displacement[k] *= -1.0;
    }
    WheelContactModel model = contact_model(*geometry);
    model.friction_law = {.limit = 0.4, .decay = 0.6, .initial_slope = 0.7};
    const ContactPatches patches = geometry->patches(relative_pose(geometry->pair(), side, w, rail));
    const WheelForce force = wheel_force(model, side, w, rail, patches);
    model.friction = 0.0;
    const WheelForce normal = wheel_force(model, side, w, rail, patches);
    const double taken = power(model, normal, w, rail) - power(model, force, w, rail);
    EXPECT_GT(force.creep_power, 100.0);
    EXPECT_NEAR(force.creep_power, taken, 1e-9 * std::abs(power(model, force, w, rail)) + 1e-6);
    EXPECT_EQ(normal.creep_power, 0.0);
    EXPECT_EQ(normal.pressure, force.pressure);
  }
}

// The tangent against differences of the whole chain, patches searched anew, in displacements that carry velocities.
TEST(WheelForce, TangentIsThatOfTheForce) {
  const auto geometry = s1002_on_60e1();
  const WheelContactModel model = contact_model(*geometry);
  const Vector6 rate = Vector6::Constant(4000.0);
  for (const double y : {0.0, 2e-3, 5.5e-3}) {
    WheelsetMotion wheelset;
    wheelset.displacement << 0.0, y, 0.30e-3, 0.0, 0.0, 1e-3;
    RailHeadMotion rail;
    const auto force = [&](const WheelsetMotion& w, const RailHeadMotion& r) {
      return wheel_force(model, WheelSide::right, w, r,
                         geometry->patches(relative_pose(geometry->pair(), WheelSide::right, w, r)));
    };
    const ContactPatches patches = geometry->patches(relative_pose(geometry->pair(), WheelSide::right, wheelset, rail));
    const Matrix9 tangent = wheel_force_tangent(model, WheelSide::right, wheelset, rail, patches, {rate, rate[0]});
    for (int j = 0; j < 9; ++j) {
      const double step = 1e-8;
      const auto moved = [&](double h) {
        WheelsetMotion w = wheelset;
        RailHeadMotion r = rail;
        if (j < 6) {
          w.displacement[j] += h;
          w.velocity[j] += rate[j] * h;
        } else {
          r.displacement[j - 6] += h;
          r.velocity[j - 6] += rate[j - 6] * h;
        }
        return force(w, r);
      };
      const WheelForce plus = moved(step);
      const WheelForce minus = moved(-step);
      Vector9 difference;
      difference << (plus.wheelset - minus.wheelset) / (2 * step), (plus.rail - minus.rail) / (2 * step);
      const double tolerance = 2e-3 * difference.cwiseAbs().maxCoeff();
      for (int i = 0; i < 9; ++i)
        EXPECT_NEAR(tangent(i, j), difference[i], tolerance) << "y " << y << ", " << i << " by " << j;
    }
  }
}

}  // namespace
}  // namespace railtab
