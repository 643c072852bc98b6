// WheelRailPair: dimensions and gauge point.

#include <gtest/gtest.h>

#include <cmath>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/profile/profile_file.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/runtime/profile/wheel_rail_pair.hpp"

namespace railtab {
namespace {

ProfileCurve s1002() { return ProfileCurve(standard_profile(ProfileKind::wheel, "S1002", 0.0)); }
ProfileCurve rail(const char* name, double inclination) {
  return ProfileCurve(standard_profile(ProfileKind::rail, name, inclination));
}

TEST(WheelRailPair, PlacesTheManchesterCase) {
  const WheelRailPair pair(s1002(), rail("60E1", 1.0 / 40.0), {});
  // Gauge point 43.0385 mm from the highest point of the canted head, half the gauge 717.5 mm: 760.5385 mm.
  EXPECT_NEAR(pair.rail_offset(), 0.7605385, 5e-8);
  EXPECT_DOUBLE_EQ(pair.tape_circle_offset(), 0.750);
  EXPECT_EQ(pair.nominal_radius(), 0.460);
}

// Upright 60E1: 14 mm below the crown the R13 (centre 23.01622, 14.90897 mm) has y = 23.01622 + sqrt(13² - 0.90897²).
TEST(WheelRailPair, FindsTheGaugePointOfTheUprightHead) {
  const WheelRailPair pair(s1002(), rail("60E1", 0.0), {});
  const double y = 23.01622e-3 + std::sqrt(13e-3 * 13e-3 - 0.90897e-3 * 0.90897e-3);
  EXPECT_NEAR(pair.rail_offset(), 0.7175 + y, 2e-8);
  const WheelRailPair china(s1002(), rail("60E1", 0.0), {.track_gauge = 1.4355, .gauge_height = 0.016});
  EXPECT_NEAR(china.rail_offset(), 0.71775 + 35.28701e-3 + 0.05 * 16e-3, 2e-8);  // on the flank there
}

TEST(WheelRailPair, TakesTheGaugePointAsNearestToTheTrackCentre) {
  // Head that is widest 5 mm below the top and recedes below: the gauge point is the widest one above 14 mm depth.
  const std::vector<double> y{-0.030, -0.031, -0.033, -0.035, -0.033, -0.020, 0.0, 0.020, 0.030};
  const std::vector<double> z{0.020, 0.014, 0.009, 0.005, 0.003, 0.001, 0.0, 0.001, 0.010};
  const WheelRailPair pair(s1002(), ProfileCurve(spline_through_points(ProfileKind::rail, "worn", y, z)), {});
  EXPECT_NEAR(pair.rail_offset(), 0.7175 + 0.035, 3e-4);
  EXPECT_GE(pair.rail_offset(), 0.7175 + 0.035);
}

TEST(WheelRailPair, DoesNotDependOnTheOriginOfTheHeight) {
  ProfileKnots raised = standard_profile(ProfileKind::rail, "60E1", 0.025);
  for (double& z : raised.z) z -= 0.172;
  const WheelRailPair pair(s1002(), ProfileCurve(raised), {});
  EXPECT_NEAR(pair.rail_offset(), WheelRailPair(s1002(), rail("60E1", 0.025), {}).rail_offset(), 1e-12);
}

TEST(WheelRailPair, RejectsWhatCannotBePlaced) {
  EXPECT_THROW(WheelRailPair(rail("60E1", 0.0), rail("60E1", 0.0), {}), InputError);
  EXPECT_THROW(WheelRailPair(s1002(), s1002(), {}), InputError);
  EXPECT_THROW(WheelRailPair(s1002(), rail("60E1", 0.0), {.gauge_height = 0.045}), InputError);  // below the flank
  for (const double bad : {std::nan(""), -1.0, 0.0, 1435.0}) {
    EXPECT_THROW(WheelRailPair(s1002(), rail("60E1", 0.0), {.track_gauge = bad}), InputError);
    EXPECT_THROW(WheelRailPair(s1002(), rail("60E1", 0.0), {.flange_back = bad}), InputError);
    EXPECT_THROW(WheelRailPair(s1002(), rail("60E1", 0.0), {.nominal_radius = bad}), InputError);
  }
  EXPECT_THROW(WheelRailPair(s1002(), rail("60E1", 0.0), {.gauge_height = std::nan("")}), InputError);
  EXPECT_NO_THROW(WheelRailPair(s1002(), rail("60E1", 0.0), {.gauge_height = 0.0}));
}

}  // namespace
}  // namespace railtab
