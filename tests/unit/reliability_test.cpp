// Distributions, samples and estimates of probabilities against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <set>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/reliability/counter_random.hpp"
#include "railtab/runtime/reliability/distribution.hpp"
#include "railtab/runtime/reliability/fragility.hpp"
#include "railtab/runtime/reliability/peak_search.hpp"
#include "railtab/runtime/reliability/proportion.hpp"
#include "railtab/runtime/reliability/response_surface.hpp"
#include "railtab/runtime/reliability/sampling.hpp"
#include "railtab/runtime/reliability/sobol_indices.hpp"
#include "railtab/runtime/reliability/standard_normal.hpp"
#include "railtab/runtime/reliability/subset_simulation.hpp"
#include "railtab/runtime/reliability/threshold_search.hpp"

namespace railtab {
namespace {

using std::numbers::pi;

// Random123's known answers (kat_vectors, philox4x32 of ten rounds).
TEST(CounterRandom, IsPhilox) {
  using Words = std::array<std::uint32_t, 4>;
  constexpr std::uint32_t ones = 0xffffffff;
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}), (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox({ones, ones, ones, ones}, {ones, ones}), (Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

// Mean 1/2 and variance 1/12 within four standard errors, and each decile within four of its own.
TEST(CounterRandom, IsUniform) {
  constexpr int count = 100000;
  double sum = 0.0, square = 0.0;
  std::array<int, 10> deciles{};
  for (int i = 0; i < count; ++i) {
    const double u = uniform_random(7, {static_cast<std::uint64_t>(i), 3, 5});
    ASSERT_TRUE(u > 0.0 && u < 1.0);
    sum += u;
    square += (u - 0.5) * (u - 0.5);
    ++deciles[static_cast<std::size_t>(10.0 * u)];
  }
  EXPECT_NEAR(sum / count, 0.5, 4.0 / std::sqrt(12.0 * count));
  EXPECT_NEAR(square / count, 1.0 / 12.0, 4.0 / std::sqrt(180.0 * count));
  for (const int n : deciles) EXPECT_NEAR(n, 0.1 * count, 4.0 * std::sqrt(0.09 * count));
}

// Φ(−z), and far out where 1 − Φ is not 1 less a number.
TEST(StandardNormal, KeepsBothTails) {
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-14);
  EXPECT_NEAR(normal_probability(3.0).above, 1.349898031630094e-3, 1e-17);
  for (const double z : {-30.0, -8.0, -1.0, 0.0, 0.5, 4.0, 12.0, 30.0}) {
    EXPECT_NEAR(normal_quantile(normal_probability(z)), z, 1e-13 * (1.0 + std::abs(z)));
  }
}

struct NamedDistribution {
  const char* name;
  Distribution distribution;
  double at_third;  // F^-1(1/3), closed form
};

class OneDistribution : public ::testing::TestWithParam<NamedDistribution> {};

TEST_P(OneDistribution, HasItsClosedFormQuantile) {
  const Distribution& d = GetParam().distribution;
  EXPECT_NEAR(quantile(d, 1.0 / 3.0), GetParam().at_third, 1e-13 * (1.0 + std::abs(GetParam().at_third)));
}

// F(F⁻¹(p)) = p to full relative precision from 1e-12 below to 1e-12 above, and quantiles rise.
TEST_P(OneDistribution, InvertsItself) {
  const Distribution& d = GetParam().distribution;
  double last = -INFINITY;
  for (double z = -7.0; z <= 7.0; z += 0.25) {
    const Probability p = normal_probability(z);
    const double x = quantile(d, p);
    EXPECT_GT(x, last);
    last = x;
    const Probability back = probability(d, x);
    EXPECT_NEAR(back.below / p.below, 1.0, 1e-9) << GetParam().name << " z = " << z;
    if (GetParam().name == std::string("uniform")) continue;  // 1 − F is a difference there
    EXPECT_NEAR(back.above / p.above, 1.0, 1e-9) << GetParam().name << " z = " << z;
  }
}

// Between the quantiles of 0.2 and 0.7, the middle is that of 0.45.
TEST_P(OneDistribution, StaysWithinItsBounds) {
  Distribution d = GetParam().distribution;
  const double low = quantile(d, 0.2), high = quantile(d, 0.7);
  d.low = low;
  d.high = high;
  EXPECT_NEAR(quantile(d, 0.5), quantile(GetParam().distribution, 0.45), 1e-12 * (1.0 + std::abs(high)));
  EXPECT_NEAR(quantile(d, 1e-15), low, 1e-9 * (1.0 + std::abs(low)));
  EXPECT_NEAR(quantile(d, {1.0, 1e-15}), high, 1e-9 * (1.0 + std::abs(high)));
  EXPECT_NEAR(probability(d, quantile(d, 0.3)).below, 0.3, 1e-12);
  EXPECT_EQ(probability(d, low).below, 0.0);
  EXPECT_EQ(probability(d, high).above, 0.0);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, OneDistribution,
    ::testing::Values(
        NamedDistribution{"normal", {DistributionKind::normal, 5.0, 2.0}, 5.0 + 2.0 * -0.43072729929545756},
        NamedDistribution{
            "lognormal", {DistributionKind::lognormal, 3.0, 0.4}, 3.0 * std::exp(0.4 * -0.43072729929545756)},
        NamedDistribution{"uniform", {DistributionKind::uniform, 0.0, 5.0}, 5.0 / 3.0},
        NamedDistribution{"weibull", {DistributionKind::weibull, 2.0, 1.5}, 2.0 * std::pow(std::log(1.5), 1.0 / 1.5)},
        NamedDistribution{"gumbel", {DistributionKind::gumbel, 20.0, 3.0}, 20.0 - 3.0 * std::log(std::log(3.0))}),
    [](const auto& instance) { return std::string(instance.param.name); });

// Mean and standard deviation by Gauss-like sums over even probabilities: 2e5 midpoints.
TEST(Distribution, HasTheMomentsAskedFor) {
  constexpr int count = 200000;
  for (const Distribution& d : {lognormal_of_moments(0.3, 0.06), gumbel_of_moments(25.0, 4.0)}) {
    double sum = 0.0, square = 0.0;
    for (int i = 0; i < count; ++i) {
      const double x = quantile(d, (i + 0.5) / count);
      sum += x;
      square += x * x;
    }
    const double mean = sum / count, deviation = std::sqrt(square / count - mean * mean);
    const bool gumbel = d.kind == DistributionKind::gumbel;
    EXPECT_NEAR(mean, gumbel ? 25.0 : 0.3, 1e-4 * mean);
    EXPECT_NEAR(deviation, gumbel ? 4.0 : 0.06, 1e-3 * deviation);
  }
}

TEST(Sampling, LatinHypercubeHasOneValueInEachInterval) {
  constexpr std::size_t count = 50, variables = 4;
  const UnitPoints points = latin_hypercube_points(count, variables, 11);
  for (std::size_t j = 0; j < variables; ++j) {
    std::set<int> intervals;
    for (const auto& point : points) intervals.insert(static_cast<int>(point[j] * count));
    EXPECT_EQ(intervals.size(), count);
  }
  EXPECT_NE(points, latin_hypercube_points(count, variables, 12));
  EXPECT_EQ(points, latin_hypercube_points(count, variables, 11));
}

// The variance of the mean of an additive function is far below that of independent points, which is Var f/N.
TEST(Sampling, LatinHypercubeLessensTheVarianceOfAnAdditiveFunction) {
  constexpr std::size_t count = 40, variables = 3;
  double random = 0.0, latin = 0.0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto squared_error = [&](const UnitPoints& points) {
      double sum = 0.0;
      for (const auto& point : points) sum += point[0] * point[0] + point[1] + std::sqrt(point[2]);
      const double error = sum / count - (1.0 / 3.0 + 0.5 + 2.0 / 3.0);
      return error * error / 200.0;
    };
    random += squared_error(monte_carlo_points(count, variables, seed));
    latin += squared_error(latin_hypercube_points(count, variables, seed));
  }
  const double variance = (4.0 / 45.0 + 1.0 / 12.0 + 1.0 / 18.0) / count;
  EXPECT_NEAR(random, variance, 0.4 * variance);
  EXPECT_LT(latin, 0.01 * variance);
}

TEST(Sampling, FewerMonteCarloPointsAreTheFirstOfMore) {
  const UnitPoints few = monte_carlo_points(5, 2, 3), more = monte_carlo_points(9, 2, 3);
  EXPECT_TRUE(std::equal(few.begin(), few.end(), more.begin()));
}

// [Wilson1927]: both bounds solve (p̂ − p)² = z²·p(1 − p)/n; with no hits the upper one is z²/(n + z²).
TEST(Proportion, WilsonBoundsSolveTheirEquation) {
  const double z = normal_quantile(0.975);
  for (const std::size_t hits : {1U, 7U, 19U}) {
    const ConfidenceInterval interval = wilson_interval(hits, 20, 0.95);
    for (const double p : {interval.low, interval.high}) {
      EXPECT_NEAR((interval.value - p) * (interval.value - p), z * z * p * (1.0 - p) / 20.0, 1e-15);
    }
    EXPECT_TRUE(interval.low < interval.value && interval.value < interval.high);
  }
  EXPECT_EQ(wilson_interval(0, 20, 0.95).low, 0.0);
  EXPECT_NEAR(wilson_interval(0, 20, 0.95).high, z * z / (20.0 + z * z), 1e-15);
  EXPECT_EQ(wilson_interval(20, 20, 0.95).high, 1.0);
}

// The share of values 0, ½ and 1 has the bounds of as many trials.
TEST(Proportion, IntervalOfAShareIsThatOfTrials) {
  const ConfidenceInterval share = wilson_interval_of_share(0.35, 20, 0.95), trials = wilson_interval(7, 20, 0.95);
  EXPECT_NEAR(share.low, trials.low, 1e-15);
  EXPECT_NEAR(share.high, trials.high, 1e-15);
  EXPECT_EQ(wilson_interval_of_share(1.0, 4, 0.95).high, 1.0);
}

// ln x is probit-linear with known parameters and shares of runs that equal the curve: the fit returns them.
TEST(Fragility, FindsTheCurveOfExactShares) {
  constexpr double median = 31.0, deviation = 0.25;
  std::vector<FragilityLevel> levels;
  for (const double x : {18.0, 24.0, 30.0, 36.0, 48.0}) {
    constexpr double runs = 1e9;
    const double p = normal_probability(std::log(x / median) / deviation).below;
    levels.push_back({x, static_cast<std::size_t>(runs), static_cast<std::size_t>(std::llround(p * runs))});
  }
  const std::optional<FragilityCurve> curve = fit_fragility(levels);
  ASSERT_TRUE(curve);
  EXPECT_NEAR(curve->median, median, 1e-5 * median);
  EXPECT_NEAR(curve->deviation, deviation, 1e-5);
  EXPECT_NEAR(curve->probability(median), 0.5, 1e-5);
}

// Two levels: the curve passes through both shares, z1 = Φ⁻¹(0.2), z2 = Φ⁻¹(0.7).
TEST(Fragility, PassesThroughTwoLevels) {
  const std::optional<FragilityCurve> curve = fit_fragility({{2.0, 10, 2}, {3.0, 10, 7}});
  ASSERT_TRUE(curve);
  const double deviation = std::log(1.5) / (normal_quantile(0.7) - normal_quantile(0.2));
  EXPECT_NEAR(curve->deviation, deviation, 1e-9);
  EXPECT_NEAR(curve->median, 2.0 * std::exp(-normal_quantile(0.2) * deviation), 1e-9);
}

TEST(Fragility, HasNoCurveWhereTheLikelihoodHasNoMaximum) {
  EXPECT_FALSE(fit_fragility({{2.0, 10, 0}, {3.0, 10, 10}}));                // divided
  EXPECT_FALSE(fit_fragility({{2.0, 10, 0}, {3.0, 10, 4}, {4.0, 10, 10}}));  // divided at 3
  EXPECT_FALSE(fit_fragility({{2.0, 10, 8}, {3.0, 10, 2}}));                 // falls
  EXPECT_FALSE(fit_fragility({{2.0, 10, 10}, {3.0, 10, 0}}));                // falls, divided
  EXPECT_FALSE(fit_fragility({{2.0, 10, 3}}));
  EXPECT_FALSE(fit_fragility({{2.0, 10, 0}, {3.0, 10, 0}}));
}

/// What each of `count` samples does at every intensity: exceeded where its capacity, lognormal, is reached.
enum class Capacity { of_sample, of_run };
std::vector<FragilitySample> samples_of_capacity(Capacity capacity, const FragilityCurve& curve, std::uint32_t count,
                                                 const std::vector<double>& intensities, std::uint64_t seed) {
  std::vector<FragilitySample> samples;
  for (std::uint32_t k = 0; k < count; ++k) {
    FragilitySample& sample = samples.emplace_back();
    for (std::uint32_t i = 0; i < intensities.size(); ++i) {
      const double z = normal_random(seed, {k, capacity == Capacity::of_run ? i : 0, 99});
      sample.runs.push_back(1);
      sample.exceeded.push_back(z < std::log(intensities[i] / curve.median) / curve.deviation);
    }
  }
  return samples;
}

// 95 % intervals cover the true median and deviation in 90 to 99 % of 200 experiments, 95 % within three standard
// errors: where the runs of a sample are independent, and where they have one capacity.
TEST(Fragility, BootstrapIntervalsCoverTheTruth) {
  const FragilityCurve truth{30.0, 0.3};
  const std::vector<double> intensities{18.0, 22.0, 26.0, 30.0, 34.0, 40.0, 48.0};
  for (const Capacity capacity : {Capacity::of_run, Capacity::of_sample}) {
    int median = 0, deviation = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      const FragilityFit fit = fragility_with_bounds(
          intensities, samples_of_capacity(capacity, truth, 60, intensities, seed), {200, 0.95, seed});
      ASSERT_TRUE(fit.curve);
      median += fit.median.low <= truth.median && truth.median <= fit.median.high;
      deviation += fit.deviation.low <= truth.deviation && truth.deviation <= fit.deviation.high;
      EXPECT_LT(fit.median.low, fit.median.high);
      EXPECT_EQ(fit.at_levels.size(), intensities.size());
    }
    for (const int covered : {median, deviation}) {
      EXPECT_GE(covered, 180);
      EXPECT_LE(covered, 198);
    }
  }
}

// More intensities of the same samples add no samples: the error of the mean of ln x stays above β/√n.
TEST(Fragility, BoundsDoNotShrinkWithIntensities) {
  const FragilityCurve truth{30.0, 0.3};
  constexpr std::uint32_t count = 100;
  const double least = 2.0 * normal_quantile(0.975) * truth.deviation / std::sqrt(count);
  for (const int levels : {5, 20, 80}) {
    std::vector<double> intensities;
    for (int i = 0; i < levels; ++i) intensities.push_back(truth.median * std::exp(0.9 * (2.0 * i / (levels - 1) - 1)));
    const FragilityFit fit = fragility_with_bounds(
        intensities, samples_of_capacity(Capacity::of_sample, truth, count, intensities, 1), {500, 0.95, 1});
    EXPECT_GT(std::log(fit.median.high / fit.median.low), 0.8 * least) << levels;
  }
}

// Three runs of each sample that end alike are one trial.
TEST(Fragility, ObservedSharesAreThoseOfSamples) {
  const std::vector<FragilitySample> samples{{{3, 3}, {3, 3}}, {{3, 3}, {0, 3}}, {{3, 3}, {0, 3}}, {{3, 0}, {0, 0}}};
  const FragilityFit fit = fragility_with_bounds({2.0, 3.0}, samples, {});
  const ConfidenceInterval low = wilson_interval(1, 4, 0.95), high = wilson_interval(3, 3, 0.95);
  ASSERT_EQ(fit.observed.size(), 2U);
  EXPECT_EQ(fit.observed[0].value, low.value);
  EXPECT_EQ(fit.observed[0].low, low.low);
  EXPECT_EQ(fit.observed[0].high, low.high);
  EXPECT_EQ(fit.observed[1].low, high.low);
  EXPECT_EQ(fit.observed[1].high, high.high);
}

TEST(Fragility, TellsLevelsThatOverlapFromDividedOnes) {
  EXPECT_TRUE(levels_overlap({{2.0, 10, 8}, {3.0, 10, 2}}));
  EXPECT_TRUE(levels_overlap({{2.0, 10, 10}, {3.0, 10, 0}}));
  EXPECT_FALSE(levels_overlap({{2.0, 10, 0}, {3.0, 10, 4}, {4.0, 10, 10}}));
  EXPECT_FALSE(levels_overlap({{2.0, 10, 0}, {3.0, 10, 0}}));
}

TEST(Fragility, HasNoBoundsOfOneSample) {
  const FragilityFit fit = fragility_with_bounds({2.0, 3.0}, {{{10, 10}, {2, 7}}}, {});
  EXPECT_TRUE(fit.curve);
  EXPECT_TRUE(fit.at_levels.empty());
  EXPECT_EQ(fit.replicates, 0U);
}

// Ishigami function sin x1 + 7 sin² x2 + 0.1 x3⁴ sin x1 on (−π, π)³ with its closed-form variances [SaltelliEtAl2010].
TEST(SobolIndices, OfTheIshigamiFunction) {
  constexpr double a = 7.0, b = 0.1;
  const double v1 = 0.5 * std::pow(1.0 + b * std::pow(pi, 4) / 5.0, 2), v2 = a * a / 8.0,
               v13 = b * b * std::pow(pi, 8) * (1.0 / 18.0 - 1.0 / 50.0), v = v1 + v2 + v13;
  const auto ishigami = [&](const UnitPoints& points) {
    std::vector<double> values;
    for (const auto& u : points) {
      const double x1 = pi * (2.0 * u[0] - 1.0), x2 = pi * (2.0 * u[1] - 1.0), x3 = pi * (2.0 * u[2] - 1.0);
      values.push_back(std::sin(x1) + a * std::pow(std::sin(x2), 2) + b * std::pow(x3, 4) * std::sin(x1));
    }
    return values;
  };
  const SobolIndices indices = sobol_indices({.variables = 3, .samples = 20000, .replicates = 50}, ishigami);
  EXPECT_NEAR(indices.variance / v, 1.0, 0.02);
  EXPECT_NEAR(indices.mean, 0.5 * a, 0.05);
  const double first[3] = {v1 / v, v2 / v, 0.0}, total[3] = {(v1 + v13) / v, v2 / v, v13 / v};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(indices.first[i].value, first[i], 0.02) << i;
    EXPECT_NEAR(indices.total[i].value, total[i], 0.02) << i;
    EXPECT_LT(indices.first[i].low, indices.first[i].high);
    EXPECT_LT(indices.total[i].high - indices.total[i].low, 0.1);
  }
}

// One value has no shares, however it is rounded; one row of eight that differs has some, in the replicates that draw
// it.
TEST(SobolIndices, NeedVariance) {
  const auto constant = [](const UnitPoints& points) { return std::vector<double>(points.size(), 0.1); };
  EXPECT_THROW(static_cast<void>(sobol_indices({.variables = 2, .samples = 7}, constant)), ComputationError);
  const auto one_row = [](const UnitPoints& points) {
    std::vector<double> values(points.size(), 0.1);
    values[3] = 1.0;
    return values;
  };
  const SobolIndices indices = sobol_indices({.variables = 1, .samples = 8}, one_row);
  for (const ConfidenceInterval& index : {indices.first[0], indices.total[0]}) {
    EXPECT_TRUE(std::isfinite(index.value) && std::isfinite(index.low) && std::isfinite(index.high));
  }
}

// y = (β-normalised sum of normals); P(y >= β) = Φ(−β).
double linear_response(const NormalPoint& u) {
  double sum = 0.0;
  for (const double x : u) sum += x;
  return sum / std::sqrt(static_cast<double>(u.size()));
}

ResponseOfPoints each(double (*response)(const NormalPoint&)) {
  return [response](const std::vector<NormalPoint>& points) {
    std::vector<double> values;
    for (const NormalPoint& point : points) values.push_back(response(point));
    return values;
  };
}

// A few repetitions: within four of their own standard errors. Fifty, over six limit states: subset_study.
TEST(SubsetSimulation, FindsAProbabilityOfAThousandth) {
  const double exact = 1e-3, limit = -normal_quantile(exact);
  double sum = 0.0, variance = 0.0;
  constexpr int repetitions = 10;
  for (std::uint64_t seed = 1; seed <= repetitions; ++seed) {
    const SubsetResult result =
        subset_simulation({.variables = 10, .limit = limit, .seed = seed}, each(linear_response));
    ASSERT_EQ(result.outcome, SubsetOutcome::found);
    EXPECT_LE(result.evaluations, 5000U);
    EXPECT_GE(result.levels.size(), 3U);
    EXPECT_LE(result.levels.size(), 4U);              // the third threshold is near the limit, on either side
    EXPECT_GT(result.levels.back().acceptance, 0.9);  // a linear response is its surface
    sum += result.probability / repetitions;
    variance += std::pow(result.variation * exact / repetitions, 2);
  }
  EXPECT_NEAR(sum, exact, 4.0 * std::sqrt(variance));
  EXPECT_LT(std::sqrt(variance), 0.2 * exact);
}

// Ten seeds per level: were the sample that defines a threshold among them, the mean would be too large by about a
// tenth per level. It is found here within four standard errors.
TEST(SubsetSimulation, CountsNoSampleAtItsThreshold) {
  const double exact = 1e-3, limit = -normal_quantile(exact);
  double sum = 0.0, square = 0.0;
  constexpr int repetitions = 4000;
  for (std::uint64_t seed = 1; seed <= repetitions; ++seed) {
    const double ratio =
        subset_simulation({.variables = 2, .limit = limit, .samples = 100, .seed = seed}, each(linear_response))
            .probability /
        exact;
    sum += ratio / repetitions;
    square += ratio * ratio / repetitions;
  }
  const double standard_error = std::sqrt((square - sum * sum) / repetitions);
  EXPECT_LT(standard_error, 0.025);
  EXPECT_NEAR(sum, 1.0, 4.0 * standard_error);
}

// Responses of few values: the samples of one value go on together or not at all.
TEST(SubsetSimulation, TakesResponsesOfFewValues) {
  const auto steps = [](const NormalPoint& u) { return std::floor(2.0 * linear_response(u)); };
  const double exact = normal_probability(3.0).above;
  double sum = 0.0;
  constexpr int repetitions = 200;
  for (std::uint64_t seed = 1; seed <= repetitions; ++seed) {
    const SubsetResult result = subset_simulation({.variables = 2, .limit = 6.0, .seed = seed}, each(steps));
    EXPECT_EQ(result.outcome, SubsetOutcome::found);
    sum += result.probability / repetitions;
  }
  EXPECT_NEAR(sum, exact, 0.1 * exact);
}

// Points of the last level have the conditional distribution: of the linear response, the mean of y − limit beyond the
// limit is φ(β)/Φ(−β) − β.
TEST(SubsetSimulation, SamplesTheConditionalDistribution) {
  const double limit = -normal_quantile(1e-3);
  double sum = 0.0, count = 0.0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const SubsetResult result =
        subset_simulation({.variables = 3, .limit = limit, .seed = seed}, each(linear_response));
    for (const double y : result.responses) {
      if (y < limit) continue;
      sum += y - limit;
      count += 1.0;
    }
  }
  const double exact = normal_density(limit) / normal_probability(limit).above - limit;
  EXPECT_NEAR(sum / count, exact, 0.1 * exact);
}

// Responses that no quadratic surface follows, infinite ones among them: y = Σu/√n, infinite beyond 3 and with waves
// much shorter than a step; and the largest of ten variables.
TEST(SubsetSimulation, NeedsNoGoodSurface) {
  const auto mean_ratio = [](const SubsetOptions& options, double (*response)(const NormalPoint&), double exact) {
    SubsetOptions one = options;
    double sum = 0.0;
    constexpr int repetitions = 100;
    for (one.seed = 1; one.seed <= repetitions; ++one.seed) {
      const SubsetResult result = subset_simulation(one, each(response));
      EXPECT_GT(result.levels.back().acceptance, 0.2);
      sum += result.probability / exact / repetitions;
    }
    return sum;
  };
  const auto endless = [](const NormalPoint& u) {
    const double y = linear_response(u);
    return y > 3.0 ? INFINITY : y + 0.2 * std::sin(300.0 * u[0]);
  };
  const auto largest = [](const NormalPoint& u) { return *std::max_element(u.begin(), u.end()); };
  EXPECT_NEAR(mean_ratio({.variables = 3, .limit = 4.0}, endless, normal_probability(3.0).above), 1.0, 0.1);
  const double one = normal_probability(3.7).above;
  EXPECT_NEAR(mean_ratio({.variables = 10, .limit = 3.7}, largest, 1.0 - std::pow(1.0 - one, 10)), 1.0, 0.1);
}

TEST(ResponseSurface, IsThatOfAQuadraticResponse) {
  const auto response = [](const std::vector<double>& u) { return 3.0 - u[0] + 2.0 * u[1] + 0.5 * u[1] * u[1]; };
  std::vector<std::vector<double>> points;
  std::vector<double> responses;
  for (std::uint64_t i = 0; i < 40; ++i) {
    points.push_back({normal_random(1, {i, 0, 0}), normal_random(1, {i, 1, 0})});
    responses.push_back(response(points.back()));
  }
  const ResponseSurface surface(points, responses);
  EXPECT_LT(surface.deviation(), 1e-6);
  for (const std::vector<double>& u : points) EXPECT_NEAR(surface(u), response(u), 1e-6);
  responses[5] = INFINITY;  // counts as the largest of the others
  EXPECT_TRUE(std::isfinite(ResponseSurface(points, responses)(points[0])));
}

TEST(ResponseSurface, OfTooFewPointsIsTheirMean) {
  const ResponseSurface surface({{0.0, 1.0}, {1.0, 0.0}}, std::vector<double>{1.0, 5.0});
  EXPECT_EQ(surface(std::vector<double>{7.0, 7.0}), 3.0);
  EXPECT_EQ(surface.deviation(), 2.0);
}

TEST(SubsetSimulation, IsTheSameAgain) {
  const SubsetOptions options{.variables = 2, .limit = 3.5, .samples = 200, .seed = 4};
  const SubsetResult one = subset_simulation(options, each(linear_response));
  const SubsetResult two = subset_simulation(options, each(linear_response));
  EXPECT_EQ(one.probability, two.probability);
  EXPECT_EQ(one.points, two.points);
}

TEST(SubsetSimulation, SaysWhereTheLimitIsNotReached) {
  const SubsetResult rare =
      subset_simulation({.variables = 2, .limit = 30.0, .samples = 100, .most_levels = 4}, each(linear_response));
  EXPECT_EQ(rare.outcome, SubsetOutcome::too_rare);
  double product = 1.0;
  for (const SubsetLevel& level : rare.levels) {
    EXPECT_GE(level.probability, 0.05);  // less where samples that did not move share the threshold
    EXPECT_LE(level.probability, 0.1);
    product *= level.probability;
  }
  EXPECT_EQ(rare.levels.size(), 4U);
  EXPECT_EQ(rare.probability, product);
  const SubsetResult alike =
      subset_simulation({.variables = 2, .limit = 1.0, .samples = 100}, each([](const NormalPoint&) { return 0.5; }));
  EXPECT_EQ(alike.outcome, SubsetOutcome::stalled);
  EXPECT_EQ(alike.evaluations, 100U);
}

// A probability above p0 needs no chains.
TEST(SubsetSimulation, IsMonteCarloWhereTheLimitIsCommon) {
  const SubsetResult result = subset_simulation({.variables = 1, .limit = 0.0, .samples = 1000}, each(linear_response));
  EXPECT_EQ(result.evaluations, 1000U);
  EXPECT_NEAR(result.probability, 0.5, 4.0 * 0.5 / std::sqrt(1000.0));
  EXPECT_NEAR(result.variation, std::sqrt((1.0 - result.probability) / (result.probability * 1000.0)), 1e-12);
}

// Resonance peaks on a slope: the highest point of a grid of 401 with at most a quarter of its points.
TEST(PeakSearch, FindsTheHighestOfThreePeaksWithAQuarterOfTheGrid) {
  for (const double place : {37.3, 171.0, 222.2, 345.9}) {
    const auto curve = [&](std::size_t i) {
      const double x = static_cast<double>(i);
      const auto peak = [&](double at, double height) { return height / std::hypot(1.0, (x - at) / 5.0); };
      return 1e-3 * x + peak(60.0, 2.0) + peak(300.0, 2.2) + peak(place, 3.0);
    };
    std::size_t evaluations = 0, best = 0;
    const PeakSearch search = search_peak({.points = 401}, [&](const std::vector<std::size_t>& points) {
      evaluations += points.size();
      std::vector<double> values;
      for (const std::size_t i : points) values.push_back(curve(i));
      return values;
    });
    for (std::size_t i = 1; i < 401; ++i) {
      if (curve(i) > curve(best)) best = i;
    }
    EXPECT_EQ(search.highest, best) << place;
    EXPECT_TRUE(search.resolved);
    EXPECT_LE(evaluations, 401U / 4U);
  }
}

TEST(PeakSearch, KeepsToItsEvaluationsAndSaysSo) {
  std::size_t evaluations = 0;
  const PeakSearch search = search_peak({.points = 1001, .coarse_step = 100, .share = 0.0, .most_evaluations = 15},
                                        [&](const std::vector<std::size_t>& points) {
                                          evaluations += points.size();
                                          std::vector<double> values;
                                          for (const std::size_t i : points)
                                            values.push_back(std::sin(0.1 * double(i)));
                                          return values;
                                        });
  EXPECT_EQ(evaluations, 15U);
  EXPECT_FALSE(search.resolved);
  EXPECT_EQ(search_peak({.points = 1}, [](const auto& p) { return std::vector<double>(p.size(), 1.0); }).highest, 0U);
}

// Against a look at all points, for limits that all, none and some of the points reach.
TEST(ThresholdSearch, FindsTheFirstPointOfEachSearchThatReachesTheLimit) {
  for (const std::size_t points : {std::size_t{1}, std::size_t{2}, std::size_t{7}, std::size_t{8}, std::size_t{100}}) {
    const auto value = [&](const SearchPoint& p) {
      return std::pow(double(p.point) + 0.5, 1.0 + 0.1 * double(p.search));
    };
    for (const double limit : {0.0, 0.5, 6.3, 50.0, 1e9}) {
      std::size_t rounds = 0;
      const std::vector<ThresholdSearch> found =
          search_thresholds(4, points, limit, [&](const std::vector<SearchPoint>& asked) {
            ++rounds;
            std::vector<double> values;
            for (const SearchPoint& p : asked) values.push_back(value(p));
            return values;
          });
      EXPECT_LE(rounds, static_cast<std::size_t>(std::bit_width(points)));
      ASSERT_EQ(found.size(), 4U);
      for (std::size_t search = 0; search < 4; ++search) {
        std::size_t expected = 0;
        while (expected < points && value({search, expected}) < limit) ++expected;
        EXPECT_EQ(found[search].reached, expected) << points << " points, limit " << limit;
        EXPECT_TRUE(expected == points || found[search].values.count(expected) == 1U);
        EXPECT_TRUE(expected == 0 || found[search].values.count(expected - 1) == 1U);
      }
    }
  }
}

}  // namespace
}  // namespace railtab
