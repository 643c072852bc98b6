// Numbers side by side against the same operations on single ones.

#include "railtab/runtime/base/lane_numbers.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "railtab/runtime/base/smooth_step.hpp"

namespace railtab {
namespace {

Lanes lanes_from(double first, double step) {
  Lanes x;
  for (int i = 0; i < Lanes::count; ++i) x[i] = first + step * i;
  return x;
}

TEST(LaneNumbers, OperationsAreThoseOfSingleNumbers) {
  const Lanes a = lanes_from(-1.5, 0.5), b = lanes_from(0.75, 0.25);
  const Lanes quotient = a / b, root = sqrt(b), negative = -a, difference = 1.0 - a, product = a * 3.0;
  const Lanes chosen = select(a < b, a, b), least = at_most(a, b), smooth = smooth_step(a);
  for (int i = 0; i < Lanes::count; ++i) {
    EXPECT_EQ(quotient[i], a[i] / b[i]);
    EXPECT_EQ(root[i], std::sqrt(b[i]));
    EXPECT_EQ(negative[i], -a[i]);
    EXPECT_EQ(difference[i], 1.0 - a[i]);
    EXPECT_EQ(product[i], a[i] * 3.0);
    EXPECT_EQ(chosen[i], a[i] < b[i] ? a[i] : b[i]);
    EXPECT_EQ(least[i], at_most(a[i], b[i]));
    EXPECT_EQ(smooth[i], smooth_step(a[i]));
    EXPECT_EQ((a >= b)[i], a[i] >= b[i]);
    EXPECT_EQ((a <= b)[i], a[i] <= b[i]);
    EXPECT_EQ((a > 0.5)[i], a[i] > 0.5);
    EXPECT_EQ((!(a > 0.5))[i], !(a[i] > 0.5));
  }
}

TEST(LaneNumbers, AnyAndAllAskEveryPlace) {
  for (int i = 0; i < Lanes::count; ++i) {
    Lanes one{};
    one[i] = 1.0;
    EXPECT_TRUE(any(one > 0.5));
    EXPECT_FALSE(all(one < 0.5));
    EXPECT_FALSE(any((one > 0.5) & (one < 0.5)));
    EXPECT_TRUE(all((one > 0.5) | (one < 0.5)));
  }
}

TEST(SineCosine, IsExactToRounding) {
  for (const double largest : {0.05, 1.5, 3.0}) {
    const Lanes angle = lanes_from(-largest, largest / 4.0);
    const SineCosineOf<Lanes> of(angle);
    for (int i = 0; i < Lanes::count; ++i) {
      EXPECT_NEAR(of.sine[i], std::sin(angle[i]), 3e-16);
      EXPECT_NEAR(of.cosine[i], std::cos(angle[i]), 3e-16);
      const SineCosine single(angle[i]);
      EXPECT_NEAR(single.sine, std::sin(angle[i]), 3e-16);
      EXPECT_NEAR(single.cosine, std::cos(angle[i]), 3e-16);
    }
  }
}

}  // namespace
}  // namespace railtab
