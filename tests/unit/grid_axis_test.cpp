#include "railtab/tables/grid_axis.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::vector<double> uniform(double low, double high, int nodes) {
  std::vector<double> x;
  for (int i = 0; i < nodes; ++i) x.push_back(low + (high - low) * i / (nodes - 1));
  return x;
}

TEST(GridAxis, LocatesEveryValueInUniformAndUnevenAxes) {
  std::mt19937 random(3);
  for (const std::vector<double>& nodes :
       {uniform(-0.012, 0.012, 241), std::vector<double>{-1, -0.9, 0, 0.25, 7}, std::vector<double>{2, 3}}) {
    const GridAxis axis("test", nodes);
    std::uniform_real_distribution<double> inside(nodes.front(), nodes.back());
    for (int n = 0; n < 2000; ++n) {
      const double x = n < static_cast<int>(nodes.size()) ? nodes[n] : inside(random);
      const GridAxis::Cell cell = axis.locate(x);
      ASSERT_TRUE(cell.inside);
      ASSERT_GE(cell.index, 0);
      ASSERT_LT(cell.index, axis.size() - 1);
      EXPECT_GE(cell.fraction, 0.0);
      EXPECT_LE(cell.fraction, 1.0);
      EXPECT_NEAR(nodes[cell.index] + cell.fraction * cell.width, x, 1e-15);
    }
    EXPECT_FALSE(axis.locate(std::nextafter(nodes.front(), -infinity)).inside);
    EXPECT_FALSE(axis.locate(std::nextafter(nodes.back(), infinity)).inside);
    EXPECT_FALSE(axis.locate(nan).inside);
  }
}

TEST(GridAxis, SingleNodeHoldsItsValueOnly) {
  const GridAxis axis("roll", {0.002});
  EXPECT_TRUE(axis.locate(0.002).inside);
  EXPECT_TRUE(axis.locate(0.002 + 0.9e-12).inside);
  EXPECT_FALSE(axis.locate(0.002 + 1.1e-12).inside);
  EXPECT_FALSE(axis.locate(nan).inside);
}

TEST(GridAxis, RejectsDisorder) {
  EXPECT_THROW(GridAxis("yaw", {}), InputError);
  EXPECT_THROW(GridAxis("yaw", {0, 1, 1}), InputError);
  EXPECT_THROW(GridAxis("yaw", {0, nan}), InputError);
}

}  // namespace
}  // namespace railtab
