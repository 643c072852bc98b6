// Equivalent conicity of the reference profiles of EN 15302 against the standard's reference curves and bands
// [EN15302]. RAILTAB_EXTERNAL_DATA names a folder with facts/en15302: wheels RUIC519*.dat and rail SUIC519A.dat (mm, z
// upwards, y = 0 at 750 mm from the track centre), rolling radius differences dr_*.dat, conicities with their bands
// ben_*.dat.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "../measured.hpp"
#include "railtab/runtime/contact/contact_search.hpp"
#include "railtab/runtime/contact/equivalent_conicity.hpp"
#include "railtab/runtime/profile/profile_file.hpp"

namespace railtab {
namespace {

constexpr double mm = 1e-3;
constexpr double half_spacing = 0.750;  // of the profiles' origins [m]

std::vector<std::vector<double>> read_columns(const std::filesystem::path& file, std::size_t columns) {
  std::ifstream in(file);
  std::vector<std::vector<double>> column(columns);
  for (std::size_t i = 0;; ++i) {
    double value = 0;
    if (!(in >> value)) return column;
    column[i % columns].push_back(value);
  }
}

struct Case {
  const char* name;
  const char* wheel;
  double diameter_difference;  // right minus left [m]
};

class En15302 : public ::testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    const char* const folder = std::getenv("RAILTAB_EXTERNAL_DATA");
    if (folder == nullptr) GTEST_SKIP() << "RAILTAB_EXTERNAL_DATA is not set";
    folder_ = std::filesystem::path(folder) / "facts" / "en15302";
    if (!std::filesystem::exists(folder_ / "SUIC519A.dat")) GTEST_SKIP() << "no EN 15302 files in " << folder_;
  }

  [[nodiscard]] ProfileKnots profile(ProfileKind kind, const std::string& file) const {
    auto column = read_columns(folder_ / file, 2);
    for (double& y : column[0]) y *= mm;
    for (double& z : column[1]) z *= -mm;
    return spline_through_points(kind, file, column[0], column[1]);
  }

  // The pair in the standard's set-up: both profiles' origins at 750 mm.
  [[nodiscard]] ContactSearch search() const {
    ProfileCurve wheel(profile(ProfileKind::wheel, std::string("RUIC519") + GetParam().wheel + ".dat"));
    ProfileCurve rail(profile(ProfileKind::rail, "SUIC519A.dat"));
    PairDimensions dimensions;
    dimensions.flange_back = 2.0 * (half_spacing - PairDimensions::tape_circle_to_flange_back);
    // The rail keeps the file's frame here, so that its origin has to come to lie at half_spacing.
    const WheelRailPair trial(wheel, rail, dimensions);
    dimensions.track_gauge += 2.0 * (half_spacing - trial.rail_offset());
    return ContactSearch(WheelRailPair(std::move(wheel), std::move(rail), dimensions));
  }

  std::filesystem::path folder_;
};

std::vector<WheelsetContact> contacts(const ContactSearch& search, WheelsetRoll roll, double difference) {
  WheelsetContactOptions options;
  options.y_low = -9.0 * mm;
  options.y_high = 9.0 * mm;
  options.roll = roll;
  options.diameter_difference = difference;
  return wheelset_contacts([&](const WheelsetPose& pose, double near_miss) { return search.patches(pose, near_miss); },
                           search.pair(), options);
}

TEST_P(En15302, ConicityInsideTheBandAtEveryAmplitude) {
  const ContactSearch s = search();
  EXPECT_NEAR(s.pair().rail_offset(), half_spacing, 1e-12);
  const auto wheelset = contacts(s, WheelsetRoll::off, GetParam().diameter_difference);
  const RadiusDifferenceCurve curve(wheelset);
  const auto band = read_columns(folder_ / (std::string("ben_") + GetParam().name + ".dat"), 6);
  ASSERT_EQ(band[0].size(), 66u);
  double worst = 0.0, worst_at = 0.0, largest = 0.0;  // position in the band, -1 lower to 1 upper limit
  double worst_narrow = 0.0;
  int outside_narrow = 0;
  for (std::size_t i = 0; i < band[0].size(); ++i) {
    const EquivalentConicity wave = conicity_of_wave(curve, band[0][i] * mm);
    ASSERT_EQ(wave.status, ConicityStatus::found) << band[0][i];
    const auto position = [&](double tan_gamma, std::size_t upper) {
      const double reference = band[1][i];
      const double high = band[upper][i], low = band[upper + 1][i];
      return tan_gamma >= reference ? (tan_gamma - reference) / (high - reference)
                                    : (tan_gamma - reference) / (reference - low);
    };
    EXPECT_LE(wave.tan_gamma, band[4][i]) << band[0][i];
    EXPECT_GE(wave.tan_gamma, band[5][i]) << band[0][i];
    if (const double p = position(wave.tan_gamma, 4); std::abs(p) > std::abs(worst)) {
      worst = p;
      worst_at = band[0][i];
    }
    if (const double p = position(wave.tan_gamma, 2); std::abs(p) > std::abs(worst_narrow)) worst_narrow = p;
    if (std::abs(position(wave.tan_gamma, 2)) > 1.0) ++outside_narrow;
    largest = std::max(largest, std::abs(wave.tan_gamma - band[1][i]));
  }
  const std::string name = std::string("en15302.") + GetParam().name;
  testing::measured(name + ".position", worst);
  testing::measured(name + ".amplitude_mm", worst_at);
  testing::measured(name + ".difference", largest);
  testing::measured(name + ".narrow_outside", outside_narrow);
  testing::measured(name + ".narrow_position", worst_narrow);
}

INSTANTIATE_TEST_SUITE_P(Cases, En15302,
                         ::testing::Values(Case{"E1", "A", 0.0}, Case{"E2", "B", 0.0}, Case{"E3", "H", 0.0},
                                           Case{"E5", "A", 2.0 * mm}, Case{"E6", "B", 2.0 * mm},
                                           Case{"E8", "I", 2.0 * mm}),
                         [](const auto& c) { return std::string(c.param.name); });

}  // namespace
}  // namespace railtab
