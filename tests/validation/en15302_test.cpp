// `tablegen conicity` on the reference profiles of EN 15302 against the standard's reference curves and bands
// [EN15302]. RAILTAB_EXTERNAL_DATA names a folder with facts/en15302: wheels RUIC519*.dat and rail SUIC519A.dat (mm, z
// upwards, origins at 750 mm from the track centre), conicities of the edition of 2008 with their bands, ben_*.dat.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "../measured.hpp"
#include "../robustness/tablegen_fixture.hpp"

namespace railtab {
namespace {

constexpr double mm = 1e-3;

struct Case {
  const char* name;
  const char* wheel;
  double diameter_difference;  // right minus left [m]
};

class En15302Fixture : public TablegenFixture {
 protected:
  void SetUp() override {
    const char* const folder = std::getenv("RAILTAB_EXTERNAL_DATA");
    if (folder == nullptr) GTEST_SKIP() << "RAILTAB_EXTERNAL_DATA is not set";
    data_ = std::filesystem::absolute(folder) / "facts" / "en15302";
    if (!std::filesystem::exists(data_ / "SUIC519A.dat")) GTEST_SKIP() << "no EN 15302 files in " << data_;
    TablegenFixture::SetUp();
  }

  [[nodiscard]] std::string profiles(const std::string& wheel) const {
    return "--wheel '" + (data_ / ("RUIC519" + wheel + ".dat")).string() + "' --rail '" +
           (data_ / "SUIC519A.dat").string() + "' --half-spacing 0.750 --lateral -0.009:0.009 ";
  }
  [[nodiscard]] std::string reference(const std::string& name) const {
    return "--reference '" + (data_ / ("ben_" + name + ".dat")).string() + "' ";
  }
  [[nodiscard]] nlohmann::json conicity(const std::string& arguments) const {
    const Outcome outcome = tablegen("conicity " + arguments + " --quiet --json");
    EXPECT_EQ(outcome.exit_code, 0) << arguments << "\n" << outcome.err;
    return nlohmann::json::parse(outcome.out);
  }

  std::filesystem::path data_;
};

class En15302 : public En15302Fixture, public ::testing::WithParamInterface<Case> {
 protected:
  [[nodiscard]] nlohmann::json curve(const std::string& options) const {
    const Case& c = GetParam();
    return conicity(profiles(c.wheel) + reference(c.name) + "--diameter-difference " +
                    std::to_string(c.diameter_difference) + " " + options);
  }
};

void measured_position(const std::string& name, const nlohmann::json& summary) {
  testing::measured(name + ".position", summary["farthest"].get<double>());
  testing::measured(name + ".amplitude_mm", summary["farthest_amplitude"].get<double>() / mm);
}

// The reference curves come from Δr at shifts 0.1 mm apart.
TEST_P(En15302, InsideTheNarrowBandAtEveryAmplitudeWithEvenShifts) {
  const nlohmann::json found = curve("--sampling even --step 1e-4");
  const nlohmann::json& reference = found["reference"];
  EXPECT_NEAR(found["pair"]["right"]["rail_offset"], 0.750, 1e-12);
  EXPECT_NEAR(found["pair"]["left"]["tape_circle_offset"], 0.750, 1e-12);
  ASSERT_EQ(reference["narrow_position"].size(), 66u);
  EXPECT_EQ(reference["narrow"]["outside"], 0) << reference["narrow"];
  EXPECT_EQ(reference["wide"]["outside"], 0) << reference["wide"];
  measured_position(std::string("en15302.even.") + GetParam().name, reference["narrow"]);
}

// With the jumps of Δr at their places.
TEST_P(En15302, InsideTheWideBandAtEveryAmplitudeWithRefinedShifts) {
  const nlohmann::json reference = curve("--sampling refined")["reference"];
  ASSERT_EQ(reference["wide_position"].size(), 66u);
  EXPECT_EQ(reference["wide"]["outside"], 0) << reference["wide"];
  const std::string name = std::string("en15302.refined.") + GetParam().name;
  measured_position(name, reference["narrow"]);
  testing::measured(name + ".narrow_outside", reference["narrow"]["outside"].get<int>());
}

INSTANTIATE_TEST_SUITE_P(Cases, En15302,
                         ::testing::Values(Case{"E1", "A", 0.0}, Case{"E2", "B", 0.0}, Case{"E3", "H", 0.0},
                                           Case{"E5", "A", 2.0 * mm}, Case{"E6", "B", 2.0 * mm},
                                           Case{"E8", "I", 2.0 * mm}),
                         [](const auto& c) { return std::string(c.param.name); });

// Next to jumps of Δr, where refined shifts leave the narrow band of 2008, the edition of 2021 has another reference
// (Annex K, numbers as quoted by the public package github.com/rohrbecka/EN15302): 0.058 became 0.030, 0.075 became
// 0.110.
struct Jump {
  const char* name;
  const char* wheel;
  double amplitude_mm, low, high;  // narrow band of 2021
};
constexpr Jump jumps[] = {{"E2", "B", 3.0, 0.015, 0.045},
                          {"E2", "B", 3.2, 0.063, 0.163},
                          {"E3", "H", 2.6, 0.060, 0.160},
                          {"E3", "H", 2.8, 0.156, 0.256}};

void expect_inside(const Jump& jump, const std::string& route, double tan_gamma) {
  EXPECT_GE(tan_gamma, jump.low) << jump.name << " " << jump.amplitude_mm;
  EXPECT_LE(tan_gamma, jump.high) << jump.name << " " << jump.amplitude_mm;
  const std::string amplitude = std::to_string(static_cast<int>(std::lround(10.0 * jump.amplitude_mm)));
  testing::measured("en15302." + route + "." + jump.name + ".at_" + amplitude, tan_gamma);
}

class En15302Jumps : public En15302Fixture {};

TEST_F(En15302Jumps, PointsOf2008WithRefinedShiftsAreInsideTheNarrowBandOf2021) {
  for (const Jump& jump : jumps) {
    const nlohmann::json found =
        conicity(profiles(jump.wheel) + "--amplitude " + std::to_string(jump.amplitude_mm * mm));
    expect_inside(jump, "refined", found["wave"]["conicity"]);
  }
}

// Profiles by the formulas of the edition of 2021 (Annex I, from the same package) [mm], z downwards, as far as they
// come into contact.
double arc(double y, double centre_y, double centre_z, double radius) {
  return centre_z - std::sqrt(radius * radius - (y - centre_y) * (y - centre_y));
}
double wheel_b(double y) {
  if (y < -29.3505) return arc(y, -25.6322, 17.7814, 14.0);
  return y < -0.4787 ? arc(y, 2.5204, 119.9745, 120.0) : -0.025 * y;
}
double wheel_h(double y) {
  if (y < -28.3119) return arc(y, -25.5663, 17.6003, 14.0);
  return y < -10.2297 ? -1.7902 - 0.2 * y : -0.025 * y;
}
double rail_a(double y) {
  if (y < -23.2401) return arc(y, -19.63949, 15.899044, 13.0);
  if (y < -7.8749) return arc(y, -1.0825, 80.277908, 80.0);
  if (y < 13.0989) return arc(y, 17.5966, 299.48349, 300.0);
  return y < 28.6709 ? arc(y, 14.29829, 79.508225, 80.0) : arc(y, 26.33535, 13.598369, 13.0);
}

class En15302Formulas : public TablegenFixture {
 protected:
  void write(const std::string& name, double (*profile)(double), double y_low, double y_high) const {
    std::ofstream file(folder_ / name);
    file.precision(12);
    file << "# units: mm\n";
    constexpr int intervals = 1500;
    for (int i = 0; i <= intervals; ++i) {
      const double y = y_low + (y_high - y_low) * i / intervals;
      file << y << ' ' << profile(y) << '\n';
    }
  }
};

TEST_F(En15302Formulas, RefinedShiftsAreInsideTheNarrowBandOf2021) {
  write("B.dat", wheel_b, -38.7, 30.0);
  write("H.dat", wheel_h, -38.7, 30.0);
  write("rail.dat", rail_a, -32.6, 39.2);
  for (const Jump& jump : jumps) {
    const Outcome outcome = tablegen("conicity --wheel " + std::string(jump.wheel) +
                                     ".dat --rail rail.dat --half-spacing 0.750 --lateral -0.005:0.005 --amplitude " +
                                     std::to_string(jump.amplitude_mm * mm) + " --quiet --json");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    expect_inside(jump, "formulas", nlohmann::json::parse(outcome.out)["wave"]["conicity"]);
  }
}

// Step 2 of [EN15302, 6.2]: 20 runs each with random errors and a grid, at wheels, rails and both.
class En15302Errors : public En15302Fixture {};

TEST_F(En15302Errors, MeanOfRunsInsideTheWideBand) {
  const struct {
    const char *name, *options;
  } errors[] = {{"random", "--random-error 10e-6 --smoothing 10e-6"},
                {"grid", "--grid 20e-6 --smoothing 6e-6"},
                {"spacing", "--spacing 0.5e-3"}};
  for (const auto& [name, options] : errors) {
    const nlohmann::json found =
        conicity(profiles("A") + reference("E1") + "--sampling even --runs 20 --seed 1 " + options);
    for (const char* bearer : {"wheels", "rails", "both"}) {
      const nlohmann::json& study = found["errors"][bearer];
      double largest_deviation = 0.0;
      int outside = 0;
      for (std::size_t i = 0; i < 66; ++i) {
        ASSERT_EQ(study["found"][i], 20) << name << " " << bearer << " " << i;
        largest_deviation = std::max(largest_deviation, study["standard_deviation"][i].get<double>());
        outside += 20 - study["inside_wide"][i].get<int>();
      }
      const std::string key = std::string("en15302.errors.") + name + "." + bearer;
      testing::measured(key + ".standard_deviation", largest_deviation);
      testing::measured(key + ".outside", outside);
      EXPECT_GT(largest_deviation, 0.0);
    }
  }
}

}  // namespace
}  // namespace railtab
