// Characteristics of stops, dampers and dry friction: mean forces over a step, and their derivatives.
#include "railtab/runtime/vehicle/force_curve.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace railtab {
namespace {

TEST(ForceCurve, IsOddAndGoesOnWithItsLastSlope) {
  const ForceCurve stop({{0.02, 0.0}, {0.03, 1000.0}, {0.04, 5000.0}});
  EXPECT_EQ(stop.free_travel(), 0.02);
  EXPECT_EQ(stop.at(0.015).force, 0.0);
  EXPECT_NEAR(stop.at(0.025).force, 500.0, 1e-9);
  EXPECT_NEAR(stop.at(-0.05).force, -9000.0, 1e-9);
  EXPECT_NEAR(stop.at(-0.05).slope, 4e5, 1e-6);
  const double area = 0.5 * 0.01 * 1000.0 + 0.5 * 0.01 * 6000.0 + 0.5 * 0.01 * 14000.0;
  EXPECT_NEAR(stop.integral(0.05), area, 1e-12 * area);
  EXPECT_EQ(stop.integral(-0.05), stop.integral(0.05));
}

TEST(ForceCurve, MeanIsTheDiscreteGradientOfItsIntegral) {
  const ForceCurve curve({{0.1, 2500.0}, {0.3, 3585.0}});
  const double places[] = {-0.5, -0.3, -0.2, -0.05, 0.0, 0.07, 0.1, 0.15, 0.31, 2.0};
  for (const double x0 : places) {
    for (const double x1 : places) {
      const ForceCurve::Value mean = curve.mean(x0, x1);
      EXPECT_NEAR(mean.force * (x1 - x0), curve.integral(x1) - curve.integral(x0), 1e-9) << x0 << " " << x1;
      if (std::abs(x1) == 0.1 || std::abs(x1) == 0.3) continue;  // a kink
      constexpr double h = 1e-7;
      const double slope = (curve.mean(x0, x1 + h).force - curve.mean(x0, x1 - h).force) / (2.0 * h);
      EXPECT_NEAR(mean.slope, slope, 1e-3 * std::abs(slope)) << x0 << " " << x1;
    }
  }
}

/// The path in many small parts, each of which sticks or slides as a whole.
double mean_by_parts(double force, double stretch, double limit0, double limit1) {
  constexpr int parts = 200000;
  double sum = 0.0;
  for (int i = 1; i <= parts; ++i) {
    const double limit = limit0 + (limit1 - limit0) * i / parts;
    const double next = std::clamp(force + stretch / parts, -limit, limit);
    sum += 0.5 * (force + next);
    force = next;
  }
  return sum / parts;
}

struct Path {
  double force, stretch, limit0, limit1;
};
constexpr Path paths[] = {{0.0, 50.0, 100.0, 100.0},    {30.0, 500.0, 100.0, 120.0}, {-60.0, 400.0, 100.0, 80.0},
                          {90.0, -300.0, 100.0, 140.0}, {80.0, -10.0, 100.0, 30.0},  {100.0, 1e5, 100.0, 100.0},
                          {-50.0, 20.0, 60.0, 0.0},     {0.0, 40.0, 0.0, 25.0}};

TEST(Friction, SticksAndSlidesAlongItsPath) {
  for (const Path& p : paths) {
    const FrictionStep step = slide(p.force, p.stretch, p.limit0, p.limit1);
    EXPECT_NEAR(step.mean, mean_by_parts(p.force, p.stretch, p.limit0, p.limit1), 2e-2) << p.force << " " << p.stretch;
    EXPECT_LE(std::abs(step.end), p.limit1);
    // what is not stored is dissipated: never less than nothing
    const double dissipated = step.mean * p.stretch - 0.5 * (step.end * step.end - p.force * p.force);
    EXPECT_GE(dissipated, -1e-9) << p.force << " " << p.stretch;
  }
}

TEST(Friction, HasItsDerivatives) {
  constexpr double h = 1e-5;
  for (const Path& p : paths) {
    if (p.limit1 == 0.0) continue;
    const FrictionStep step = slide(p.force, p.stretch, p.limit0, p.limit1);
    const FrictionStep more = slide(p.force, p.stretch + h, p.limit0, p.limit1);
    const FrictionStep less = slide(p.force, p.stretch - h, p.limit0, p.limit1);
    EXPECT_NEAR(step.mean_by_stretch, (more.mean - less.mean) / (2.0 * h), 1e-5);
    EXPECT_NEAR(step.end_by_stretch, (more.end - less.end) / (2.0 * h), 1e-5);
    const FrictionStep wider = slide(p.force, p.stretch, p.limit0, p.limit1 + h);
    const FrictionStep tighter = slide(p.force, p.stretch, p.limit0, p.limit1 - h);
    EXPECT_NEAR(step.mean_by_limit, (wider.mean - tighter.mean) / (2.0 * h), 1e-5);
    EXPECT_NEAR(step.end_by_limit, (wider.end - tighter.end) / (2.0 * h), 1e-5);
  }
}

}  // namespace
}  // namespace railtab
