#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "railtab/runtime/contact/creep_law.hpp"

namespace railtab {
namespace {

using std::numbers::pi;

constexpr std::array kMembers{&KalkerCoefficients::c11, &KalkerCoefficients::c22, &KalkerCoefficients::c23,
                              &KalkerCoefficients::c33};

TEST(KalkerCoefficients, ReproduceTheTable) {
  // [Kalker1990, Table E.3], rows at random; the last two are the corrected misprints.
  struct Entry {
    double ratio, nu, KalkerCoefficients::*member;
    double value;
  };
  const Entry entries[] = {
      {0.1, 0.0, &KalkerCoefficients::c11, 2.51},      {0.3, 0.25, &KalkerCoefficients::c22, 2.75},
      {1.0, 0.5, &KalkerCoefficients::c23, 1.63},      {1.0, 0.25, &KalkerCoefficients::c33, 1.19},
      {2.0, 0.25, &KalkerCoefficients::c11, 5.10},     {10.0, 0.5, &KalkerCoefficients::c22, 16.0},
      {1 / 0.3, 0.25, &KalkerCoefficients::c23, 4.32}, {5.0, 0.0, &KalkerCoefficients::c33, 0.828},
      {0.8, 0.25, &KalkerCoefficients::c23, 1.25},     {0.5, 0.5, &KalkerCoefficients::c11, 4.865}};
  for (const Entry& e : entries) {
    EXPECT_NEAR(kalker_coefficients(e.ratio, e.nu).*e.member / e.value, 1.0, 1e-12) << e.ratio << ' ' << e.nu;
  }
}

TEST(KalkerCoefficients, PoissonRatioEntersAsParabolaOfTheReciprocal) {
  const auto reciprocal = [](double nu) { return 1.0 / kalker_coefficients(2.0, nu).c11; };
  const double third = reciprocal(0.48) - 3.0 * reciprocal(0.32) + 3.0 * reciprocal(0.16) - reciprocal(0.0);
  EXPECT_NEAR(third, 0.0, 1e-14);
  EXPECT_GT(std::abs(reciprocal(0.5) - 2.0 * reciprocal(0.25) + reciprocal(0.0)), 1e-4);
}

TEST(KalkerCoefficients, ReachTheAsymptotes) {
  const double nu = 0.28;
  const double g = 1e-3;
  const KalkerCoefficients wide = kalker_coefficients(g, nu);
  EXPECT_NEAR(wide.c11, pi * pi / (4.0 * (1.0 - nu)), 1e-12);
  EXPECT_NEAR(wide.c22, pi * pi / 4.0, 1e-12);
  EXPECT_NEAR(wide.c33 * g, pi * pi / (16.0 * (1.0 - nu)), 1e-12);
  const double L = std::log(16.0 / (g * g));
  const KalkerCoefficients slender = kalker_coefficients(1.0 / g, nu);
  EXPECT_NEAR(slender.c23 * g * std::sqrt(g), 2.0 * pi / 3.0 / ((1.0 - nu) * L - 2.0 + 4.0 * nu), 1e-12);
}

TEST(KalkerCoefficients, ContinuousWithContinuousSlope) {
  // Jumps of value or slope over ln(a/b) show as second differences that do not shrink with the step squared.
  const auto worst_second_difference = [](double h) {
    double worst = 0.0;
    for (double t = -7.5; t < 7.5; t += h) {
      for (double nu : {0.0, 0.28, 0.5}) {
        const KalkerCoefficients a = kalker_coefficients(std::exp(t - h), nu);
        const KalkerCoefficients b = kalker_coefficients(std::exp(t), nu);
        const KalkerCoefficients c = kalker_coefficients(std::exp(t + h), nu);
        for (auto m : kMembers) worst = std::max(worst, std::abs(std::log(a.*m * (c.*m) / (b.*m * (b.*m)))));
      }
    }
    return worst;
  };
  const double coarse = worst_second_difference(2e-2);
  const double fine = worst_second_difference(2e-3);
  // A jump would give a ratio of 1, a kink 10, a continuous slope 100 (where the curvature jumps, a little less).
  EXPECT_GT(coarse / fine, 60.0);
  EXPECT_LT(coarse / fine, 140.0);
}

TEST(KalkerCoefficients, FinitePositiveAndMonotoneFarOutside) {
  for (double nu : {0.0, 0.28, 0.5}) {
    KalkerCoefficients previous = kalker_coefficients(1e-12, nu);
    for (double ratio = 1e-11; ratio < 1e13; ratio *= 10.0) {
      const KalkerCoefficients c = kalker_coefficients(ratio, nu);
      for (auto m : kMembers) ASSERT_TRUE(std::isfinite(c.*m) && c.*m > 0.0) << ratio << ' ' << nu;
      if (ratio > 0.5) {
        EXPECT_GT(c.c11, previous.c11) << ratio;
        EXPECT_GT(c.c22, previous.c22) << ratio;
      }
      EXPECT_GT(c.c23, previous.c23) << ratio;
      previous = c;
    }
  }
}

}  // namespace
}  // namespace railtab
