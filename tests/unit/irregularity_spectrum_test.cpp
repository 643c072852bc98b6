#include "railtab/runtime/line/irregularity_spectrum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {
namespace {

double variance(const std::vector<double>& values) {
  double sum = 0.0, squares = 0.0;
  for (double v : values) {
    sum += v;
    squares += v * v;
  }
  const auto n = static_cast<double>(values.size());
  return squares / n - (sum / n) * (sum / n);
}

// The mean square of each quantity is the integral of its density: σ of the vertical deviation from 3 m to 25 m at the
// low level is 0.98 mm, of the alignment 0.71 mm [ERRI B 176].
TEST(RandomTrack, HasTheMeanSquareOfItsSpectrum) {
  for (const std::string& name : spectrum_names()) {
    SpectrumParameters p{.name = name, .seed = 3, .shortest = 3.0, .longest = 25.0};
    const Irregularity track = random_irregularity(p, 0.0, 8000.0);
    std::vector<double> vertical, alignment, cross, gauge;
    for (double x = 0.0; x < 8000.0; x += 0.7) {
      const RailDeviation left = track.at(RailSide::left, x), right = track.at(RailSide::right, x);
      vertical.push_back(0.5 * (left.z + right.z));
      alignment.push_back(0.5 * (left.y + right.y));
      cross.push_back((right.z - left.z) / (2.0 * p.half_base));
      gauge.push_back(right.y - left.y);
    }
    TrackSpectrum sum;
    constexpr int steps = 20000;
    const double low = 2.0 * std::numbers::pi / p.longest, high = 2.0 * std::numbers::pi / p.shortest;
    for (int k = 0; k < steps; ++k) {
      const double width = (high - low) / steps;
      const TrackSpectrum S = track_spectrum(name, low + (k + 0.5) * width, p.half_base);
      sum.vertical += S.vertical * width;
      sum.alignment += S.alignment * width;
      sum.cross_level += S.cross_level * width;
      sum.gauge += S.gauge * width;
    }
    // A sample of 8 km of waves up to 25 m: some 8 %.
    EXPECT_NEAR(variance(vertical) / sum.vertical, 1.0, 0.25) << name;
    EXPECT_NEAR(variance(alignment) / sum.alignment, 1.0, 0.25) << name;
    EXPECT_NEAR(variance(cross) / sum.cross_level, 1.0, 0.25) << name;
    EXPECT_NEAR(variance(gauge) / sum.gauge, 1.0, 0.25) << name;
    // σ of vertical deviation and alignment in mm, computed apart from the formulas' coefficients
    const std::map<std::string, std::array<double, 2>> known{{"german-low", {0.98, 0.71}},
                                                             {"german-high", {1.61, 1.21}},
                                                             {"fra-4", {5.7, 5.7 * 0.750}},
                                                             {"fra-5", {3.6, 3.6 * 0.603}},
                                                             {"fra-6", {1.43, 1.43}}};
    EXPECT_NEAR(1e3 * std::sqrt(sum.vertical) / known.at(name)[0], 1.0, 0.015) << name;
    EXPECT_NEAR(1e3 * std::sqrt(sum.alignment) / known.at(name)[1], 1.0, 0.015) << name;
    if (name != "german-low") continue;
    EXPECT_NEAR(std::sqrt(sum.vertical), 0.98e-3, 0.01e-3);
    EXPECT_NEAR(std::sqrt(sum.alignment), 0.71e-3, 0.01e-3);
    EXPECT_NEAR(1.5 * std::sqrt(sum.cross_level), 1.37e-3, 0.01e-3);
    EXPECT_NEAR(std::sqrt(sum.gauge), 0.25e-3, 0.01e-3);
  }
}

TEST(RandomTrack, DependsOnSeedAndPositionAlone) {
  const SpectrumParameters p;
  const Irregularity one = random_irregularity(p, 0.0, 300.0), two = random_irregularity(p, 90.0, 900.0);
  SpectrumParameters other = p;
  other.seed = 2;
  const Irregularity three = random_irregularity(other, 0.0, 300.0);
  double largest = 0.0;
  for (double x = 100.0; x < 290.0; x += 0.37) {
    const double z = one.at(RailSide::left, x).z;
    EXPECT_NEAR(z, two.at(RailSide::left, x).z, 1e-12) << x;
    largest = std::max(largest, std::abs(z - three.at(RailSide::left, x).z));
  }
  EXPECT_GT(largest, 1e-3);
}

TEST(RandomTrack, RisesFromZeroWhereItFadesIn) {
  const SpectrumParameters p{.fade_in = 70.0};
  const Irregularity full = random_irregularity(p, -50.0, 300.0), faded = random_irregularity(p, -50.0, 300.0, 20.0);
  double largest = 0.0;
  for (double x = -40.0; x < 290.0; x += 0.37) {
    const RailDeviation a = full.at(RailSide::right, x), b = faded.at(RailSide::right, x);
    const double s = std::clamp((x - 20.0) / 70.0, 0.0, 1.0), share = s * s * (3.0 - 2.0 * s);
    // a spline through twelve points of the shortest wave follows the product to 1e-3 of it
    EXPECT_NEAR(b.z, share * a.z, 2e-3 * 5e-3 * (share > 0.0 && share < 1.0 ? 1.0 : 0.1)) << x;
    if (x < 19.0 || x > 91.0) {
      EXPECT_NEAR(b.y, x < 19.0 ? 0.0 : a.y, 1e-9) << x;
    }
    largest = std::max(largest, std::abs(b.z));
  }
  EXPECT_GT(largest, 1e-3);
}

TEST(RandomTrack, RejectsWhatItDoesNotKnow) {
  EXPECT_THROW(random_irregularity({.name = "polish"}, 0.0, 1.0), InputError);
  EXPECT_THROW(random_irregularity({.shortest = 80.0}, 0.0, 1.0), InputError);
  EXPECT_THROW(random_irregularity({.seed = -1}, 0.0, 1.0), InputError);
}

}  // namespace
}  // namespace railtab
