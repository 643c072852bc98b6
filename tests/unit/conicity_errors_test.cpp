// Errors of measured profiles, the spread of the conicity that they cause, and files of tolerance bands.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include "railtab/runtime/base/constants.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/profile/profile_file.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/tablegen/conicity_bands.hpp"
#include "railtab/tablegen/conicity_errors.hpp"
#include "railtab/tablegen/profile_errors.hpp"

namespace railtab {
namespace {

constexpr double um = 1e-6;

// A straight line of 2001 points, on which displacements are not repaired.
ProfileKnots flat_rail() {
  std::vector<double> y, z;
  for (int i = -1000; i <= 1000; ++i) {
    y.push_back(i * 0.05 * mm);
    z.push_back(0.0);
  }
  return spline_through_points(ProfileKind::rail, "flat", y, z);
}

TEST(ProfileErrors, RandomErrorsHaveTheirDeviationAndDirection) {
  const ProfileKnots exact = flat_rail();
  std::mt19937_64 generator(7);
  ProfileErrors errors;
  errors.deviation = 3.0 * um;
  errors.direction = ErrorDirection::z;
  const ProfileKnots measured = measured_profile(exact, errors, 0.0, generator);
  ASSERT_EQ(measured.y.size(), exact.y.size());
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < measured.z.size(); ++i) {
    EXPECT_EQ(measured.y[i], exact.y[i]);
    sum += measured.z[i];
    squares += measured.z[i] * measured.z[i];
  }
  const auto n = static_cast<double>(measured.z.size());
  // Four standard errors of the mean and of the standard deviation of 2001 samples.
  EXPECT_NEAR(sum / n, 0.0, 4.0 * errors.deviation / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(squares / n), errors.deviation, 4.0 * errors.deviation / std::sqrt(2.0 * n));
}

TEST(ProfileErrors, TheGridRoundsAboutARandomOrigin) {
  const ProfileKnots exact = standard_profile(ProfileKind::wheel, "S1002", 0.0);
  std::mt19937_64 generator(7);
  ProfileErrors errors;
  errors.grid = 20.0 * um;
  errors.direction = ErrorDirection::z;
  const ProfileKnots measured = measured_profile(exact, errors, 0.0, generator);
  const double origin = measured.z.front();
  EXPECT_GT(std::abs(std::remainder(origin, errors.grid)), 1e-9);
  double largest = 0.0;
  for (std::size_t i = 0; i < measured.z.size(); ++i) {
    EXPECT_NEAR(std::remainder(measured.z[i] - origin, errors.grid), 0.0, 1e-12);
    largest = std::max(largest, std::abs(measured.z[i] - exact.z[i]));
  }
  EXPECT_LE(largest, 0.5 * errors.grid + 1e-12);
  EXPECT_GT(largest, 0.45 * errors.grid);
}

TEST(ProfileErrors, PointsAtASpacingKeepTheEndsAndLieOnTheProfile) {
  const ProfileKnots exact = standard_profile(ProfileKind::wheel, "S1002", 0.0);
  const ProfileCurve curve(exact);
  std::mt19937_64 generator(7);
  ProfileErrors errors;
  errors.spacing = 0.5 * mm;
  const ProfileKnots measured = measured_profile(exact, errors, 0.0, generator);
  EXPECT_EQ(measured.y.front(), exact.y.front());
  EXPECT_EQ(measured.y.back(), exact.y.back());
  const double length = curve.s_end() - curve.s_begin();
  EXPECT_NEAR(static_cast<double>(measured.y.size()), length / errors.spacing + 1.5, 1.5);
  for (std::size_t i = 2; i + 2 < measured.s.size(); ++i) {
    EXPECT_NEAR(measured.s[i + 1] - measured.s[i], errors.spacing, 1e-3 * errors.spacing);
  }
}

TEST(ProfileErrors, RejectsErrorsOutOfRange) {
  ProfileErrors errors;
  errors.deviation = -1e-6;
  EXPECT_THROW(errors.validate(), InputError);
  errors = {};
  errors.grid = 2e-3;
  EXPECT_THROW(errors.validate(), InputError);
  errors = {};
  errors.spacing = std::nan("");
  EXPECT_THROW(errors.validate(), InputError);
}

WheelsetPair s1002_on_60e1() {
  const WheelRailPair side(ProfileCurve(standard_profile(ProfileKind::wheel, "S1002", 0.0)),
                           ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)), PairDimensions{});
  return {side, side};
}

ConicityErrorOptions few_runs(double deviation) {
  ConicityErrorOptions options;
  options.errors.deviation = deviation;
  options.errors.direction = ErrorDirection::z;
  options.smoothing = deviation;
  options.runs = 4;
  options.amplitudes = {3.0 * mm};
  options.contact.y_low = -5.0 * mm;
  options.contact.y_high = 5.0 * mm;
  return options;
}

TEST(ConicityErrors, RunsFollowFromTheSeed) {
  const WheelsetPair pair = s1002_on_60e1();
  ConicityErrorOptions options = few_runs(2.0 * um);
  const ConicityRuns first = conicity_with_errors(pair, ErrorBearer::both, options);
  EXPECT_EQ(conicity_with_errors(pair, ErrorBearer::both, options), first);
  EXPECT_NE(first[0][0], first[1][0]);
  options.seed = 2;
  EXPECT_NE(conicity_with_errors(pair, ErrorBearer::both, options), first);
}

// Without errors every run is the exact computation; errors of a tenth spread it less.
TEST(ConicityErrors, TheSpreadVanishesWithTheErrors) {
  const WheelsetPair pair = s1002_on_60e1();
  const RadiusDifferenceCurve curve(searched_contacts(pair, few_runs(0.0).contact));
  const double exact = conicity_of_wave(curve, 3.0 * mm).tan_gamma;
  const auto spread = [&](double deviation) {
    const ConicityRuns runs = conicity_with_errors(pair, ErrorBearer::both, few_runs(deviation));
    double largest = 0.0;
    for (const auto& run : runs) largest = std::max(largest, std::abs(run[0] - exact));
    return largest;
  };
  EXPECT_LT(spread(0.0), 1e-6);  // the spline through the knots is not the built-in curve between them
  const double small = spread(1.0 * um), large = spread(10.0 * um);
  EXPECT_GT(large, 2.0 * small);
  EXPECT_LT(large, 0.1 * exact);
}

TEST(ConicityErrors, StatisticsLeaveOutRunsWithoutAWave) {
  const double none = std::nan("");
  const RunStatistics s = run_statistics({{1.0, none}, {2.0, none}, {none, none}, {6.0, none}}, 0);
  EXPECT_EQ(s.found, 3);
  EXPECT_DOUBLE_EQ(s.mean, 3.0);
  EXPECT_DOUBLE_EQ(s.standard_deviation, std::sqrt(7.0));
  EXPECT_EQ(s.least, 1.0);
  EXPECT_EQ(s.greatest, 6.0);
  const RunStatistics empty = run_statistics({{1.0, none}}, 1);
  EXPECT_EQ(empty.found, 0);
  EXPECT_TRUE(std::isnan(empty.mean));
}

TEST(ConicityBands, PositionsCountFromTheReferenceToTheLimits) {
  const ConicityLimits limits{0.3, 0.1};
  EXPECT_DOUBLE_EQ(band_position(0.25, 0.25, limits), 0.0);
  EXPECT_DOUBLE_EQ(band_position(0.3, 0.25, limits), 1.0);
  EXPECT_DOUBLE_EQ(band_position(0.1, 0.25, limits), -1.0);
  EXPECT_DOUBLE_EQ(band_position(0.175, 0.25, limits), -0.5);
  EXPECT_TRUE(std::isinf(band_position(0.4, 0.3, limits)));
}

TEST(ConicityBands, ReadsRowsAndNamesTheWrongOne) {
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "conicity_bands.txt";
  const auto read = [&](const std::string& text) {
    std::ofstream(file) << text;
    return read_conicity_bands(file);
  };
  const auto bands = read("# amplitude ...\n1.0 0.10 0.15 0.05 0.2 0.01\n\n2.5 0.2 0.25 0.15 0.3 0.1 # end\n");
  ASSERT_EQ(bands.size(), 2u);
  EXPECT_DOUBLE_EQ(bands[1].amplitude, 2.5 * mm);
  EXPECT_EQ(bands[1].narrow.upper, 0.25);
  EXPECT_EQ(bands[1].wide.lower, 0.1);
  const auto message = [&](const std::string& text) -> std::string {
    try {
      (void)read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message("1 0.1 0.15 0.05 0.2\n").find("conicity_bands.txt:1"), std::string::npos);
  EXPECT_NE(message("1 0.1 0.15 0.05 0.2 x\n").find("'x'"), std::string::npos);
  EXPECT_NE(message("2 0.1 0.15 0.05 0.2 0\n2 0.1 0.15 0.05 0.2 0\n").find(":2"), std::string::npos);
  EXPECT_NE(message("1 0.1 0.05 0.15 0.2 0\n").find("narrow"), std::string::npos);
  EXPECT_NE(message("# nothing\n").find("no rows"), std::string::npos);
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace railtab
