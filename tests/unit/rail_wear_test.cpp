#include "railtab/runtime/measures/rail_wear.hpp"

#include <gtest/gtest.h>

namespace railtab {
namespace {

TEST(RailWear, IsNoneWithoutWay) {
  RailWear wear;
  EXPECT_FALSE(wear.largest());
  wear.add(3.0, 50.0, 3.0, 60.0);
  EXPECT_FALSE(wear.largest());
}

// 100 J/m all along leave 100 J in a metre, whatever the steps; a second wheel adds its own.
TEST(RailWear, AddsUpTheWheelsOverEachMetre) {
  RailWear wear;
  for (double x = -0.7; x < 3.9; x += 0.35) wear.add(x, 100.0, x + 0.35, 100.0);
  ASSERT_TRUE(wear.largest());
  EXPECT_NEAR(wear.largest()->energy, 100.0, 1e-12);
  wear.add(1.25, 40.0, 2.5, 40.0);  // three quarters of metre 1, half of metre 2
  EXPECT_NEAR(wear.largest()->energy, 130.0, 1e-12);
  EXPECT_EQ(wear.largest()->begin, 1.0);
  wear.add(-5.5, 500.0, -5.1, 500.0);  // behind all that was there
  EXPECT_NEAR(wear.largest()->energy, 200.0, 1e-12);
  EXPECT_EQ(wear.largest()->begin, -6.0);
}

TEST(RailWear, IntegratesTheLineBetweenValues) {
  RailWear wear;
  wear.add(0.0, 0.0, 3.0, 300.0);  // 50, 150, 250 J
  EXPECT_NEAR(wear.largest()->energy, 250.0, 1e-12);
  EXPECT_EQ(wear.largest()->begin, 2.0);
}

}  // namespace
}  // namespace railtab
