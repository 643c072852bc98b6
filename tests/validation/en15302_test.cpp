// `tablegen conicity` on the reference profiles of EN 15302 against the standard's reference curves and bands
// [EN15302]. RAILTAB_EXTERNAL_DATA names a folder with facts/en15302: wheels RUIC519*.dat and rail SUIC519A.dat (mm, z
// upwards, origins at 750 mm from the track centre), conicities of the edition of 2008 with their bands, ben_*.dat.
// Profiles by formulas and conicities of the edition of 2021 (Annexes I and K) are here, as quoted by the public
// package github.com/rohrbecka/EN15302.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../measured.hpp"
#include "../robustness/tablegen_fixture.hpp"
#include "railtab/tablegen/conicity_bands.hpp"

namespace railtab {
namespace {

constexpr double mm = 1e-3;

/// A stretch of a profile [mm], z downwards: z = a + b y, or an arc about (a, b) of the radius r, above its centre
/// where r > 0, below it where r < 0.
struct Zone {
  double end;  // of y
  double a, b, r;

  [[nodiscard]] double z(double y) const {
    if (r == 0.0) return a + b * y;
    return b - std::copysign(std::sqrt(r * r - (y - a) * (y - a)), r);
  }
};
using Zones = std::vector<Zone>;

// Flange from y = -49 mm, root, tread up to 60 mm.
const std::map<std::string, Zones> wheel_formulas = {{"A",
                                                      {{-39.7645, -58.5583, 8.83556, -20.0},
                                                       {-38.7372, -93.57685, -2.7475, 0.0},
                                                       {-29.4591, -25.5816, 17.64215, 14.0},
                                                       {-10.8749, -2.6594, 97.16493, 96.76055},
                                                       {18.4173, 18.4173, 344.50806, 345.0},
                                                       {30.0, -0.49194, 0.0, 0.0},
                                                       {60.0, 1.50804, -0.066666, 0.0}}},
                                                     {"B",
                                                      {{-39.7640, -58.5583, 8.8349, -20.0},
                                                       {-38.7879, -93.5767, -2.7475, 0.0},
                                                       {-29.3505, -25.6322, 17.7814, 14.0},
                                                       {-0.4787, 2.5204, 119.9745, 120.0},
                                                       {30.0, 0.0, -0.025, 0.0},
                                                       {60.0, 0.75, -0.05, 0.0}}},
                                                     {"H",
                                                      {{-39.7645, -58.5583, 8.8349, -20.0},
                                                       {-38.7220, -93.5767, -2.7475, 0.0},
                                                       {-28.3119, -25.5663, 17.6003, 14.0},
                                                       {-10.2297, -1.7902, -0.2, 0.0},
                                                       {30.0, 0.0, -0.025, 0.0},
                                                       {60.0, 1.251, -0.0667, 0.0}}},
                                                     {"I",
                                                      {{-39.7640, -58.5583, 8.83545, -20.0},
                                                       {-39.0486, -93.5767, -2.7475, 0.0},
                                                       {-29.9231, -25.8929, 18.49733, 14.0},
                                                       {5.0, 5.0, std::sqrt(14375.0), 120.0},
                                                       {30.0, std::sqrt(14375.0) - 120.0, 0.0, 0.0},
                                                       {60.0, 1.89679, -0.0667, 0.0}}}};
const Zones rail_formula = {{-23.2401, -19.63949, 15.899044, 13.0},
                            {-7.8749, -1.0825, 80.277908, 80.0},
                            {13.0989, 17.5966, 299.48349, 300.0},
                            {28.6709, 14.29829, 79.508225, 80.0},
                            {39.2, 26.33535, 13.598369, 13.0}};

void write_profile(const std::filesystem::path& file, const Zones& zones, double y_low) {
  std::ofstream out(file);
  out.precision(12);
  out << "# units: mm\n";
  constexpr int intervals = 2000;
  const double y_high = zones.back().end;
  for (int i = 0; i <= intervals; ++i) {
    const double y = y_low + (y_high - y_low) * i / intervals;
    const auto zone = std::find_if(zones.begin(), zones.end() - 1, [&](const Zone& z) { return y < z.end; });
    out << y << ' ' << zone->z(y) << '\n';
  }
}

constexpr const char* placed = "--half-spacing 0.750 --lateral -0.009:0.009 ";

/// The wheel and the rail by formulas, as files of the folder.
std::string formula_profiles(const std::filesystem::path& folder, const std::string& wheel) {
  write_profile(folder / (wheel + ".dat"), wheel_formulas.at(wheel), -49.0);
  write_profile(folder / "rail.dat", rail_formula, -32.6);
  return "--wheel " + wheel + ".dat --rail rail.dat " + placed;
}

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
           (data_ / "SUIC519A.dat").string() + "' " + placed;
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
  /// The comparison with the bands, measured under `route`.
  [[nodiscard]] nlohmann::json bands(const std::string& route, const std::string& arguments) const {
    const Case& c = GetParam();
    const nlohmann::json reference = conicity(arguments + reference_option() + "--diameter-difference " +
                                              std::to_string(c.diameter_difference))["reference"];
    EXPECT_EQ(reference["narrow_position"].size(), 66u);
    const std::string name = "en15302." + route + "." + c.name;
    testing::measured(name + ".position", reference["narrow"]["farthest"].get<double>());
    testing::measured(name + ".amplitude_mm", reference["narrow"]["farthest_amplitude"].get<double>() / mm);
    testing::measured(name + ".narrow_outside", reference["narrow"]["outside"].get<int>());
    return reference;
  }

 private:
  [[nodiscard]] std::string reference_option() const { return reference(GetParam().name); }
};

// The reference curves come from the formulas, with Δr at shifts 0.1 mm apart. Δr of the standard has three decimals.
TEST_P(En15302, FormulasWithEvenShiftsAreInsideTheNarrowBandAtEveryAmplitude) {
  const nlohmann::json found =
      bands("formulas_even", formula_profiles(folder_, GetParam().wheel) + "--sampling even --step 1e-4 ");
  EXPECT_EQ(found["narrow"]["outside"], 0) << found["narrow"];
  EXPECT_EQ(found["wide"]["outside"], 0) << found["wide"];
}

// Points of the standard, rounded to 1 µm, move jumps of Δr by some micrometres.
TEST_P(En15302, PointsAreInsideTheWideBandAtEveryAmplitude) {
  const nlohmann::json even = bands("even", profiles(GetParam().wheel) + "--sampling even --step 1e-4 ");
  EXPECT_EQ(even["wide"]["outside"], 0) << even["wide"];
  const nlohmann::json refined = bands("refined", profiles(GetParam().wheel));
  EXPECT_EQ(refined["wide"]["outside"], 0) << refined["wide"];
}

TEST_P(En15302, OriginsLieAtTheHalfSpacing) {
  const nlohmann::json pair = conicity(profiles(GetParam().wheel))["pair"];
  for (const char* side : {"right", "left"}) {
    EXPECT_NEAR(pair[side]["rail_offset"], 0.750, 1e-12);
    EXPECT_NEAR(pair[side]["tape_circle_offset"], 0.750, 1e-12);
    EXPECT_NEAR(pair[side]["gauge"], 1.43516, 0.05 * mm);  // the standard's gauge
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, En15302,
                         ::testing::Values(Case{"E1", "A", 0.0}, Case{"E2", "B", 0.0}, Case{"E3", "H", 0.0},
                                           Case{"E5", "A", 2.0 * mm}, Case{"E6", "B", 2.0 * mm},
                                           Case{"E8", "I", 2.0 * mm}),
                         [](const auto& c) { return std::string(c.param.name); });

// Next to jumps of Δr, where refined shifts leave the narrow band of 2008, the edition of 2021 has another reference:
// 0.058 became 0.030, 0.075 became 0.110.
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

class En15302Formulas : public TablegenFixture {};

TEST_F(En15302Formulas, RefinedShiftsAreInsideTheNarrowBandOf2021) {
  for (const Jump& jump : jumps) {
    const Outcome outcome = tablegen("conicity " + formula_profiles(folder_, jump.wheel) +
                                     "--quiet --json --amplitude " + std::to_string(jump.amplitude_mm * mm));
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
  const std::vector<ConicityBand> band = read_conicity_bands(data_ / "ben_E1.dat");
  ASSERT_EQ(band.size(), 66u);
  for (const auto& [name, options] : errors) {
    const nlohmann::json found =
        conicity(profiles("A") + reference("E1") + "--sampling even --runs 20 --seed 1 " + options);
    for (const char* bearer : {"wheels", "rails", "both"}) {
      const nlohmann::json& study = found["errors"][bearer];
      double largest_deviation = 0.0;
      int outside = 0;
      for (std::size_t i = 0; i < 66; ++i) {
        ASSERT_EQ(study["found"][i], 20) << name << " " << bearer << " " << i;
        EXPECT_LE(study["mean"][i], band[i].wide.upper) << name << " " << bearer << " " << i;
        EXPECT_GE(study["mean"][i], band[i].wide.lower) << name << " " << bearer << " " << i;
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
