// vsi assess: verdicts, exit codes, files, runs that are kept.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "vsi_fixture.hpp"

namespace railtab {
namespace {

using nlohmann::json;

/// The span of docs/examples/hslm_beam.toml: resonance of HSLM-A at 200 km/h · 1.2 exceeds 3.5 m/s².
const std::string light_span = "[[bridge]]\nlength = 25.0\nmass = 15e3\nE = 30e9\nIy = 1.0\n";
const std::string stiff_span = "[[bridge]]\nlength = 25.0\nmass = 25e3\nE = 30e9\nIy = 12.0\n";
/// Wheels that follow the rails: a run takes a moment.
const std::string vertical =
    "[train]\nspeed_kmh = 160\n[contact]\nnormal = \"rigid\"\n[integration]\ntime_step = 1e-3\n[track]\nlength_before "
    "= "
    "30\nlength_after = 30\n";

class AssessCommand : public VsiCommand {
 protected:
  [[nodiscard]] static json object(const Outcome& outcome) {
    return json::parse(outcome.output.substr(outcome.output.find('{')));
  }
  [[nodiscard]] static json verdict(const json& assessment, const std::string& id, const std::string& stage = "") {
    for (const json& v : assessment["verdicts"]) {
      if (v["id"] == id && (stage.empty() || v.value("stage", "") == stage)) return v;
    }
    return {};
  }
  [[nodiscard]] std::string text_of(const std::string& name) const {
    std::ifstream file(folder_ / name);
    return {std::istreambuf_iterator<char>(file), {}};
  }
};

TEST_F(AssessCommand, ABridgeThatFailsUnderMovingLoads) {
  write("scene.toml", vertical + "[assessment]\nline_speed_kmh = 250\n" + light_span);
  const std::string stages = "assess scene.toml --stage check --stage moving-load -o out ";
  const Outcome plain = vsi(stages);
  EXPECT_EQ(plain.exit_code, 0) << "without --fail-on\n" << plain.output;
  EXPECT_NE(plain.output.find("FAILS: 1 limit fails, worst with hslm-a"), std::string::npos) << plain.output;
  EXPECT_EQ(vsi(stages + "--fail-on any").exit_code, 3);
  EXPECT_EQ(vsi(stages + "--fail-on verified").exit_code, 3) << "the limit is verified";
  const Outcome asked = vsi(stages + "--json");
  const json found = object(asked);
  EXPECT_EQ(found, json::parse(text_of("out/assessment.json")));
  const json deck = verdict(found, "en1990.deck-acceleration.ballasted");
  EXPECT_EQ(deck["outcome"], "fail");
  EXPECT_EQ(deck["limit"], 3.5);
  EXPECT_GT(deck["value"].get<double>(), 3.5);
  EXPECT_EQ(deck["at"]["train"].get<std::string>().substr(0, 6), "hslm-a");
  EXPECT_NEAR(found["moving_load_speeds"][1].get<double>(), 1.2 * 250.0 / 3.6, 1e-9);
  EXPECT_EQ(found["stages"]["contact"]["done"], false);
  EXPECT_EQ(found["stages"]["contact"]["skipped"], "not asked for (--stage)");
  EXPECT_EQ(verdict(found, "en14363.unloading")["reason"], "needs stage contact");
  EXPECT_EQ(found["decks"][0]["dynamic_analysis"]["need"], "required") << "above 200 km/h";
  EXPECT_EQ(found["decks"][0]["trains"].size(), 11U) << "HSLM-A and the scene's train";
  EXPECT_EQ(text_of("out/assessment.html").find("<!DOCTYPE html>"), 0U);
  EXPECT_EQ(found["summary"]["fail"], 1);
}

/// Bands over speed hold the speeds at which the acceleration exceeds the limit, and no others.
TEST_F(AssessCommand, TellsTheBandsOfSpeed) {
  write("scene.toml", vertical + "[assessment]\nline_speed_kmh = 200\n" + light_span);
  const json found = object(vsi("assess scene.toml --stage moving-load -o out --json"));
  const json deck = verdict(found, "en1990.deck-acceleration.ballasted");
  const json over = deck["over_speed"];
  ASSERT_GE(over["bands"].size(), 2U) << "apart from each other: " << over;
  const double line = 200.0 / 3.6, limit = deck["limit"];
  double to_line = 0.0;
  int exceeding = 0;
  bool at_the_line = false;
  for (const json& train : found["decks"][0]["trains"]) {
    for (const json& passage : train["passages"]) {
      const double speed = passage["speed"], acceleration = passage["acceleration"];
      at_the_line = at_the_line || std::abs(speed - line) < 1e-9;
      if (speed < line + 1e-9) to_line = std::max(to_line, acceleration);
      if (!(acceleration > limit)) continue;
      ++exceeding;
      EXPECT_TRUE(std::any_of(over["bands"].begin(), over["bands"].end(),
                              [&](const json& band) {
                                const json& trains = band["trains"];
                                return speed >= band["from"] && speed <= band["to"] &&
                                       std::find(trains.begin(), trains.end(), train["train"]) != trains.end();
                              }))
          << speed << " m/s";
    }
  }
  EXPECT_GT(exceeding, 20);
  EXPECT_TRUE(at_the_line) << "the line's speed is one of those computed";
  EXPECT_EQ(over["to_line_speed"]["value"], to_line);
  EXPECT_LT(to_line, deck["value"].get<double>());
  for (std::size_t i = 0; i + 1 < over["bands"].size(); ++i) {
    const double from = over["bands"][i]["to"], to = over["bands"][i + 1]["from"];
    ASSERT_LT(from, to);
    for (const json& train : found["decks"][0]["trains"]) {
      for (const json& passage : train["passages"]) {
        const double speed = passage["speed"];
        if (speed <= from || speed >= to) continue;
        EXPECT_LE(passage["acceleration"].get<double>(), limit) << speed << " m/s";
      }
    }
  }
  EXPECT_LT(over["widest_step"].get<double>(), 2.0 / 3.6 + 1e-9);
  const std::string page = text_of("out/assessment.html");
  EXPECT_NE(page.find("; ends of bands interpolated"), std::string::npos);
}

/// A deck that heaves on springs has free ends, a simple span has none: the note says so, on the page too.
TEST_F(AssessCommand, TellsOfAFreeEndOfADeck) {
  std::string shapes = "node,mode,uz\n", nodes;
  for (int n = 0; n <= 8; ++n) {
    const double x = 2.5 * n;
    shapes += std::to_string(n + 1) + ",1,1\n" + std::to_string(n + 1) + ",2," +
              std::to_string(std::sin(std::numbers::pi * x / 20)) + "\n";
    nodes += std::to_string(n + 1) + " " + std::to_string(x) + " 0 1.9\n";
  }
  write("shapes.csv", shapes);
  write("nodes.csv", nodes);
  write("modes.csv", "mode,frequency,mass,damping\n1,5,3e5,0.01\n2,12,2e5,0.01\n");
  write("free.toml", vertical +
                         "[assessment]\nline_speed_kmh = 160\n[structure]\nformat = \"modes\"\n"
                         "mode_table = \"modes.csv\"\nmode_shapes = \"shapes.csv\"\nnodes = \"nodes.csv\"\n"
                         "axes = \"x y z\"\ndeck.from = [0, 0, 1.9]\ndeck.to = [20, 0, 1.9]\n");
  const std::string stage = " --stage moving-load --train hslm-a1 -o out --json";
  const json free = object(vsi("assess free.toml" + stage));
  const std::string note = "An end of deck " + free["decks"][0]["name"].get<std::string>() +
                           " is free to move: an axle load that comes on accelerates it at once, while rails, sleepers "
                           "and ballast would spread the load. A largest acceleration counts as overestimated, and "
                           "fails no limit, where one such load gives more than a tenth of it at its place. Resonance "
                           "that many such loads excite is not recognised and can fail a limit; runs with contact "
                           "have the track.";
  const auto told = [&](const json& assessment) {
    const json& notes = assessment["stages"]["moving-load"]["notes"];
    return std::find(notes.begin(), notes.end(), note) != notes.end();
  };
  EXPECT_TRUE(told(free)) << free["stages"]["moving-load"]["notes"];
  EXPECT_EQ(verdict(free, "en1990.deck-acceleration.ballasted")["outcome"], "fail") << "by resonance";
  EXPECT_NE(text_of("out/assessment.html").find(note), std::string::npos);
  write("modes.csv", "mode,frequency,mass,damping\n1,5,4e4,0.5\n2,12,4e4,0.5\n");
  const json heaves = object(vsi("assess free.toml" + stage));
  const json acceleration = verdict(heaves, "en1990.deck-acceleration.ballasted");
  EXPECT_GT(acceleration["value"], acceleration["limit"]) << "170 kN that come on to 40 t at once";
  EXPECT_EQ(acceleration["outcome"], "not judged") << acceleration;
  EXPECT_NE(acceleration.value("reason", "").find("comes on to the free end"), std::string::npos);
  write("simple.toml", vertical + light_span);
  EXPECT_EQ(object(vsi("assess simple.toml" + stage))["stages"].dump().find("is free to move"), std::string::npos);
}

// HSLM-A is not the load model of a short span: it can fail, and does not pass.
TEST_F(AssessCommand, AShortSpanAsksForHslmB) {
  write("scene.toml", vertical + "[[bridge]]\nlength = 6.0\nmass = 25e3\nE = 30e9\nIy = 0.5\n");
  write("hslm-b.csv", "x[m],P[kN]\n0,170\n3.5,170\n7,170\n");
  const std::string stage = "assess scene.toml --stage moving-load -o out --json";
  const std::string note = "requires HSLM-B in place of HSLM-A for simply supported spans below 7 m, as span 1 of 6 m";
  const json by_hslm_a = object(vsi(stage));
  EXPECT_NE(by_hslm_a["stages"]["moving-load"]["notes"].dump().find(note), std::string::npos);
  const json deck = verdict(by_hslm_a, "en1990.deck-acceleration.ballasted");
  EXPECT_LT(deck["value"].get<double>(), 3.5);
  EXPECT_EQ(deck["outcome"], "not judged");
  EXPECT_NE(deck["reason"].get<std::string>().find(note), std::string::npos) << deck;
  const json by_another = object(vsi(stage + " --train hslm-b.csv"));
  EXPECT_EQ(verdict(by_another, "en1990.deck-acceleration.ballasted")["outcome"], "pass");
  EXPECT_EQ(by_another["stages"].dump().find("HSLM-B"), std::string::npos);
}

// What needs no low-pass is judged where steps are too long for that of the deck's acceleration.
TEST_F(AssessCommand, LongStepsLeaveTheDeckItsOtherMeasures) {
  const std::string keys =
      "[train]\nspeed_kmh = 160\n[contact]\nnormal = \"rigid\"\n[integration]\ntime_step = 0.01\n[track]\n"
      "length_before = 30\nlength_after = 30\n[output]\ndeck_envelope = true\ndeck_cut_off = 20\n";
  write("scene.toml", keys + stiff_span);
  const json found = object(vsi("assess scene.toml --stage contact --speed-kmh 160 -o out --json"));
  const std::string notes = found["stages"]["contact"]["notes"].dump();
  EXPECT_NE(notes.find("Decks are judged at all their nodes and every step (output.deck_envelope), but not by their "
                       "accelerations: the low-pass at"),
            std::string::npos)
      << notes;
  const json& measures = found["runs"][0]["measures"];
  for (const char* measure : {"deck_displacement", "deck_end_rotation", "deck_joint_gap"}) {
    EXPECT_TRUE(measures.contains(measure)) << measure << measures;
  }
  EXPECT_FALSE(measures.contains("deck_acceleration"));
  const json deck = verdict(found, "en1990.deck-acceleration.ballasted");
  EXPECT_EQ(deck["outcome"], "not judged");
  EXPECT_NE(deck["reason"].get<std::string>().find("takes integration.time_step of at most"), std::string::npos)
      << deck;
}

// Notes say which friction the limits of the flange take, and what lateral accelerations are in a curve.
TEST_F(AssessCommand, FrictionAlongTheTrackAndACurve) {
  write("friction.csv", "x[m],left[1],right[1]\n-100,0.2,0.2\n50,0.45,0.3\n");
  write("scene.toml",
        "[train]\nspeed_kmh = 160\nlateral_acceleration = 0.5\n[contact]\nmode = \"online\"\nfriction_file = "
        "\"friction.csv\"\n[integration]\ntime_step = 1e-3\n[track]\nlength_before = 30\nlength_after = 30\n" +
            stiff_span);
  const json found = object(vsi("assess scene.toml --stage contact --speed-kmh 160 -o out --json"));
  const std::string notes = found["stages"]["contact"]["notes"].dump();
  EXPECT_NE(
      notes.find("The limits of Nadal and Weinstock take the largest coefficient of contact.friction_file, 0.45."),
      std::string::npos)
      << notes;
  EXPECT_NE(notes.find("that cant leaves (train.lateral_acceleration, train.cant) is not in them."), std::string::npos);
  const double tangent = std::tan(70.0 * std::numbers::pi / 180.0);  // S1002
  EXPECT_NEAR(verdict(found, "nadal")["limit"].get<double>(), (tangent - 0.45) / (1.0 + 0.45 * tangent), 0.03);
}

/// The value of the verdict is that of vsi moving-load.
TEST_F(AssessCommand, AgreesWithMovingLoad) {
  write("scene.toml", vertical + light_span);
  const json found = object(vsi("assess scene.toml --stage moving-load -o out --json"));
  const json deck = verdict(found, "en1990.deck-acceleration.ballasted");
  const double speed = deck["at"]["speed"].get<double>();
  const json direct = object(vsi("moving-load scene.toml --speed " + std::to_string(speed) + " --train " +
                                 deck["at"]["train"].get<std::string>() + " --json"));
  EXPECT_NEAR(direct["decks"][0]["acceleration"]["value"].get<double>(), deck["value"].get<double>(),
              1e-4 * deck["value"].get<double>());
  EXPECT_LE(speed, 1.2 * 160.0 / 3.6 * (1.0 + 1e-9)) << "1.2 times the train's speed";
}

TEST_F(AssessCommand, ABridgeThatPassesAllStages) {
  write("scene.toml", vertical + stiff_span);
  const Outcome outcome = vsi("assess scene.toml --fail-on any -o out --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const json found = object(outcome);
  EXPECT_EQ(found["summary"]["fail"], 0);
  EXPECT_EQ(verdict(found, "en1990.deck-acceleration.ballasted", "moving-load")["outcome"], "pass");
  EXPECT_EQ(verdict(found, "en1990.deck-acceleration.ballasted", "contact")["outcome"], "pass");
  EXPECT_EQ(verdict(found, "en14363.unloading")["outcome"], "pass");
  EXPECT_NE(verdict(found, "en14363.derailment")["reason"].get<std::string>().find("no lateral forces"),
            std::string::npos);
  ASSERT_GE(found["runs"].size(), 1U);
  EXPECT_EQ(found["runs"][0]["complete"], true);
  EXPECT_TRUE(std::filesystem::exists(folder_ / found["runs"][0]["results"].get<std::string>()));
  const std::string rows = text_of("out/runs.csv");
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 1 + static_cast<long>(found["runs"].size()));
  EXPECT_EQ(rows.find("run,train,speed[m/s],speed[km/h],seed,complete,deck_acceleration[m/s2],"), 0U);
  EXPECT_EQ(text_of("out/moving_load.csv").find("deck,train,speed[m/s]"), 0U);
}

// The deck's acceleration is 3.0 m/s² while the coach is on it, and 3.95 m/s² after it has left.
TEST_F(AssessCommand, FollowsTheFreeVibrationOfADeck) {
  write("scene.toml",
        "[train]\nspeed_kmh = 250\n[contact]\nnormal = \"rigid\"\n[[bridge]]\nlength = 12.0\nmass = 9e3\nE = 30e9\n"
        "Iy = 0.12\nA = 4.0\ndamping_ratio = 0.01\n");
  const json found = object(vsi("assess scene.toml --stage contact --speed-kmh 250 -o out --json"));
  const json limit = verdict(found, "en1990.deck-acceleration.ballasted", "contact");
  EXPECT_EQ(limit["outcome"], "fail") << limit;
  EXPECT_NEAR(limit["value"].get<double>(), 3.95, 0.05);
}

TEST_F(AssessCommand, FinishedRunsAreKeptAndOthersMadeAgain) {
  write("scene.toml", vertical + stiff_span);
  const std::string command = "assess scene.toml --stage contact --speed-kmh 140:160:20 -o out --json";
  const json first = object(vsi(command));
  ASSERT_EQ(first["runs"].size(), 2U);
  const std::filesystem::path run = folder_ / first["runs"][0]["results"].get<std::string>(),
                              other = folder_ / first["runs"][1]["results"].get<std::string>();
  const auto written = std::filesystem::last_write_time(run);
  std::filesystem::remove(other);
  json second = object(vsi(command)), before = first;
  EXPECT_EQ(std::filesystem::last_write_time(run), written);
  EXPECT_TRUE(std::filesystem::exists(other));
  second.erase("stages");
  before.erase("stages");
  EXPECT_EQ(second, before) << "the same numbers";
  write("scene.toml", vertical + light_span);
  const json changed = object(vsi(command));
  EXPECT_NE(changed["measures"], first["measures"]) << "results of another scene are not taken for this one's";
}

TEST_F(AssessCommand, GoesOnAfterAKill) {
  write("scene.toml", vertical + stiff_span);
  const std::string command = "assess scene.toml --stage contact --speed-kmh 100:160:15 --threads 1 ";
  json whole = object(vsi(command + "-o whole --json"));
  for (const char* seconds : {"0.3", "0.6", "0.9"}) {
    static_cast<void>(
        run(std::string("timeout -s KILL ") + seconds + " '" VSI_COMMAND "' " + command + "-o killed -q"));
  }
  const Outcome last = vsi(command + "-o killed --json");
  ASSERT_EQ(last.exit_code, 0) << last.output;
  json resumed = object(last);
  EXPECT_EQ(resumed["runs"].size(), 5U);
  EXPECT_EQ(resumed["measures"], whole["measures"]) << "to the last bit";
  EXPECT_EQ(resumed["verdicts"], whole["verdicts"]);
}

TEST_F(AssessCommand, RandomTracksOfSeveralSeedsRiseFromZero) {
  write("scene.toml", vertical + stiff_span +
                          "[irregularity]\nspectrum = \"german-low\"\nlongest_wave = 25\n[assessment]\nseeds = 2\n");
  const json found = object(vsi("assess scene.toml --stage contact --speed-kmh 160 -o out --json"));
  ASSERT_EQ(found["runs"].size(), 2U);
  EXPECT_EQ(found["runs"][1]["seed"], 2);
  EXPECT_NE(found["runs"][0]["measures"]["wheel_unloading"], found["runs"][1]["measures"]["wheel_unloading"]);
  const json notes = found["stages"]["contact"]["notes"];
  EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [](const json& note) {
    return note.get<std::string>().find("rises from zero over 25 m") != std::string::npos;
  })) << notes;
  for (const json& v : found["measures"]) {
    if (v["measure"] != "wheel_unloading") continue;
    EXPECT_GT(v["time"].get<double>(), 0.1) << "not in the first steps";
  }
  EXPECT_EQ(object(vsi("assess scene.toml --stage contact --seeds 1 --speed-kmh 160 -o out --json"))["runs"].size(),
            1U);
}

TEST_F(AssessCommand, ClausesOfAUser) {
  write("scene.toml", vertical + stiff_span);
  write("own.toml",
        "edition = \"client\"\n[[clause]]\nid = \"client.deck\"\nclause = \"3\"\ntitle = \"rotation\"\nmeasure = "
        "\"deck_end_rotation\"\nunit = \"rad\"\nlimit = 1e-9\n");
  const std::string command = "assess scene.toml --stage moving-load --clauses own.toml -o out ";
  EXPECT_EQ(vsi(command + "--fail-on any").exit_code, 3);
  EXPECT_EQ(vsi(command + "--fail-on verified").exit_code, 0) << "the client's limit has no source";
  EXPECT_EQ(verdict(object(vsi(command + "--json")), "client.deck")["edition"], "client");
}

// Rules, the end of what is judged and sections are keys of the scene.
TEST_F(AssessCommand, RulesAndWhatIsJudged) {
  write("scene.toml", vertical + stiff_span +
                          "[assessment]\nrules = [\"China\"]\nend = 60\nsection_length = 30\nsection_step = 0.25\n");
  const json found = object(vsi("assess scene.toml --stage contact --speed-kmh 160 -o chosen --json"));
  EXPECT_EQ(verdict(found, "china.unloading")["outcome"], "pass");
  EXPECT_EQ(verdict(found, "en14363.unloading")["outcome"], "does not apply");
  EXPECT_NE(found["stages"]["contact"]["notes"].dump().find(
                "judged from x = 0 m to 60 m; percentiles of Q, Y, Y/Q and ΣY of sections of 30 m, at every 0.25 m"),
            std::string::npos)
      << found["stages"]["contact"]["notes"];
  double percentile = 0.0, largest = 0.0;
  for (const json& value : found["measures"]) {
    if (value["measure"] == "wheel_force_percentile") percentile = value["value"];
    if (value["measure"] == "wheel_force") largest = value["value"];
  }
  EXPECT_LE(percentile, largest);
  EXPECT_GT(percentile, 0.99 * largest);
  write("wrong.toml", vertical + stiff_span + "[assessment]\nbegin = 20\nend = 10\n");
  expect_rejected("assess wrong.toml -o no",
                  "assessment.end: found 10 m, and judging begins at 20 m, expected more than");
}

// Named trains, of axle loads or of vehicles; of the latter those that govern as moving loads run with contact.
TEST_F(AssessCommand, TrainsOfTheUser) {
  write("two.csv", "x[m],P[kN]\n0,100\n3,100\n");
  write("scene.toml", vertical + stiff_span +
                          "[assessment]\ntrains = [\"two.csv\", \"metro-gz18\", "
                          "\"traxx-locomotive*2\"]\n");
  const json found =
      object(vsi("assess scene.toml --stage moving-load --stage contact --speed-kmh 160 -o named --json"));
  std::vector<std::string> trains;
  for (const json& train : found["decks"][0]["trains"]) trains.push_back(train["train"]);
  EXPECT_EQ(trains, (std::vector<std::string>{"two.csv", "metro-gz18", "traxx-locomotive*2",
                                              "the scene's train (manchester-coach)"}));
  ASSERT_EQ(found["runs"].size(), 1U) << "the heavy locomotive governs acceleration, displacement and rotation";
  EXPECT_EQ(found["runs"][0]["train"], "traxx-locomotive*2");
  EXPECT_EQ(found["runs"][0]["run"], "traxx-locomotive-2-v044.444");
  EXPECT_EQ(found["runs"][0]["complete"], true) << found["runs"][0];
  const std::string notes = found["stages"]["contact"]["notes"].dump();
  EXPECT_NE(notes.find("No runs of metro-gz18, the scene's train (manchester-coach): as moving loads"),
            std::string::npos)
      << notes;
  // another list by the command line
  const json asked =
      object(vsi("assess scene.toml --train hslm-a3 --train en15528-d2*4 --stage moving-load -o named "
                 "--json"));
  EXPECT_EQ(asked["decks"][0]["trains"].size(), 3U);
  EXPECT_EQ(asked["decks"][0]["trains"][1]["train"], "en15528-d2*4");
  EXPECT_NE(asked["stages"]["moving-load"]["notes"].dump().find(
                "hslm-a3, en15528-d2*4 and the scene's train (manchester-coach),"),
            std::string::npos);
  // vehicles of files, relative to the scene, and mixed trains
  std::filesystem::create_directory(folder_ / "below");
  write("below/coach.toml", vsi("vehicle manchester-coach --toml").output);
  write("below/scene.toml", vertical + stiff_span +
                                "[assessment]\ntrains = [\"coach.toml*2\", \"manchester-coach*2\", "
                                "\"coach.toml+manchester-coach\", \"ice3-like-coach+manchester-coach\"]\n");
  const json mixed = object(vsi("assess below/scene.toml --stage moving-load -o mixed --json"))["decks"][0]["trains"];
  ASSERT_EQ(mixed.size(), 5U);
  EXPECT_EQ(mixed[0]["passages"], mixed[1]["passages"]);
  const auto first = [&](std::size_t train) { return mixed[train]["passages"][0]["acceleration"].get<double>(); };
  EXPECT_NEAR(first(2), first(0), 1e-9 * first(0)) << "the same axles by another way";
  EXPECT_GT(std::abs(first(3) - first(0)), 0.01 * first(0));
  expect_rejected("assess scene.toml --train nobody -o out",
                  "--train, assessment.trains: found 'nobody', expected a vehicle (vsi vehicle lists them) or "
                  "VEHICLE.toml, several as VEHICLE*N+VEHICLE; axle loads AXLES.csv; hslm-a for all ten;");
  expect_rejected("assess scene.toml --train 'hslm-a*3' -o out", "found 'hslm-a*3', expected a vehicle");
  expect_rejected("assess scene.toml --train lm71 -o out",
                  "found 'lm71', a load model at rest, expected trains that move");
  write("unknown.toml", vertical + stiff_span + "[assessment]\ntrains = [\"nobody\"]\n");
  expect_rejected("check unknown.toml", "--train, assessment.trains: found 'nobody', expected a vehicle");
  write("spatial.toml", "[contact]\nmode = \"online\"\n" + stiff_span);
  expect_rejected("assess spatial.toml --train velaro-e-coach -o out",
                  "--train, assessment.trains: 'velaro-e-coach': train.vehicle: found velaro-e-coach, whose data are "
                  "vertical only");
}

// Spans that differ in their lateral stiffness alone are judged one by one.
TEST_F(AssessCommand, ASoftSpanBesideAStiffOneIsJudged) {
  const auto span = [](double Iz) { return stiff_span + "Iz = " + std::to_string(Iz) + "\n"; };
  write("scene.toml", vertical + span(60.0) + span(0.5));
  const json decks = object(vsi("assess scene.toml --stage check -o out --json"))["decks"];
  ASSERT_EQ(decks.size(), 2U);
  write("alike.toml", vertical + span(60.0) + span(60.0));
  EXPECT_EQ(object(vsi("assess alike.toml --stage check -o alike --json"))["decks"].size(), 1U);
}

// Shards make the runs, and the command without one the verdict of all, the same as in one go.
TEST_F(AssessCommand, ShardsShareTheRuns) {
  write("scene.toml", vertical + stiff_span);
  const std::string command = "assess scene.toml --stage contact --speed-kmh 120:160:20 ";
  const json whole = object(vsi(command + "-o whole --json"));
  for (const char* shard : {"1/2", "2/2"}) {
    const Outcome outcome = vsi(command + "-o parts --shard " + shard);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
    EXPECT_NE(outcome.output.find(std::string(shard) == "1/2" ? "shard 1 of 2: 2 of its runs finished"
                                                              : "shard 2 of 2: 1 of its runs finished"),
              std::string::npos)
        << outcome.output;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "parts/assessment.json"));
  }
  EXPECT_EQ(object(vsi(command + "-o parts --shard 2/2 --json")), (json{{"finished", 1}, {"ended_early", 0}}));
  const std::filesystem::path run = folder_ / "parts/runs/v044.444.h5";
  const auto written = std::filesystem::last_write_time(run);
  const json joined = object(vsi(command + "-o parts --json"));
  EXPECT_EQ(std::filesystem::last_write_time(run), written);
  EXPECT_EQ(joined["measures"], whole["measures"]);
  EXPECT_EQ(joined["verdicts"], whole["verdicts"]);
}

TEST_F(AssessCommand, RejectsOptionsForOtherStages) {
  write("scene.toml", vertical + stiff_span);
  const std::string without_runs = ": found stages without runs, expected stage contact";
  expect_rejected("assess scene.toml --stage check --shard 1/2 -o out", "--shard" + without_runs);
  expect_rejected("assess scene.toml --stage moving-load --speed-kmh 120:160:20 -o out", "--speed-kmh" + without_runs);
  expect_rejected("assess scene.toml --stage moving-load --stage check --seeds 2 -o out", "--seeds" + without_runs);
  expect_rejected("assess scene.toml --stage check --train hslm-a1 -o out", "--train: found stage check");
  write("scene.toml", vertical + stiff_span + "[assessment]\ntrains = [\"nosuch\"]\n");
  expect_rejected("assess scene.toml --stage check -o out", "found 'nosuch'");
}

// What vsi run would warn of stands on the terminal, on the page and in the file, also where the runs are there
// already.
TEST_F(AssessCommand, WarningsOfItsRuns) {
  write("scene.toml", vertical + stiff_span + "[[load]]\nFz = 1.0\nstart = 500\ngust_duration = 4\n");
  const std::string command = "assess scene.toml --stage contact --speed-kmh 140:160:20 -o out ";
  for (const char* made : {"now", "before"}) {
    const Outcome outcome = vsi(command + "--json");
    const std::string begin = "[[load]] 1 of 1 is specified for t = 500 to 504 s";
    EXPECT_NE(outcome.output.find("vsi assess: warning: " + begin), std::string::npos) << made << outcome.output;
    const json warnings = object(outcome)["warnings"];
    ASSERT_EQ(warnings.size(), 1U) << warnings;
    const std::string warning = warnings[0];
    EXPECT_TRUE(warning.starts_with(begin)) << warning;
    EXPECT_TRUE(warning.ends_with("(run v038.889, and alike in 1 more)")) << warning;
    EXPECT_NE(text_of("out/assessment.html").find("<h2>Warnings of the runs</h2><ul><li>" + begin), std::string::npos);
  }
  EXPECT_EQ(vsi(command + "--quiet").output, "");
}

TEST_F(AssessCommand, WrongInput) {
  write("scene.toml", vertical + light_span);
  write("no_bridge.toml", vertical);
  expect_rejected("assess", "found no SCENE.toml\nusage: vsi assess SCENE.toml");
  expect_rejected("assess no_bridge.toml -o out", "no bridge");
  expect_rejected("assess scene.toml --stage all -o out", "--stage: found all, expected check, moving-load or contact");
  expect_rejected("assess scene.toml --fail-on all -o out", "--fail-on: found all, expected any or verified");
  expect_rejected("assess scene.toml --clauses no.toml -o out", "no.toml");
  expect_rejected("assess scene.toml -o no/out", "no folder");
  write("typed.toml", vertical + light_span + "[assessment]\nline_speed = 200\n");
  expect_rejected("assess typed.toml -o out", "unknown key 'assessment.line_speed'; did you mean");
  write("rules.toml", vertical + light_span + "[assessment]\nrules = [\"europe\"]\n");
  expect_rejected("assess rules.toml -o out",
                  "assessment.rules: found \"europe\", expected names of China, Europe, Japan");
  expect_rejected("assess scene.toml --speed-kmh 100:2000:500 --stage contact -o out",
                  "--speed-kmh: found 1100, expected 0.0036 to 720 km/h");
  expect_rejected("assess scene.toml -o ''", "-o: found an empty name, expected the name of a folder");
  expect_rejected("assess scene.toml --seeds 3 --stage contact -o out2", "irregularity.spectrum");
}

}  // namespace
}  // namespace railtab
