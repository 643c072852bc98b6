// vsi moving-load: what it prints and writes, and wrong input.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "vsi_fixture.hpp"

namespace railtab {
namespace {

using nlohmann::json;

const std::string span = "moving-load --length 25 --mass 15e3 --bending-stiffness 30e9 --damping 0.01 ";

class MovingLoadCommand : public VsiCommand {};

TEST_F(MovingLoadCommand, ListsItsTrains) {
  const Outcome listed = vsi("moving-load --json");
  ASSERT_EQ(listed.exit_code, 0) << listed.output;
  const json trains = json::parse(listed.output)["trains"];
  ASSERT_EQ(trains.size(), 25U);
  EXPECT_EQ(trains[0]["name"], "hslm-a1");
  EXPECT_EQ(trains[0]["axles"], 50);
  EXPECT_EQ(vsi("moving-load").exit_code, 0);
}

TEST_F(MovingLoadCommand, PeaksOfEverySpeedAsCsvAndOfTheGoverningTrainAsJson) {
  const Outcome outcome =
      vsi(span + "--train hslm-a1 --train 'en15528-d2*6' --train lm71 --speed 45:50:2.5 -o r.csv --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const json found = json::parse(outcome.output);
  const json& deck = found["decks"][0];
  EXPECT_EQ(found["passages"], 6);
  EXPECT_NEAR(deck["frequencies"][0].get<double>(), 3.554306, 1e-6);
  EXPECT_NEAR(deck["trains"][1]["static_displacement"]["value"].get<double>(), 11.2539e-3, 1e-5);
  EXPECT_FALSE(deck["trains"][2].contains("acceleration")) << "a static load model";
  double largest = 0.0;
  std::istringstream csv([&] {
    std::ifstream file(folder_ / "r.csv");
    return std::string(std::istreambuf_iterator<char>(file), {});
  }());
  std::string row;
  std::getline(csv, row);
  EXPECT_EQ(row,
            "deck,train,speed[m/s],speed[km/h],max_deck_acceleration[m/s2],acceleration_x[m],acceleration_time[s],"
            "max_deck_displacement[m],displacement_x[m],displacement_time[s],static_displacement[m],"
            "dynamic_amplification[-]");
  int rows = 0;
  for (; std::getline(csv, row); ++rows) {
    std::vector<std::string> cells;
    std::istringstream line(row + ",.");
    for (std::string cell; std::getline(line, cell, ',');) cells.push_back(cell);
    ASSERT_EQ(cells.size(), 13U) << row;
    if (!cells[4].empty()) largest = std::max(largest, std::stod(cells[4]));
  }
  EXPECT_EQ(rows, 7);
  EXPECT_NEAR(deck["acceleration"]["value"].get<double>(), largest, 1e-6 * largest);
}

TEST_F(MovingLoadCommand, SpansOfASceneThatAreAlikeOnce) {
  const std::string bridge = "[[bridge]]\nlength = 25\n", other = "[[bridge]]\nlength = 30\n";
  write("scene.toml", "[contact]\nmode = \"online\"\n[track]\nkind = \"flexible\"\n" + bridge + other + bridge);
  const Outcome outcome = vsi("moving-load scene.toml --train hslm-a3 --speed-kmh 180:200:10 --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const json decks = json::parse(outcome.output)["decks"];
  ASSERT_EQ(decks.size(), 2U);
  EXPECT_EQ(decks[0]["name"], "span 1 and 1 more like it");
  EXPECT_EQ(decks[1]["start"], 25.0);
  EXPECT_NEAR(decks[0]["acceleration"]["speed"].get<double>(), 53.0, 4.0) << "180 to 200 km/h";
}

TEST_F(MovingLoadCommand, AnOwnListOfAxles) {
  write("tram.csv", "x[m],P[kN]\n0,80\n1.8,80\n8,80\n9.8,80\n");
  EXPECT_EQ(vsi(span + "--train tram.csv --speed 20 --sleeper-spacing 0.6").exit_code, 0);
  write("tram.csv", "x[m],P[kN]\n0,80\n-1.8,80\n");
  expect_rejected(span + "--train tram.csv --speed 20", "tram.csv:3: x[m]: found -1.8 after 0");
}

// Tonnes and kN in place of kg and N.
TEST_F(MovingLoadCommand, ASpanOfWrongUnitsIsSaid) {
  expect_rejected("moving-load --length 25 --mass 15 --bending-stiffness 30e6 --damping 0.01 --speed 40:90",
                  "--mass: found 15, expected 100 to 1");
  const std::string stiffness = "moving-load --length 25 --mass 15e3 --bending-stiffness 30e6 --damping 0.01 ";
  const char* const warning =
      "vsi moving-load: warning: a span of 25 m has its first natural frequency at 0.112 Hz, as a simply supported "
      "beam; spans of that length have 3.51 to 8.53 Hz [EN 1991-2, Figure 6.10]: are --mass (in kg/m) and "
      "--bending-stiffness (in N m²) meant so?\n";
  EXPECT_TRUE(vsi(stiffness + "--train lm71").output.starts_with(warning)) << vsi(stiffness + "--train lm71").output;
  EXPECT_EQ(vsi(stiffness + "--train lm71 -q").output, "");
  EXPECT_EQ(vsi(span + "--train lm71").output.find("warning"), std::string::npos);
  write("scene.toml",
        "[contact]\nmode = \"online\"\n[track]\nkind = \"flexible\"\n[[bridge]]\nlength = 25\nmass = 1e7\n");
  EXPECT_NE(vsi("moving-load scene.toml --train lm71").output.find("are bridge.mass (per metre) and E Iy meant so?"),
            std::string::npos);
}

// The acceleration grows up to the end of the speeds, the first and the last one.
TEST_F(MovingLoadCommand, LargestValuesAtAnEndOfTheSpeedsAreMarked) {
  const auto found = [&](const std::string& speeds) {
    const Outcome outcome = vsi(span + "--train hslm-a1 --speed " + speeds + " --json");
    return json::parse(outcome.output)["decks"][0];
  };
  const json whole = found("40:80:1"), peak = whole["trains"][0]["acceleration"];
  EXPECT_FALSE(peak["at_end_of_speeds"].get<bool>()) << peak;
  const double speed = peak["speed"].get<double>();
  const json part = found("40:" + std::to_string(speed) + ":1");
  EXPECT_TRUE(part["trains"][0]["acceleration"]["at_end_of_speeds"].get<bool>()) << part["trains"][0]["acceleration"];
  EXPECT_TRUE(part["acceleration"]["at_end_of_speeds"].get<bool>());
  EXPECT_FALSE(found("40")["acceleration"]["at_end_of_speeds"].get<bool>()) << "one speed has no ends";
  const std::string text = vsi(span + "--train hslm-a1 --speed 40:" + std::to_string(speed) + ":1").output;
  EXPECT_NE(text.find("  *: at an end of the speeds; a wider range may have a larger value\n"), std::string::npos)
      << text;
}

TEST_F(MovingLoadCommand, WrongInput) {
  expect_rejected(span, "found no speeds");
  expect_rejected(span + "--speed 90:40", "--speed");
  expect_rejected(span + "--speed 40:900", "1 to 200 m/s");
  expect_rejected(span + "--speed 40:40", "LO below HI");
  expect_rejected(span + "--speed 40:90 --speed-kmh 100:200", "one of them");
  expect_rejected(span + "--speed 40:90 --train tgv", "hslm-a10");
  expect_rejected(span + "--speed 40:90 --sleeper-spacing 60", "--sleeper-spacing: found 60");
  expect_rejected(span + "--speed 40:90 -o none/r.csv", "-o");
  expect_rejected("moving-load --length 25 --speed 40:90", "found no --mass");
  expect_rejected("moving-load --train hslm-a1 --speed 40:90", "a scene, or --length");
  expect_rejected("moving-load --length 25 --mass 15e3 --bending-stiffness 30e9 --damping 1 --speed 40:90",
                  "--damping: found 1");
  expect_rejected("moving-load --length 25 --mass 15e3 --bending-stiffness 1e-300 --damping 0.01 --speed 40:90",
                  "--bending-stiffness");
  expect_rejected("moving-load --length 25 --mass 1e300 --bending-stiffness 30e9 --damping 0.01 --speed 40:90",
                  "--mass");
  expect_rejected("moving-load --length 25 --mass 100 --bending-stiffness 100 --damping 0.01 --speed 40:90",
                  "a first natural frequency of 0.002513 Hz");
  expect_rejected(span + "--speed 1:2 --modes 100", "fewer --modes");
  write("scene.toml", rigid_scene);
  expect_rejected("moving-load scene.toml --speed 40:90", "no bridge");
  expect_rejected("moving-load scene.toml --length 20 --speed 40:90", "--length: found a scene too");
  write("own.csv", "mine\n");
  expect_rejected(span + "--speed 40 -o own.csv", "own.csv");
}

}  // namespace
}  // namespace railtab
