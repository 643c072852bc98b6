// The joints of the built-in profiles make no local minimum of the distance that the outlines do not have.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/runtime/profile/wheel_rail_pair.hpp"
#include "s1002_definition.hpp"

namespace railtab {
namespace {

constexpr double mm = 1e-3;
constexpr double step = 1e-6;  // [m] of the scan
constexpr int reach = 20;      // steps to each side of a joint

struct GapPair {
  ProfileCurve wheel{standard_profile(ProfileKind::wheel, "S1002", 0.0)};
  ProfileCurve rail{standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)};

  // Slope and second derivative of z over y.
  static double slope(const ProfileCurve& c, double y) {
    const CurvePoint p = c.at(c.s_at_y(y));
    return p.dz / p.dy;
  }
  static double bend(const ProfileCurve& c, double y) {
    const CurvePoint p = c.at(c.s_at_y(y));
    return p.curvature() * std::pow(1 + (p.dz / p.dy) * (p.dz / p.dy), 1.5);
  }
  static double height(const ProfileCurve& c, double y) { return c.at(c.s_at_y(y)).z; }
};

// Joints of the 60E1 head at 1:40 [m]: knots where the curvature jumps (by 9 1/m and more).
std::vector<double> curvature_jumps(const ProfileCurve& curve) {
  std::vector<double> joints;
  const ProfileKnots& k = curve.knots();
  for (std::size_t i = 1; i + 1 < k.s.size(); ++i) {
    const double left = curve.at(k.s[i] - 1e-12).curvature();
    const double right = curve.at(k.s[i]).curvature();
    if (std::abs(left - right) > 0.1) joints.push_back(k.y[i]);
  }
  return joints;
}

// A minimum at sample i is one of the outlines where the gap's slope passes through zero beside it as the curvature
// demands: |slope| there is at most |second derivative| times one step. A step or kink fails that.
int spurious_minima(const std::function<double(double)>& gap, const std::function<double(double)>& slope,
                    const std::function<double(double)>& bend, double joint) {
  int count = 0;
  std::array<double, 2 * reach + 1> value{};
  for (int i = -reach; i <= reach; ++i) value[static_cast<std::size_t>(i + reach)] = gap(joint + i * step);
  for (int i = 1 - reach; i < reach; ++i) {
    const auto k = static_cast<std::size_t>(i + reach);
    if (!(value[k] < value[k - 1] && value[k] <= value[k + 1])) continue;
    const double y = joint + i * step;
    const double steepest = std::max({std::abs(bend(y - step)), std::abs(bend(y)), std::abs(bend(y + step))});
    const bool passes_zero = slope(y - step) < 0 && slope(y + step) > 0;
    if (!passes_zero || slope(y + step) - slope(y - step) > 2.2 * step * steepest) ++count;
  }
  return count;
}

// Shifts of the rail against the wheel [m]: a raster, and for each joint the one at which the outlines are parallel
// there, where a kink of any size would be a minimum.
std::vector<double> shifts(const GapPair& pair, double wheel_joint, double rail_y_limit) {
  std::vector<double> result;
  const double slope = GapPair::slope(pair.wheel, wheel_joint);
  double previous = 0.0;
  for (double y = -rail_y_limit; y <= 0.028; y += 0.25 * mm) {
    const double now = GapPair::slope(pair.rail, y) - slope;
    result.push_back(wheel_joint - y);
    if (y > -rail_y_limit && previous < 0 && now >= 0) {
      double a = y - 0.25 * mm;
      double b = y;
      for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (a + b);
        (GapPair::slope(pair.rail, middle) < slope ? a : b) = middle;
      }
      for (const double offset : {-5e-6, -5e-7, 0.0, 5e-7, 5e-6}) result.push_back(wheel_joint - a + offset);
    }
    previous = now;
  }
  return result;
}

TEST(ProfileGap, NoFalseMinimumAtAJointOfTheWheel) {
  const GapPair pair;
  int scans = 0;
  for (const double joint : testing::s1002_joints) {
    for (const double shift : shifts(pair, joint * mm, 0.042)) {
      const auto gap = [&](double y) { return GapPair::height(pair.rail, y - shift) - GapPair::height(pair.wheel, y); };
      const auto slope = [&](double y) { return GapPair::slope(pair.rail, y - shift) - GapPair::slope(pair.wheel, y); };
      const auto bend = [&](double y) { return GapPair::bend(pair.rail, y - shift) - GapPair::bend(pair.wheel, y); };
      EXPECT_EQ(spurious_minima(gap, slope, bend, joint * mm), 0) << "joint " << joint << " mm, shift " << shift;
      ++scans;
    }
  }
  EXPECT_GT(scans, 7 * 250);
}

TEST(ProfileGap, NoFalseMinimumAtAJointOfTheRail) {
  const GapPair pair;
  const std::vector<double> joints = curvature_jumps(pair.rail);
  ASSERT_EQ(joints.size(), 6u);
  for (const double joint : joints) {
    for (double shift = -8 * mm; shift <= 25 * mm; shift += 0.25 * mm) {
      if (joint + shift < -69 * mm) continue;  // beyond the flange back
      const auto gap = [&](double y) { return GapPair::height(pair.rail, y) - GapPair::height(pair.wheel, y + shift); };
      const auto slope = [&](double y) { return GapPair::slope(pair.rail, y) - GapPair::slope(pair.wheel, y + shift); };
      const auto bend = [&](double y) { return GapPair::bend(pair.rail, y) - GapPair::bend(pair.wheel, y + shift); };
      EXPECT_EQ(spurious_minima(gap, slope, bend, joint), 0) << "joint " << joint << " m, shift " << shift;
    }
  }
}

// The scan sees what it is made for: the published zones with their steps left open have false minima.
TEST(ProfileGap, ScanFindsTheOpenStepsOfThePublishedZones) {
  const GapPair pair;
  int found = 0;
  for (const double joint : {-35.0, -26.0}) {
    for (const double shift : shifts(pair, joint * mm, 0.042)) {
      const auto gap = [&](double y) {
        return GapPair::height(pair.rail, y - shift) - testing::s1002_published(y / mm) * mm;
      };
      const auto slope = [&](double y) { return GapPair::slope(pair.rail, y - shift) - GapPair::slope(pair.wheel, y); };
      const auto bend = [&](double y) { return GapPair::bend(pair.rail, y - shift) - GapPair::bend(pair.wheel, y); };
      found += spurious_minima(gap, slope, bend, joint * mm);
    }
  }
  EXPECT_GT(found, 0);
}

}  // namespace
}  // namespace railtab
