#include "railtab/runtime/contact/hertz.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {
namespace {

using std::numbers::pi;

/// K(m), E(m) by the arithmetic-geometric mean, from g² = 1 - m: a route that shares nothing with Carlson's forms.
struct AgmIntegrals {
  double K, E;
  explicit AgmIntegrals(double g) {
    double a = 1.0, b = g, sum = 0.5 * (1.0 - g * g), power = 0.5;
    for (int i = 0; i < 40 && a - b > 0.0; ++i) {
      const double c = 0.5 * (a - b);
      const double next = 0.5 * (a + b);
      b = std::sqrt(a * b);
      a = next;
      power *= 2.0;
      sum += power * c * c;
    }
    K = pi / (2.0 * a);
    E = K * (1.0 - sum);
  }
};

std::vector<double> curvature_ratios() {
  std::vector<double> r;
  for (int i = -1400; i <= 1400; ++i) r.push_back(std::exp(i * 0.01 + 1e-3 * std::sin(i)));
  r.push_back(1.0);
  return r;
}

double relative_difference(const HertzContact& p, const HertzContact& q) {
  return std::max({std::abs(p.stiffness / q.stiffness - 1.0), std::abs(p.a1 / q.a1 - 1.0), std::abs(p.b1 / q.b1 - 1.0),
                   std::abs(p.ratio / q.ratio - 1.0)});
}

TEST(Hertz, EllipseSatisfiesTheRatioEquation) {
  // B/A = (E/g² - K)/(K - E): the reference's own subtraction loses digits near the circle, hence from 1.05 on.
  for (double B : curvature_ratios()) {
    if (B < 1.05) continue;
    const HertzContact h = hertz_contact_exact(1.0, B, {});
    const double g = h.b1 / h.a1;
    const AgmIntegrals c(g);
    // K - E ~ 0.05 there, g² E small elsewhere
    EXPECT_NEAR((c.E / (g * g) - c.K) / (c.K - c.E) / B, 1.0, 2e-12) << "B/A " << B;
  }
}

TEST(Hertz, SphereIsTheClosedForm) {
  const ElasticMaterial steel{210e9, 0.3};
  const double R = 0.5;  // A = B = 1/(2R)
  const double modulus = 210e9 / (2.0 * (1.0 - 0.09));
  for (const HertzContact& h : {hertz_contact_exact(0.5 / R, 0.5 / R, steel), hertz_contact(0.5 / R, 0.5 / R, steel)}) {
    EXPECT_NEAR(h.stiffness / (4.0 / 3.0 * modulus * std::sqrt(R)), 1.0, 1e-11);
    EXPECT_NEAR(h.a1 / std::cbrt(3.0 * R / (4.0 * modulus)), 1.0, 1e-11);
    EXPECT_NEAR(h.ratio, 1.0, 1e-11);
  }
}

TEST(Hertz, ClassicalTable) {
  // cos θ = (B - A)/(A + B); a = m (3N/(4 E* (A+B)))^{1/3}, b = n (same), δ ∝ r: exact to the four digits given.
  struct Row {
    double theta, m, n, r;
  };
  const Row rows[] = {{10, 6.6115, .3110, .4280}, {20, 3.8160, .4121, .6038}, {30, 2.7306, .4931, .7263},
                      {40, 2.1357, .5673, .8177}, {50, 1.7541, .6407, .8867}, {60, 1.4858, .7171, .9376},
                      {70, 1.2851, .7999, .9726}, {80, 1.1278, .8927, .9932}, {90, 1.0, 1.0, 1.0}};
  const ElasticMaterial material{1.0, 0.0};  // E* = 1/2
  for (const Row& row : rows) {
    const double c = std::cos(row.theta * pi / 180.0);
    const HertzContact h = hertz_contact(0.5 * (1.0 - c), 0.5 * (1.0 + c), material);  // A + B = 1
    const double unit = std::cbrt(3.0 / (4.0 * 0.5));
    EXPECT_NEAR(h.a1 / unit, row.m, 6e-5) << row.theta;
    EXPECT_NEAR(h.b1 / unit, row.n, 6e-5) << row.theta;
    // δ at unit load, in units of the circle's: (9/(16 E*²)·2(A+B))^{1/3} r, since 1/R = 2A = A + B there
    EXPECT_NEAR(std::pow(h.stiffness, -2.0 / 3.0) / std::cbrt(9.0 / (16.0 * 0.25)), row.r, 6e-5) << row.theta;
  }
}

TEST(Hertz, WheelOnRail) {
  // R_w = 0.46 m on R_r = 0.30 m; published with four digits.
  const HertzContact h = hertz_contact(0.5 / 0.46, 0.5 / 0.30, {210e9, 0.3});
  EXPECT_NEAR(h.stiffness, 9.413e10, 0.001e10);
  EXPECT_NEAR(1.0 / h.ratio, 0.7522, 5e-5);
  EXPECT_NEAR(h.a1 * std::cbrt(50e3), 5.684e-3, 1e-6);
  EXPECT_NEAR(h.b1 * std::cbrt(50e3), 4.276e-3, 1e-6);
  EXPECT_NEAR(std::pow(100e3 / h.stiffness, 2.0 / 3.0), 104.1e-6, 0.05e-6);
}

TEST(Hertz, AxesChangeRolesWithCurvatures) {
  for (double B : {1e-5, 0.3, 0.999999, 4.0, 2e5}) {
    const HertzContact h = hertz_contact(1.0, B, {});
    const HertzContact turned = hertz_contact(B, 1.0, {});
    EXPECT_DOUBLE_EQ(h.a1, turned.b1);
    EXPECT_DOUBLE_EQ(h.b1, turned.a1);
    EXPECT_DOUBLE_EQ(h.stiffness, turned.stiffness);
    EXPECT_EQ(h.a1 < h.b1, B < 1.0);
  }
}

TEST(Hertz, TableAgreesWithExact) {
  double worst = 0.0;
  for (double B : curvature_ratios()) {
    worst = std::max(worst, relative_difference(hertz_contact(1.0, B, {}), hertz_contact_exact(1.0, B, {})));
  }
  RecordProperty("worst_relative_error", std::to_string(worst));
  EXPECT_LT(worst, 1e-10);
  EXPECT_GT(worst, 1e-15) << "the table is not in use";
}

TEST(Hertz, InverseCubeRootHoldsOverTheWholeRange) {
  // a1³ (A + B) E* depends on the shape only: scaling both curvatures must change a1 by the exact cube root.
  const double reference = hertz_contact(1.0, 3.0, {}).a1;
  for (double scale = 1e-9; scale < 1e9; scale *= 1.7) {
    EXPECT_NEAR(hertz_contact(scale, 3.0 * scale, {}).a1 * std::cbrt(scale) / reference, 1.0, 3e-15) << scale;
  }
}

TEST(Hertz, ExtremeRatiosAreFinite) {
  double previous = 0.0;
  for (double B = 1e-12; B < 1e13; B *= 10.0) {
    const HertzContact h = hertz_contact(1.0, B, {});
    ASSERT_TRUE(std::isfinite(h.stiffness) && h.a1 > 0.0 && h.b1 > 0.0) << B;
    EXPECT_GT(h.ratio, previous) << B;
    previous = h.ratio;
  }
}

TEST(Hertz, MaterialOutOfRangeIsAnInputError) {
  EXPECT_THROW((ElasticMaterial{-1.0, 0.3}.validate()), InputError);
  EXPECT_THROW((ElasticMaterial{210e9, 0.6}.validate()), InputError);
  EXPECT_NO_THROW((ElasticMaterial{210e9, 0.5}.validate()));
}

}  // namespace
}  // namespace railtab
