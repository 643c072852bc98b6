#include "railtab/runtime/line/irregularity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {
namespace {

constexpr double k = 2 * std::numbers::pi / 10;

double y_left(double x) { return 3e-3 * std::sin(k * x); }
double z_left(double x) { return 2e-3 * std::sin(2 * k * x); }
double y_right(double x) { return -1e-3 * std::sin(k * x); }
double z_right(double x) { return 4e-3 * std::sin(3 * k * x); }

/// Sines over 0..20 m; at both ends value and curvature vanish as the natural spline's do.
Irregularity sines(int intervals, double unevenness = 0.0) {
  std::vector<double> x, columns[4];
  for (int i = 0; i <= intervals; ++i) {
    const double h = 20.0 / intervals;
    x.push_back(i * h + unevenness * h * std::sin(2 * std::numbers::pi * i / intervals));
    columns[0].push_back(y_left(x.back()));
    columns[1].push_back(z_left(x.back()));
    columns[2].push_back(y_right(x.back()));
    columns[3].push_back(z_right(x.back()));
  }
  return Irregularity(x, columns[0], columns[1], columns[2], columns[3]);
}

double worst_error(const Irregularity& irregularity) {
  double worst = 0;
  for (double x = 0.013; x < 20; x += 0.0377) {
    const RailDeviation left = irregularity.at(RailSide::left, x), right = irregularity.at(RailSide::right, x);
    worst = std::max({worst, std::abs(left.y - y_left(x)), std::abs(left.z - z_left(x)), std::abs(right.y - y_right(x)),
                      std::abs(right.z - z_right(x))});
  }
  return worst;
}

TEST(Irregularity, ErrorFallsWithTheFourthOrder) {
  for (const double unevenness : {0.0, 0.1}) {
    const double order = std::log2(worst_error(sines(80, unevenness)) / worst_error(sines(160, unevenness)));
    EXPECT_GT(order, 3.7);
    EXPECT_LT(order, 4.4);
  }
}

TEST(Irregularity, DerivativesBelongToTheValues) {
  const Irregularity irregularity = sines(40, 0.1);
  constexpr double h = 1e-5;
  for (const RailSide side : {RailSide::left, RailSide::right}) {
    for (double x = 0.1; x < 19.9; x += 0.171) {
      const RailDeviation before = irregularity.at(side, x - h), at = irregularity.at(side, x),
                          after = irregularity.at(side, x + h);
      EXPECT_NEAR(at.dy_dx, (after.y - before.y) / (2 * h), 1e-9);
      EXPECT_NEAR(at.dz_dx, (after.z - before.z) / (2 * h), 1e-9);
      EXPECT_NEAR(at.ddy_dx2, (after.dy_dx - before.dy_dx) / (2 * h), 1e-6);
      EXPECT_NEAR(at.ddz_dx2, (after.dz_dx - before.dz_dx) / (2 * h), 1e-6);
    }
  }
}

TEST(Irregularity, IsContinuousInCurvatureAtItsPoints) {
  const Irregularity irregularity = sines(40);
  for (int i = 1; i < 40; ++i) {
    const double x = 0.5 * i;
    const RailDeviation before = irregularity.at(RailSide::left, std::nextafter(x, 0.0)),
                        after = irregularity.at(RailSide::left, std::nextafter(x, 20.0));
    EXPECT_NEAR(before.z, after.z, 1e-16);
    EXPECT_NEAR(before.dz_dx, after.dz_dx, 1e-14);
    EXPECT_NEAR(before.ddz_dx2, after.ddz_dx2, 1e-13);
    EXPECT_NEAR(after.z, z_left(x), 1e-15);
  }
}

TEST(Irregularity, IsZeroOutsideAndWhereThereIsNone) {
  const Irregularity measured({1.0, 2.0, 3.0}, {1e-3, 1e-3, 1e-3}, {1e-3, 1e-3, 1e-3}, {1e-3, 1e-3, 1e-3},
                              {1e-3, 1e-3, 1e-3});
  EXPECT_FALSE(measured.empty());
  EXPECT_DOUBLE_EQ(measured.at(RailSide::left, 1.0).y, 1e-3);
  EXPECT_DOUBLE_EQ(measured.at(RailSide::right, 3.0).z, 1e-3);
  for (const double x : {0.999, 3.001}) {
    const RailDeviation outside = measured.at(RailSide::left, x);
    EXPECT_EQ(outside.y, 0.0);
    EXPECT_EQ(outside.z, 0.0);
    EXPECT_EQ(outside.dz_dx, 0.0);
  }
  EXPECT_TRUE(Irregularity().empty());
  EXPECT_EQ(Irregularity().at(RailSide::right, 0.0).z, 0.0);
}

TEST(Irregularity, TwoPointsAreAStraightLine) {
  const Irregularity line({0.0, 2.0}, {0.0, 1e-3}, {0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0});
  EXPECT_DOUBLE_EQ(line.at(RailSide::left, 0.5).y, 0.25e-3);
  EXPECT_DOUBLE_EQ(line.at(RailSide::left, 0.5).dy_dx, 0.5e-3);
}

std::string message_of(std::vector<double> x, std::vector<double> z_left_values) {
  const std::vector<double> zero(x.size(), 0.0);
  try {
    (void)Irregularity(x, zero, z_left_values, zero, zero);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no InputError";
}

TEST(Irregularity, RejectsWrongColumns) {
  EXPECT_EQ(message_of({0, 1, 2}, {0, 0, 0}), "no InputError");
  EXPECT_NE(message_of({0}, {0}).find("found 1 points"), std::string::npos);
  EXPECT_NE(message_of({0, 1, 1}, {0, 0, 0}).find("x, point 3"), std::string::npos);
  EXPECT_NE(message_of({0, std::nan(""), 1}, {0, 0, 0}).find("x, point 2: found nan"), std::string::npos);
  EXPECT_NE(message_of({0, 1, 2}, {0, 0}).find("z_left: found 2 points, expected 3"), std::string::npos);
  EXPECT_NE(message_of({0, 1, 2}, {0, INFINITY, 0}).find("z_left, point 2: found inf"), std::string::npos);
}

}  // namespace
}  // namespace railtab
