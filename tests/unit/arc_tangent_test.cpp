#include "railtab/tables/arc_tangent.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace railtab {
namespace {

TEST(ArcTangent, IsThatOfTheCLibrary) {
  const ArcTangent arc_tangent;
  std::mt19937_64 random(20261128);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int n = 0; n < 10'000; ++n) {
    Lanes y, x;
    for (int i = 0; i < Lanes::count; ++i) {  // steep and flat ones to all powers, and those about 45 degrees
      const double spread = n % 2 == 0 ? 12.0 : 0.1;
      y[i] = std::pow(10.0, spread * uniform(random));
      x[i] = std::copysign(std::pow(10.0, spread * uniform(random)), uniform(random));
    }
    const Lanes angle = arc_tangent.angle(y, x);
    for (int i = 0; i < Lanes::count; ++i) {
      EXPECT_NEAR(angle[i], std::atan2(y[i], x[i]), 1e-15 * angle[i]);
      EXPECT_NEAR(angle[i], arc_tangent.angle(y[i], x[i]), 1e-15 * angle[i]);
    }
  }
}

TEST(ArcTangent, OnTheAxes) {
  const ArcTangent arc_tangent;
  EXPECT_EQ(arc_tangent.angle(0.0, 0.0), 0.0);
  EXPECT_EQ(arc_tangent.angle(0.0, 2.0), 0.0);
  EXPECT_EQ(arc_tangent.angle(0.0, -2.0), std::atan2(0.0, -2.0));
  EXPECT_EQ(arc_tangent.angle(2.0, 0.0), std::atan2(2.0, 0.0));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(arc_tangent.angle(nan, 1.0)));
  EXPECT_TRUE(std::isnan(arc_tangent.angle(1.0, nan)));
}

}  // namespace
}  // namespace railtab
