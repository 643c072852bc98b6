// `tablegen conicity` on profiles, without a table: placement, unlike sides, curves, bands, errors and wrong input.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tablegen_fixture.hpp"

namespace railtab {
namespace {

constexpr const char* cones = "conicity --wheel cone-1:40 --rail 60E1 --rail-inclination 0 --lateral -0.006:0.006 ";

class ConicityCommand : public TablegenFixture {
 protected:
  [[nodiscard]] nlohmann::json json(const std::string& arguments) const {
    const Outcome outcome = tablegen(arguments + " --json --quiet");
    EXPECT_EQ(outcome.exit_code, 0) << arguments << "\n" << outcome.err;
    return nlohmann::json::parse(outcome.out);
  }
  /// Exit code 2, nothing on stdout, one message on stderr with both texts in it.
  void expect_rejected(const std::string& arguments, const std::string& place, const std::string& expected = "") const {
    const Outcome outcome = tablegen(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments << "\n" << outcome.err;
    EXPECT_EQ(outcome.out, "") << arguments;
    EXPECT_NE(outcome.err.find(place), std::string::npos) << arguments << "\n" << outcome.err;
    EXPECT_NE(outcome.err.find(expected), std::string::npos) << arguments << "\n" << outcome.err;
  }
  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }
};

TEST_F(ConicityCommand, WrongArguments) {
  expect_rejected("conicity", "--wheel");
  expect_rejected("conicity --wheel S1002", "--rail");
  expect_rejected("conicity --wheel none.txt --rail 60E1", "none.txt");
  expect_rejected("conicity --wheel S1002 --rail 60E1 --left-wheel none.txt", "none.txt");
  expect_rejected("conicity table.h5 --wheel S1002", "--wheel", "in place of a table");
  expect_rejected("conicity table.h5 --lateral -1e-3:1e-3", "--lateral", "in place of a table");
  expect_rejected("conicity table.h5 --gauge 1.435", "--gauge", "in place of a table");
  const std::string pair = cones;
  expect_rejected(pair + "--half-spacing 0.75 --gauge 1.435", "--gauge", "--half-spacing");
  expect_rejected(pair + "--half-spacing 0", "--half-spacing");
  expect_rejected(pair + "--half-spacing x", "--half-spacing", "a number");
  expect_rejected(pair + "--half-spacing 0.75", "--half-spacing: found 0.75 with the built-in rail 60E1",
                  "a rail file");
  expect_rejected(pair + "--amplitudes 1e-3:2e-3", "--amplitudes", "LO:HI:STEP");
  expect_rejected(pair + "--amplitudes 2e-3:1e-3:1e-4", "--amplitudes", "LO:HI:STEP");
  expect_rejected(pair + "--amplitudes 1e-3:2e-3:0", "--amplitudes", "LO:HI:STEP");
  expect_rejected(pair + "--sampling coarse", "--sampling", "refined or even");
  expect_rejected(pair + "--step 1", "step");
  expect_rejected(pair + "--smoothing -1", "--smoothing");
  expect_rejected(pair + "--smoothing 1e-5", "--smoothing: found 1e-5 with the built-in profiles", "no noise");
  expect_rejected(pair + "--runs 30", "--runs", "--random-error");
  expect_rejected(pair + "--random-error 1e-5 --runs 1", "--runs", "2..100000");
  expect_rejected(pair + "--random-error 1", "random error");
  expect_rejected(pair + "--grid 1e-5 --error-direction x", "--error-direction", "y or z or both");
  expect_rejected(pair + "-o none/curve.csv", "--output");
}

TEST_F(ConicityCommand, WrongReferences) {
  const std::string with = std::string(cones) + "--reference bands.txt ";
  expect_rejected(with, "bands.txt");
  write("bands.txt", "1.0 0.025 0.03 0.02 0.04 0.01\n2.0 0.025 0.03 0.02 0.04\n");
  expect_rejected(with, "bands.txt:2", "six numbers");
  write("bands.txt", "1.0 0.025 0.03 0.02 0.04 0.01\n");
  expect_rejected(with + "--amplitudes 1e-3:2e-3:1e-4", "--amplitudes", "--reference");
}

TEST_F(ConicityCommand, OutputsOfOthersStay) {
  write("notes.csv", "mine\n");
  expect_rejected(std::string(cones) + "-o notes.csv", "notes.csv");
  EXPECT_EQ(contents(folder_ / "notes.csv"), "mine\n");
}

TEST_F(ConicityCommand, CurveOverAmplitudesAsCsvAndJson) {
  const nlohmann::json found = json(std::string(cones) + "--amplitudes 1e-3:4e-3:1e-3 -o curve.csv");
  EXPECT_EQ(found["conicity_curve"]["amplitude"].size(), 4u);
  for (const auto& method : {"wave", "regression"}) {
    for (const double value : found["conicity_curve"][method]) EXPECT_NEAR(value, 0.025, 1e-6);
  }
  const std::string csv = contents(folder_ / "curve.csv");
  EXPECT_TRUE(csv.starts_with("amplitude,wave,regression,y_low,y_high,status\n0.001,0.02")) << csv;
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);
  ASSERT_EQ(tablegen(std::string(cones) + "--quiet -o curve.csv").exit_code, 0);  // replaces its own kind
}

// Unlike cones of 1:20 and 1:40 steer as two of their mean, about a shift of some millimetres.
TEST_F(ConicityCommand, UnlikeSides) {
  const nlohmann::json found = json(std::string(cones) + "--left-wheel cone-1:20 --amplitude 0.5e-3");
  EXPECT_NEAR(found["wave"]["conicity"], 0.0375, 1e-6);
  EXPECT_EQ(found["pair"]["left"]["wheel"], "cone-1:20");
  EXPECT_EQ(found["pair"]["right"]["wheel"], "cone-1:40");
  const nlohmann::json rails = json(std::string(cones) + "--left-rail CHN60 --amplitude 2e-3");
  EXPECT_NEAR(rails["wave"]["conicity"], 0.025, 1e-6);
  EXPECT_EQ(rails["pair"]["left"]["rail"], "CHN60");
  EXPECT_NE(rails["pair"]["left"]["rail_offset"], rails["pair"]["right"]["rail_offset"]);
}

TEST_F(ConicityCommand, UnlikeFilesOfOneNameAreTwo) {
  for (const char* folder : {"a", "b"}) {
    std::filesystem::create_directories(folder_ / folder);
    std::string wheel = "# units: mm\n";
    for (int y = -30; y <= 30; ++y) wheel += std::to_string(y) + " " + std::to_string(-0.025 * y) + "\n";
    write(std::string(folder) + "/wheel.txt", wheel);
  }
  const std::string arguments = "conicity --wheel a/wheel.txt --rail 60E1 --lateral -0.004:0.004 --amplitude 1e-3 ";
  const std::string unlike = tablegen(arguments + "--left-wheel b/wheel.txt").out;
  EXPECT_TRUE(unlike.starts_with("right a/wheel.txt on 60E1, left b/wheel.txt on 60E1: ")) << unlike;
  const std::string same = tablegen(arguments + "--left-wheel a/wheel.txt").out;
  EXPECT_TRUE(same.starts_with("wheel.txt on 60E1: ")) << same;
}

// A rail file with its origin 3 mm beside its top keeps it with --half-spacing, and loses it with a gauge.
TEST_F(ConicityCommand, HalfSpacingKeepsTheOriginOfARailFile) {
  std::string rail = "# units: mm\n";
  for (int i = -60; i <= 60; ++i) {
    const double angle = 0.025 * i;  // of an arc of 30 mm
    rail += std::to_string(30.0 * std::sin(angle) + 3.0) + " " + std::to_string(30.0 - 30.0 * std::cos(angle)) + "\n";
  }
  write("rail.txt", rail);
  const std::string arguments = "conicity --wheel cone-1:40 --rail rail.txt --lateral -0.004:0.004 --amplitude 2e-3 ";
  const nlohmann::json by_origin = json(arguments + "--half-spacing 0.750")["pair"]["right"];
  EXPECT_NEAR(by_origin["rail_offset"], 0.750, 1e-12);
  EXPECT_NEAR(by_origin["tape_circle_offset"], 0.750, 1e-12);
  // 14 mm below the top of the arc, 3 mm nearer to the field side than its origin.
  const double gauge_point = 3e-3 - std::sqrt(0.030 * 0.030 - 0.016 * 0.016);
  EXPECT_NEAR(by_origin["gauge"], 2.0 * (0.750 + gauge_point), 1e-6);
  const nlohmann::json by_gauge = json(arguments + "--gauge 1.435")["pair"]["right"];
  EXPECT_NEAR(by_gauge["rail_offset"], 0.5 * 1.435 - gauge_point + 3e-3, 1e-6);
}

// The exit status stays 0 outside the bands.
TEST_F(ConicityCommand, PositionsInTheBandsOfAReference) {
  write("bands.txt", "1.0 0.025 0.030 0.020 0.04 0.01\n2.0 0.020 0.024 0.016 0.03 0.01\n");
  const std::string arguments = std::string(cones) + "--reference bands.txt ";
  const nlohmann::json reference = json(arguments)["reference"];
  EXPECT_NEAR(reference["narrow_position"][0], 0.0, 1e-3);
  EXPECT_NEAR(reference["narrow_position"][1], 1.25, 1e-3);
  EXPECT_NEAR(reference["wide_position"][1], 0.5, 1e-3);
  EXPECT_EQ(reference["narrow"]["outside"], 1);
  EXPECT_EQ(reference["wide"]["outside"], 0);
  const Outcome text = tablegen(arguments);
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_NE(text.out.find("narrow band: 1 of 2 amplitudes outside, farthest position +1.25 at 2.0 mm"),
            std::string::npos)
      << text.out;
}

TEST_F(ConicityCommand, ErrorsAreReproducibleOnAnyNumberOfThreads) {
  const std::string arguments =
      "conicity --wheel S1002 --rail 60E1 --lateral -0.005:0.005 --random-error 5e-6 --smoothing 5e-6 --runs 3 "
      "--amplitudes 2e-3:3e-3:1e-3 ";
  const nlohmann::json found = json(arguments + "--seed 5 --threads 1 -o curve.csv");
  EXPECT_EQ(json(arguments + "--seed 5 --threads 2"), found);
  EXPECT_NE(json(arguments + "--seed 6")["errors"], found["errors"]);
  for (const char* bearer : {"wheels", "rails", "both"}) {
    const nlohmann::json& study = found["errors"][bearer];
    EXPECT_EQ(study["found"], nlohmann::json({3, 3})) << bearer;
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_GT(study["standard_deviation"][i], 0.0);
      EXPECT_LE(study["min"][i], study["mean"][i]);
      EXPECT_GE(study["max"][i], study["mean"][i]);
    }
  }
  EXPECT_NE(contents(folder_ / "curve.csv").find(",wheels_found,wheels_mean,wheels_standard_deviation,"),
            std::string::npos);
}

}  // namespace
}  // namespace railtab
