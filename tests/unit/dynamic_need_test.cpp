// EN 1991-2, 6.4.4: whether a dynamic analysis is asked for.
#include "railtab/runtime/assessment/dynamic_need.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace railtab {
namespace {

DynamicNeed need(double kmh, double span, double n0, bool simple = true) {
  return dynamic_need(kmh / 3.6, span, n0, simple).need;
}

TEST(DynamicNeed, LimitsOfTheFirstFrequencyMeetAt20Metres) {
  EXPECT_NEAR(lower_frequency_limit(20.0), 4.0, 1e-12);
  EXPECT_NEAR(lower_frequency_limit(20.0 + 1e-9), 4.0, 5e-3);
  EXPECT_NEAR(lower_frequency_limit(10.0), 8.0, 1e-12);
  EXPECT_NEAR(upper_frequency_limit(1.0), 94.76, 1e-12);
  EXPECT_NEAR(lower_frequency_limit(25.0), 3.507, 1e-3);
  EXPECT_NEAR(upper_frequency_limit(25.0), 8.530, 1e-3);
}

TEST(DynamicNeed, FollowsTheFlowChart) {
  EXPECT_EQ(need(200.0, 25.0, 4.0), DynamicNeed::not_required);
  EXPECT_EQ(need(200.0, 25.0, 3.0), DynamicNeed::required);
  EXPECT_EQ(need(200.0, 20.0, std::nextafter(4.0, 0.0)), DynamicNeed::not_required) << "at the limit but for rounding";
  EXPECT_EQ(need(200.0, 20.0, 4.0 * (1.0 - 1e-6)), DynamicNeed::required);
  EXPECT_EQ(need(200.0, 25.0, 9.0), DynamicNeed::required);
  EXPECT_EQ(need(201.0, 25.0, 4.0), DynamicNeed::required);
  EXPECT_EQ(need(300.0, 50.0, 3.0), DynamicNeed::not_required);
  EXPECT_EQ(need(300.0, 50.0, 2.0), DynamicNeed::required);
  EXPECT_EQ(need(160.0, 120.0, 1.0), DynamicNeed::required) << "the limits end at 100 m";
  EXPECT_EQ(need(160.0, 0.0, 4.0, false), DynamicNeed::undecided);
  EXPECT_EQ(need(250.0, 0.0, 4.0, false), DynamicNeed::required);
}

TEST(DynamicNeed, DynamicFactorOfCarefullyMaintainedTrack) {
  EXPECT_NEAR(dynamic_factor_2(25.0), 1.44 / 4.8 + 0.82, 1e-12);
  EXPECT_EQ(dynamic_factor_2(2.0), 1.67);
  EXPECT_EQ(dynamic_factor_2(200.0), 1.0);
}

}  // namespace
}  // namespace railtab
