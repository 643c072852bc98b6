// Filters against their transfer functions, measures against signals whose values follow by hand.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <numeric>
#include <random>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/measures/comfort.hpp"
#include "railtab/runtime/measures/low_pass.hpp"
#include "railtab/runtime/measures/low_pass_bank.hpp"
#include "railtab/runtime/measures/percentile.hpp"
#include "railtab/runtime/measures/running_extremes.hpp"
#include "railtab/runtime/measures/running_safety.hpp"
#include "railtab/runtime/measures/section_percentiles.hpp"
#include "railtab/runtime/measures/track_mean.hpp"
#include "railtab/runtime/measures/weighting.hpp"

namespace railtab {
namespace {

constexpr double pi = std::numbers::pi;
using Samples = std::vector<double>;

Samples sampled(const std::function<double(double)>& f, double duration, double step) {
  Samples samples;
  for (long k = 0; static_cast<double>(k) * step < duration; ++k) samples.push_back(f(static_cast<double>(k) * step));
  return samples;
}

Samples weighted(const Weighting& weighting, const Samples& samples, double step) {
  WeightedSeries series(weighting, step);
  Samples result;
  for (const double a : samples) result.push_back(series.add(a));
  return result;
}

/// Gain of a filter at a frequency: what is left of e^{iωt} after `settled` seconds, from its cosine and sine.
template <class Filter>
std::complex<double> gain(double f, double step, double settled, const Filter& filter) {
  const double duration = 2.0 * settled;
  const Samples c = filter(sampled([&](double t) { return std::cos(2.0 * pi * f * t); }, duration, step));
  const Samples s = filter(sampled([&](double t) { return std::sin(2.0 * pi * f * t); }, duration, step));
  const auto k = static_cast<std::size_t>(settled / step);
  return std::complex(c[k], s[k]) * std::polar(1.0, -2.0 * pi * f * step * static_cast<double>(k));
}

std::array<double, 20> frequencies(double lowest) {
  std::array<double, 20> f{};
  for (std::size_t i = 0; i < f.size(); ++i) f[i] = lowest * std::pow(100.0 / lowest, static_cast<double>(i) / 19.0);
  return f;
}

// Of many series at once, over several blocks: as each by itself, also where it is packed and unpacked on the way.
TEST(LowPassBank, FiltersEachSeriesAsItWouldBeAlone) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise;
  constexpr double step = 1e-3, cut_off = 30.0;
  constexpr std::size_t series = 7, samples = 3000;
  std::vector<Samples> stored(series, Samples(samples));
  for (Samples& s : stored) {
    for (double& value : s) value = 5.0 + noise(random);
  }
  std::vector<Samples> filtered(series);
  const LowPassBank::Taker take = [&](long sample, std::span<const double> values) {
    for (std::size_t i = 0; i < series; ++i) {
      ASSERT_EQ(filtered[i].size(), static_cast<std::size_t>(sample));
      filtered[i].push_back(values[i]);
    }
  };
  LowPassBank bank(series, cut_off, step);
  for (std::size_t k = 0; k < samples; ++k) {
    Samples now;
    for (const Samples& s : stored) now.push_back(s[k]);
    bank.add(now, take);
    if (k % 700 != 0) continue;
    std::vector<double> numbers{42.0};
    bank.pack(numbers);
    EXPECT_LE(numbers.size(), 1 + bank.capacity());
    bank = LowPassBank(series, cut_off, step);
    std::span<const double> rest = std::span<const double>(numbers).subspan(1);
    bank.unpack(rest);
    EXPECT_TRUE(rest.empty());
  }
  bank.finish(take);
  for (std::size_t i = 0; i < series; ++i) {
    const Samples expected = low_passed(stored[i], cut_off, step);
    ASSERT_EQ(filtered[i].size(), samples);
    for (std::size_t k = 0; k < samples; ++k) ASSERT_NEAR(filtered[i][k], expected[k], 1e-12) << i << ", " << k;
  }
  std::vector<double> other{3.0, 0.0, 0.0};
  std::span<const double> wrong(other);
  EXPECT_THROW(bank.unpack(wrong), InputError);
}

TEST(RunningExtremes, AreTheFirstOfEqualOnes) {
  RunningExtremes extremes(2);
  EXPECT_TRUE(extremes.empty());
  const std::vector<Samples> samples{{1.0, -2.0}, {3.0, -2.0}, {3.0, 5.0}, {-1.0, 5.0}};
  for (std::size_t k = 0; k < samples.size(); ++k) extremes.add(static_cast<long>(k), samples[k]);
  EXPECT_EQ(extremes.smallest(), (Samples{-1.0, -2.0}));
  EXPECT_EQ(extremes.smallest_at(), (Samples{3.0, 0.0}));
  EXPECT_EQ(extremes.largest(), (Samples{3.0, 5.0}));
  EXPECT_EQ(extremes.largest_at(), (Samples{1.0, 2.0}));
  std::vector<double> numbers;
  extremes.pack(numbers);
  RunningExtremes again(2);
  std::span<const double> rest(numbers);
  again.unpack(rest);
  EXPECT_TRUE(rest.empty());
  EXPECT_EQ(again.largest_at(), extremes.largest_at());
}

TEST(LowPass, HasItsTransferFunctionWithoutPhase) {
  for (const double step : {1e-3, 5e-4}) {
    for (const double cut_off : {20.0, 30.0, 90.0}) {
      for (const double f : frequencies(1.0)) {
        const std::complex<double> G =
            gain(f, step, 1.5, [&](const Samples& s) { return low_passed(s, cut_off, step); });
        EXPECT_NEAR(G.real(), low_pass_gain(f, cut_off), 5e-6) << f << " Hz of " << cut_off;
        EXPECT_NEAR(G.imag(), 0.0, 5e-6) << f << " Hz of " << cut_off;
      }
      EXPECT_NEAR(low_pass_gain(cut_off, cut_off), std::sqrt(0.5), 1e-12);
    }
  }
}

TEST(LowPass, SamplesAtTheLimitOfItsStepAreWithinTheStatedAliasing) {
  constexpr double step = 0.25 / 30.0;
  ASSERT_TRUE(samples_fast_enough(30.0, step));
  ASSERT_FALSE(samples_fast_enough(30.0, 1.01 * step));
  for (const double f : {5.0, 15.0, 25.0, 30.0}) {
    const auto G = gain(f, step, 1.5, [&](const Samples& s) { return low_passed(s, 30.0, step); });
    EXPECT_NEAR(G.real(), low_pass_gain(f, 30.0), 4e-4) << f;
  }
}

TEST(LowPass, StreamedAndStoredAgreeAndMemoryIsBounded) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const Samples samples = sampled([&](double t) { return 5e4 + 2e4 * normal(random) + 1e3 * t; }, 12.0, 1e-3);
  const Samples stored = low_passed(samples, 30.0, 1e-3);
  ZeroPhaseLowPass filter(30.0, 1e-3);
  Samples streamed, piece;
  std::size_t behind = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    piece.clear();
    filter.add(samples[k], piece);
    streamed.insert(streamed.end(), piece.begin(), piece.end());
    behind = std::max(behind, k + 1 - streamed.size());
  }
  filter.finish(streamed);
  ASSERT_EQ(streamed.size(), samples.size());
  EXPECT_LT(behind, 2500U) << "of 12 000 samples";
  const Samples reversed_in(samples.rbegin(), samples.rend());
  const Samples reversed = low_passed(reversed_in, 30.0, 1e-3);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    ASSERT_NEAR(streamed[k], stored[k], 1e-12 * 1e5) << k;
    ASSERT_NEAR(stored[k], reversed[samples.size() - 1 - k], 1e-12 * 1e5) << "symmetric in time, " << k;
  }
}

TEST(LowPass, LeavesAConstantAndALineAlone) {
  for (const double y : low_passed(Samples(3000, 57.5e3), 20.0, 1e-3)) ASSERT_NEAR(y, 57.5e3, 1e-8);
  EXPECT_EQ(low_passed({1.0}, 20.0, 1e-3).size(), 1U);
  const Samples line = low_passed(sampled([](double t) { return t; }, 6.0, 1e-3), 20.0, 1e-3);
  EXPECT_NEAR(line[3000], 3.0, 1e-9);
}

TEST(LowPass, WhiteNoiseKeepsTheVarianceOfItsBand) {
  constexpr double step = 1e-3, cut_off = 30.0;
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const Samples out = low_passed(sampled([&](double) { return normal(random); }, 400.0, step), cut_off, step);
  double variance = 0.0, band = 0.0;
  for (const double y : out) variance += y * y / static_cast<double>(out.size());
  for (double f = 0.005; f < 500.0; f += 0.01) band += 2.0 * step * 0.01 * std::pow(low_pass_gain(f, cut_off), 2);
  // 2 B T = 2·30·400 degrees of freedom: a standard deviation of 0.9 %
  EXPECT_NEAR(variance / band, 1.0, 3.0 * std::sqrt(2.0 / (2.0 * cut_off * 400.0)));
}

TEST(Weighting, IsThatOfTheStandardsAtTheCentresOfThirdOctaves) {
  // ×1000 at 10^(n/10) Hz, from the formulas of EN 12299 and ISO 2631-1; the latter within 1 % of its printed table.
  struct Row {
    int n;
    double k, d, b, c;
  };
  for (const Row& row : {Row{-4, 350, 710, 281, 704},  Row{-3, 419, 854, 336, 844},  Row{-2, 459, 944, 369, 929},
                         Row{-1, 477, 991, 384, 972},  Row{0, 482, 1011, 391, 991},  Row{1, 485, 1007, 396, 1000},
                         Row{2, 493, 971, 406, 1006},  Row{3, 531, 891, 436, 1012},  Row{4, 633, 773, 509, 1017},
                         Row{5, 807, 640, 645, 1023},  Row{6, 965, 514, 818, 1024},  Row{7, 1039, 408, 958, 1013},
                         Row{8, 1054, 323, 1031, 974}, Row{9, 1037, 255, 1056, 894}, Row{10, 988, 202, 1048, 776},
                         Row{11, 899, 160, 1007, 643}, Row{12, 774, 127, 923, 517},  Row{13, 637, 100, 799, 410},
                         Row{14, 510, 80, 660, 324},   Row{15, 403, 63, 529, 255},   Row{16, 316, 50, 416, 200},
                         Row{17, 245, 39, 323, 156},   Row{18, 186, 29, 244, 118},   Row{19, 134, 21, 176, 85}}) {
    const double f = std::pow(10.0, row.n / 10.0);
    EXPECT_NEAR(1e3 * std::abs(weighting_k.response(f)), row.k, 0.51) << f;
    EXPECT_NEAR(1e3 * std::abs(weighting_d.response(f)), row.d, 0.51) << f;
    EXPECT_NEAR(1e3 * std::abs(weighting_b.response(f)), row.b, 0.51) << f;
    EXPECT_NEAR(1e3 * std::abs(weighting_c.response(f)), row.c, 0.51) << f;
  }
}

TEST(Weighting, SeriesHaveItsGainAndPhase) {
  static_assert(samples_fast_enough_to_weight(longest_weighted_step) && !samples_fast_enough_to_weight(2.1e-3));
  for (const double step : {longest_weighted_step, 1e-3, 5e-4}) {
    const double promised = step > 1e-3 ? 1e-2 : 2e-3;
    for (const Weighting* weighting : {&weighting_b, &weighting_c, &weighting_d, &weighting_k}) {
      for (const double f : frequencies(0.4)) {
        const auto found = gain(f, step, 8.0, [&](const Samples& s) { return weighted(*weighting, s, step); });
        const auto expected = weighting->response(f);
        EXPECT_NEAR(std::abs(found), std::abs(expected), promised) << f << " Hz";
        EXPECT_NEAR(std::abs(found - expected), 0.0, promised) << f << " Hz";
      }
    }
  }
}

/// Ratio of the variance of filtered white noise to that of its transfer function |H(f)|², and the standard deviation
/// of that ratio: 1/√(B T) by the bandwidth B of as many degrees of freedom.
template <class Gain>
void expect_noise_of(const Samples& filtered, double step, const Gain& gain_squared) {
  double variance = 0.0, band = 0.0, fourth = 0.0;
  for (const double y : filtered) variance += y * y / static_cast<double>(filtered.size());
  constexpr double df = 0.01;
  for (double f = 0.5 * df; f < 0.5 / step; f += df) {
    const double G = gain_squared(f);
    band += 2.0 * step * df * G;
    fourth += df * G * G;
  }
  const double bandwidth = std::pow(band / (2.0 * step), 2) / fourth;
  const double duration = step * static_cast<double>(filtered.size());
  EXPECT_NEAR(variance / band, 1.0, 3.0 * std::sqrt(1.0 / (bandwidth * duration)));
}

TEST(Weighting, WhiteNoiseHasTheRmsOfItsWeighting) {
  constexpr double step = 1e-3, duration = 600.0;
  for (const Weighting* weighting : {&weighting_b, &weighting_c, &weighting_d, &weighting_k}) {
    std::mt19937 random(11);
    std::normal_distribution<double> normal;
    const Samples noise = sampled([&](double) { return normal(random); }, duration, step);
    expect_noise_of(weighted(*weighting, noise, step), step,
                    [&](double f) { return std::norm(weighting->response(f)); });
  }
}

/// The mean over 2 m of a series, in the middle of its 2 m; at 40 m/s and steps of a millisecond.
Samples means_over_2m(const Samples& samples) {
  constexpr double way = 0.04;
  TrackMean mean(2.0);
  Samples result;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (const auto value = mean.add(way * static_cast<double>(k), samples[k])) result.push_back(*value);
  }
  return result;
}

// sin(π f L/v)/(π f L/v) over 0.05 s, the line through the samples between them: zero at 20, 40, … Hz.
TEST(TrackMean, HasTheTransferFunctionOfASlidingMean) {
  constexpr double step = 1e-3, time = 0.05;
  for (const double f : frequencies(1.0)) {
    const Samples c = means_over_2m(sampled([&](double t) { return std::cos(2.0 * pi * f * t); }, 3.0, step));
    const Samples s = means_over_2m(sampled([&](double t) { return std::sin(2.0 * pi * f * t); }, 3.0, step));
    // the mean that ends 0.05 s after the beginning comes first; its middle is at 0.025 s
    const std::size_t k = 2000;
    const double middle = step * static_cast<double>(k) + 0.5 * time;
    const std::complex<double> G = std::complex(c[k], s[k]) * std::polar(1.0, -2.0 * pi * f * middle);
    const double x = pi * f * time;
    EXPECT_NEAR(G.real(), std::sin(x) / x, 2e-3) << f << " Hz";
    EXPECT_NEAR(G.imag(), 0.0, 1e-9) << f << " Hz";
  }
}

TEST(TrackMean, WhiteNoiseHasTheVarianceOfTheSlidingMean) {
  constexpr double step = 1e-3, time = 0.05;
  std::mt19937 random(13);
  std::normal_distribution<double> normal;
  const Samples noise = sampled([&](double) { return normal(random); }, 400.0, step);
  // the trapezoidal rule over 50 steps: sin(π f n Δt) cos(π f Δt)/(n sin(π f Δt))
  expect_noise_of(means_over_2m(noise), step, [&](double f) {
    const double half = pi * f * step;
    return std::pow(std::sin(pi * f * time) * std::cos(half) / (time / step * std::sin(half)), 2);
  });
}

TEST(TrackMean, IsExactForALineAndForUnevenPositions) {
  TrackMean mean(2.0);
  std::optional<double> last;
  for (const double s : {0.0, 0.3, 1.1, 1.9}) EXPECT_FALSE(mean.add(s, 3.0 * s));
  for (const double s : {2.0, 2.7, 3.15, 5.9}) {
    last = mean.add(s, 3.0 * s);
    ASSERT_TRUE(last);
    EXPECT_NEAR(*last, 3.0 * (s - 1.0), 1e-12) << s;
  }
}

TEST(TrackMean, OfAHalfSineOfFourMetres) {
  TrackMean mean(2.0);
  double largest = 0.0;
  for (int i = 0; i <= 6000; ++i) {
    const double s = 1e-3 * i, value = s > 1.0 && s < 5.0 ? std::sin(pi * (s - 1.0) / 4.0) : 0.0;
    largest = std::max(largest, mean.add(s, value).value_or(0.0));
  }
  EXPECT_NEAR(largest, 2.0 / pi * std::sqrt(2.0), 1e-6) << "(4/π) sin(π/4)";
}

TEST(Percentile, InterpolatesBetweenSortedValues) {
  EXPECT_EQ(percentile({4.0, 1.0, 3.0, 2.0}, 0.0), 1.0);
  EXPECT_EQ(percentile({4.0, 1.0, 3.0, 2.0}, 1.0), 4.0);
  EXPECT_NEAR(percentile({4.0, 1.0, 3.0, 2.0}, 0.5), 2.5, 1e-15);
  Samples thousand;
  for (int i = 0; i <= 10000; ++i) thousand.push_back((i * 7919) % 10001);
  EXPECT_NEAR(percentile(thousand, 0.9985), 9985.0, 1e-9);
  EXPECT_NEAR(percentile(thousand, 0.0015), 15.0, 1e-9);
}

// Sections of 100 m at every 0.5 m: 200 values each, whose percentiles are those of the straight lines between samples.
TEST(SectionPercentiles, OfEachFullSection) {
  SectionPercentiles sections(10.0, 100.0, 0.5), whole(10.0, 0.0, 0.5);
  for (int k = 0; k <= 3000; ++k) {  // to x = 300 m: two full sections, and 90 m of a third
    const double x = 0.1 * k, value = x < 110.0 ? x - 10.0 : -2.0 * (x - 110.0);
    sections.add(x, value);
    whole.add(x, value);
  }
  const std::vector<SectionRange> found = sections.sections();
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NEAR(found[0].from, 10.0, 1e-9);
  EXPECT_NEAR(found[0].to, 110.0, 1e-9);
  // values 0, 0.5, … 99.5: the 0.15 and 99.85 % ones lie 0.0015·199 places from the ends
  EXPECT_NEAR(found[0].low, 0.5 * 0.0015 * 199.0, 1e-9);
  EXPECT_NEAR(found[0].high, 99.5 - 0.5 * 0.0015 * 199.0, 1e-9);
  EXPECT_EQ(found[0].extreme(), found[0].high);
  EXPECT_NEAR(found[1].low, -(199.0 - 0.0015 * 199.0), 1e-9);
  EXPECT_NEAR(found[1].high, -0.0015 * 199.0, 1e-9);
  EXPECT_EQ(found[1].extreme(), found[1].low);
  const std::vector<SectionRange> one = whole.sections();
  ASSERT_EQ(one.size(), 1U);
  EXPECT_NEAR(one[0].from, 10.0, 1e-9);
  EXPECT_NEAR(one[0].to, 300.0, 1e-9);
  EXPECT_NEAR(one[0].high, 99.0 + 0.5 * (0.9985 * 580.0 - 579.0), 1e-9) << "between the largest two of 581";
}

TEST(SectionPercentiles, ALaterSampleBeginsWithTheNextSection) {
  SectionPercentiles sections(0.0, 10.0, 0.5);
  for (int k = 0; k < 300; ++k) sections.add(12.3 + 0.1 * k, 1.0);  // to 42.2 m
  const std::vector<SectionRange> found = sections.sections();
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NEAR(found[0].from, 20.0, 1e-9);
  EXPECT_NEAR(found[1].to, 40.0, 1e-9);
  EXPECT_TRUE(SectionPercentiles(0.0, 0.0, 0.5).sections().empty());
}

TEST(Comfort, RmsDoseAndRunningRmsOfASine) {
  constexpr double step = 1e-3, a = 0.8;
  WindowedRms windows(5.0, step);
  VibrationDose dose(step);
  for (const double y :
       sampled([](double t) { return t < 10.0 ? a * std::sin(2.0 * pi * 4.0 * t) : 0.0; }, 20.0, step)) {
    windows.add(y);
    dose.add(y);
  }
  ASSERT_EQ(windows.values().size(), 4U);
  EXPECT_NEAR(windows.values()[1], a / std::numbers::sqrt2, 1e-9);
  EXPECT_NEAR(windows.values()[2], 0.0, 1e-9);
  EXPECT_NEAR(dose.dose(), std::pow(0.375 * std::pow(a, 4) * 10.0, 0.25), 1e-6) << "mean of sin⁴ is 3/8";
  EXPECT_NEAR(dose.largest_running_rms(), a / std::numbers::sqrt2, 1e-9);
}

TEST(Comfort, RunningRmsWaitsForAFullSecond) {
  VibrationDose dose(0.01);
  for (int i = 0; i < 99; ++i) dose.add(1.0);
  EXPECT_EQ(dose.largest_running_rms(), 0.0);
  dose.add(1.0);
  EXPECT_NEAR(dose.largest_running_rms(), 1.0, 1e-12);
}

TEST(Comfort, MeanOfThreeDirections) {
  const Samples x(60, 0.03), y(60, 0.04), z(60, 0.12);
  EXPECT_NEAR(mean_comfort(x, y, z), 6.0 * 0.13, 1e-12);
}

/// 60 windows in any order, 40 of the lower value and 20 of the upper one: their median and 95th percentile.
Samples two_levels(double lower, double upper, int first) {
  Samples windows;
  for (int k = 0; k < 60; ++k) windows.push_back((k + first) % 3 == 0 ? upper : lower);
  return windows;
}

TEST(Comfort, StandingTakesMediansAndTheHighestLateralWindows) {
  const Samples x = two_levels(0.01, 0.7, 0), y = two_levels(0.015, 0.2, 1), z = two_levels(0.12, 0.9, 2);
  EXPECT_NEAR(mean_comfort_standing(x, y, z), 3.0 * 0.13 + 5.0 * 0.2, 1e-12) << "√(0.04² + 0.03² + 0.12²) = 0.13";
}

TEST(Comfort, SeatedTakesFloorSeatPanAndSeatBack) {
  const Samples z_floor = two_levels(0.5, 0.7, 0), y_pan = two_levels(0.01, 0.03, 1), z_pan = two_levels(0.02, 0.04, 2),
                x_back = two_levels(0.1, 0.11, 0);
  EXPECT_NEAR(mean_comfort_seated(z_floor, y_pan, z_pan, x_back), 4.0 * 0.7 + 2.0 * 0.05 + 4.0 * 0.11, 1e-12);
}

// Sines of another amplitude in each window of 5 s, sample by sample: rms of a ladder of 60 steps, whose median is step
// 30.5 and whose 95th percentile is step 57.05; and the same windows cut from the stored series.
TEST(Comfort, StreamedWindowsOfSinesOfChangingAmplitude) {
  constexpr double step = 1e-2, top = 0.6;
  constexpr long length = 500;  // samples of a window
  const auto amplitude = [](long window) { return top * static_cast<double>(1 + window * 7 % 60) / 60.0; };
  std::array<WindowedRms, 3> streamed{WindowedRms(5.0, step), WindowedRms(5.0, step), WindowedRms(5.0, step)};
  std::array<Samples, 3> series, stored;
  for (long k = 0; k < 60 * length; ++k) {
    for (std::size_t i = 0; i < 3; ++i) {  // 2, 3 and 4 Hz, along x three times as large
      const double a = amplitude(k / length) * (i == 0 ? 3.0 : 1.0);
      series[i].push_back(a * std::sin(2.0 * pi * static_cast<double>(2 + i) * step * static_cast<double>(k)));
      streamed[i].add(series[i].back());
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    for (auto from = series[i].begin(); from != series[i].end(); from += length) {
      stored[i].push_back(std::sqrt(std::inner_product(from, from + length, from, 0.0) / static_cast<double>(length)));
    }
    ASSERT_EQ(streamed[i].values().size(), 60U);
    for (std::size_t k = 0; k < 60; ++k) ASSERT_NEAR(streamed[i].values()[k], stored[i][k], 1e-14) << i << ", " << k;
  }
  const double middle = top * 30.5 / 60.0 / std::numbers::sqrt2, high = top * 57.05 / 60.0 / std::numbers::sqrt2;
  const Samples &x = streamed[0].values(), &y = streamed[1].values(), &z = streamed[2].values();
  EXPECT_NEAR(mean_comfort_standing(x, y, z), 3.0 * middle * std::sqrt(16.0 * 9.0 + 4.0 + 1.0) + 5.0 * high, 1e-12);
  EXPECT_NEAR(mean_comfort_seated(z, y, z, x), high * (4.0 + 2.0 * std::numbers::sqrt2 + 4.0 * 3.0), 1e-12);
  EXPECT_NEAR(mean_comfort(x, y, z), 6.0 * high * std::sqrt(11.0), 1e-12);
}

TEST(Comfort, SperlingIndexOfTwoHarmonics) {
  constexpr double step = 1e-3;
  // 0.3 m/s² at 2 Hz and 0.1 m/s² at 6 Hz, harmonics of 5 s
  SperlingIndex index(SperlingDirection::vertical, step);
  for (const double a :
       sampled([](double t) { return 0.3 * std::sin(2.0 * pi * 2.0 * t) + 0.1 * std::cos(2.0 * pi * 6.0 * t); }, 10.0,
               step)) {
    index.add(a);
  }
  ASSERT_EQ(index.values().size(), 2U);
  const double B2 = 0.588 * std::sqrt((1.911 * 4.0 + 1.0) / (std::pow(1.0 - 1.108, 2) + std::pow(3.126 - 0.2944, 2)));
  const double B6 = 0.588 * std::sqrt((1.911 * 36.0 + 81.0) / (std::pow(1.0 - 9.972, 2) + std::pow(9.378 - 7.9488, 2)));
  EXPECT_NEAR(sperling_weighting(SperlingDirection::vertical, 2.0), B2, 1e-12);
  EXPECT_NEAR(sperling_weighting(SperlingDirection::lateral, 6.0), 1.25 * B6, 1e-12);
  for (const double W : index.values()) {
    EXPECT_NEAR(W, std::pow(std::pow(30.0 * B2, 3) + std::pow(10.0 * B6, 3), 0.1), 1e-9);
  }
}

// 5 s are no multiple of the step: the window is 0.4 ms longer.
TEST(Comfort, SperlingIndexCountsItsLowestHarmonicWhateverTheStep) {
  constexpr double step = 9e-4, lowest = 0.4;
  SperlingIndex index(SperlingDirection::vertical, step);
  for (const double a : sampled([](double t) { return 0.3 * std::sin(2.0 * pi * lowest * t); }, 5.1, step)) {
    index.add(a);
  }
  ASSERT_EQ(index.values().size(), 1U);
  const double B = sperling_weighting(SperlingDirection::vertical, lowest);
  EXPECT_NEAR(index.values()[0], std::pow(30.0 * B, 0.3), 1e-3);
}

TEST(RunningSafety, LimitsOfNadalAndWeinstock) {
  EXPECT_NEAR(nadal_limit(70.0 * pi / 180.0, 0.36), 1.2004, 5e-4);
  EXPECT_NEAR(nadal_limit(pi / 4.0, 0.0), 1.0, 1e-12);
  EXPECT_NEAR(weinstock_ratio(30e3, 40e3, -10e3, 50e3), 0.95, 1e-12);
}

TEST(RunningSafety, UnloadingOfATriangleWithItsDuration) {
  // from 0 to 0.9 in 9 ms and back: above 0.6 for 6 ms, between samples too
  Unloading unloading(0.6);
  for (const double t : {0.0, 4e-3, 7e-3, 9e-3, 11.5e-3, 18e-3, 30e-3}) {
    const double share = std::max(0.0, 0.9 - 100.0 * std::abs(t - 9e-3));
    unloading.add(t, 60e3 * (1.0 - share), 60e3);
  }
  EXPECT_NEAR(unloading.largest(), 0.9, 1e-12);
  EXPECT_NEAR(unloading.time(), 9e-3, 1e-15);
  EXPECT_NEAR(unloading.longest_above(), 6e-3, 1e-12);
  EXPECT_NEAR(unloading.longest_begin(), 6e-3, 1e-12);
}

TEST(RunningSafety, UnloadingThatNeverExceedsTheLimitLastsNoTime) {
  Unloading unloading(0.6);
  for (const double t : {0.0, 1.0, 2.0}) unloading.add(t, 60e3 - 1e3 * t, 60e3);
  EXPECT_EQ(unloading.longest_above(), 0.0);
  EXPECT_NEAR(unloading.largest(), 2.0 / 60.0, 1e-12);
}

}  // namespace
}  // namespace railtab
