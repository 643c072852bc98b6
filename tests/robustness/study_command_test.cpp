// Studies of many runs by a plan: the same tables from any number of workers, shards and kills, and clear messages.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "railtab/runtime/reliability/proportion.hpp"
#include "railtab/runtime/results/result_file.hpp"
#include "railtab/tables/files/array_file.hpp"
#include "vsi_fixture.hpp"

namespace railtab {
namespace {

constexpr const char* scene =
    "[train]\nspeed_kmh = 100\n[contact]\nmode = \"online\"\n[track]\nkind = \"rigid\"\n"
    "[irregularity]\nspectrum = \"german-low\"\nfade_in = 0\n[integration]\nduration = 0.25\n";

constexpr const char* speeds = "scene = \"scene.toml\"\n[[vary]]\nkey = \"train.speed_kmh\"\nrange = \"100:200:50\"\n";
constexpr const char* friction =
    "[[vary]]\nkey = \"contact.friction\"\ndistribution = \"lognormal\"\nmean = 0.3\ncov = 0.2\n";
constexpr const char* seeds =
    "[[vary]]\nkey = \"irregularity.seed\"\ndistribution = \"uniform\"\nlow = 1\nhigh = 100001\n";

class StudyCommand : public VsiCommand {
 protected:
  void SetUp() override {
    VsiCommand::SetUp();
    write("scene.toml", scene);
  }
  [[nodiscard]] std::string text(const std::string& name) const {
    std::ostringstream content;
    content << std::ifstream(folder_ / name).rdbuf();
    return content.str();
  }
  void expect_plan_rejected(const std::string& plan, const std::string& message) const {
    write("plan.toml", plan);
    expect_rejected("study plan.toml -o out", message);
  }
  [[nodiscard]] nlohmann::json json(const std::string& name) const { return nlohmann::json::parse(text(name)); }
  /// Cells of a table, the header first.
  [[nodiscard]] std::vector<std::vector<std::string>> table(const std::string& name) const {
    std::vector<std::vector<std::string>> rows;
    std::istringstream stream(text(name));
    for (std::string line; std::getline(stream, line);) {
      std::istringstream cells(line + ",");
      rows.emplace_back();
      for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
    }
    return rows;
  }
  [[nodiscard]] std::vector<std::string> column(const std::string& file, const std::string& name) const {
    const auto rows = table(file);
    const auto at = std::find(rows[0].begin(), rows[0].end(), name);
    EXPECT_NE(at, rows[0].end()) << name;
    std::vector<std::string> values;
    for (std::size_t i = 1; i < rows.size(); ++i) values.push_back(rows[i][std::size_t(at - rows[0].begin())]);
    return values;
  }
  [[nodiscard]] int study(const std::string& arguments) const {
    const Outcome outcome = vsi("study " + arguments + " --quiet");
    if (outcome.exit_code != 0) ADD_FAILURE() << arguments << "\n" << outcome.output;
    return outcome.exit_code;
  }
};

// One row per point of the grid and sample, a column with unit per key and measure; the measures are those of vsi run
// with the same keys, and the HDF5 file holds the same numbers.
TEST_F(StudyCommand, MakesATableOfAllRuns) {
  write("plan.toml", std::string(speeds) + friction + "[sampling]\nsamples = 2\nseed = 5\n");
  ASSERT_EQ(study("plan.toml -o out"), 0);
  const auto rows = table("out/runs.csv");
  ASSERT_EQ(rows.size(), 7U);
  EXPECT_EQ(rows[0][1], "train.speed_kmh[km/h]");
  EXPECT_EQ(rows[0][2], "contact.friction[-]");
  const std::vector<std::string> speed = column("out/runs.csv", "train.speed_kmh[km/h]");
  EXPECT_EQ(speed, (std::vector<std::string>{"100", "100", "150", "150", "200", "200"}));
  EXPECT_EQ(rows[1][2], rows[3][2]) << "each speed has the same samples";
  EXPECT_NE(rows[1][2], rows[2][2]);
  for (const std::string& value : column("out/runs.csv", "wheel_unloading[-]")) EXPECT_GT(std::stod(value), 0.0);
  for (const std::string& value : column("out/runs.csv", "deck_acceleration[m/s2]")) EXPECT_EQ(value, "") << "no deck";

  const ArrayFileReader file(folder_ / "out/study.h5", "railtab-study", 1);
  const Array stored = file.read("measures/wheel_unloading"), kmh = file.read("variables/train.speed_kmh");
  EXPECT_EQ(file.text("variables/train.speed_kmh", "unit"), "km/h");
  const std::vector<std::string> unloading = column("out/runs.csv", "wheel_unloading[-]");
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(stored.values[i], std::stod(unloading[i]));
    EXPECT_EQ(kmh.values[i], std::stod(speed[i]));
  }
  EXPECT_TRUE(std::isnan(file.read("measures/deck_acceleration").values[0]));
  EXPECT_FALSE(std::filesystem::exists(folder_ / ("out/" + rows[1][0] + ".h5"))) << "keep_results is false";
}

// A value of the plan is a key of the scene: results that are kept are those of a run with that key.
TEST_F(StudyCommand, RunsTheSceneWithTheKeysOfThePlan) {
  write("plan.toml",
        "scene = \"scene.toml\"\nkeep_results = true\n[[vary]]\nkey = \"train.speed\"\nvalues = [40]\n"
        "[[vary]]\nkey = \"train.vehicle\"\nvalues = [\"manchester-coach\", \"ice3-like-coach\"]\n");
  ASSERT_EQ(study("plan.toml -o out"), 0);
  const auto rows = table("out/runs.csv");
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[2][2], "ice3-like-coach");
  EXPECT_NE(column("out/runs.csv", "wheel_force[N]")[0], column("out/runs.csv", "wheel_force[N]")[1]);
  const RunResults kept = read_results(folder_ / ("out/" + rows[2][0] + ".h5"));
  EXPECT_EQ(kept.header.speed, 40.0);
  EXPECT_NE(kept.header.scene_text.find("train.vehicle = \"ice3-like-coach\""), std::string::npos);
}

// A train of several vehicles is a text, as after vsi assess --train; it takes the place of the scene's vehicle and
// count. A vehicle of a file belongs to what the folder is bound to.
TEST_F(StudyCommand, VariesTheTrain) {
  write("scene.toml", std::string(scene).insert(8, "count = 2\nvehicle = \"manchester-coach\"\n"));
  write("coach.toml", vsi("vehicle manchester-coach --toml").output);
  write("plan.toml",
        "scene = \"scene.toml\"\nkeep_results = true\n[[vary]]\nkey = \"train.consist\"\n"
        "values = [\"manchester-coach*2\", \"ice3-like-coach+-coach.toml\"]\n");
  ASSERT_EQ(study("plan.toml -o out"), 0);
  const auto rows = table("out/runs.csv");
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[2][1], "ice3-like-coach+-coach.toml");
  const RunResults mixed = read_results(folder_ / ("out/" + rows[2][0] + ".h5"));
  EXPECT_NE(mixed.header.scene_text.find("train.consist = [\"ice3-like-coach\", \"-coach.toml\"]"), std::string::npos);
  EXPECT_GT(std::stod(column("out/runs.csv", "wheel_force[N]")[1]),
            1.1 * std::stod(column("out/runs.csv", "wheel_force[N]")[0]))
      << "a heavier coach";
  write("coach.toml", vsi("vehicle manchester-coach --toml").output + "# changed\n");
  const std::string changed = vsi("study plan.toml -o out").output;
  EXPECT_NE(changed.find("out/scene.toml: found another scene"), std::string::npos) << changed;
  EXPECT_NE(changed.find("; the contents of coach.toml have changed\n"), std::string::npos) << changed;
}

// Flexible track without a bridge, as vsi new writes it.
TEST_F(StudyCommand, RunsWithoutABridge) {
  write("scene.toml",
        "[contact]\nnormal = \"rigid\"\n[track]\nlength_before = 40\nlength_after = 20\n[integration]\n"
        "time_step = 1e-3\nduration = 0.1\n");
  write("plan.toml", "scene = \"scene.toml\"\n[[vary]]\nkey = \"train.speed_kmh\"\nvalues = [100]\n");
  ASSERT_EQ(study("plan.toml -o track"), 0);
  EXPECT_NE(column("track/runs.csv", "wheel_force[N]")[0], "");
  const std::string limit = "[probability]\nmethod = \"monte-carlo\"\nmeasure = \"deck_acceleration\"\nlimit = 1\n";
  write("plan.toml", std::string(speeds) + seeds + "[sampling]\nsamples = 2\n" + limit);
  write("scene.toml", scene);
  for (const char* command : {"study plan.toml -o no", "study plan.toml --count"}) {
    expect_rejected(
        command,
        "plan.toml:12: probability.measure: found \"deck_acceleration\", expected a measure of wheels or car "
        "bodies, or a scene with a bridge: scene.toml has none");
  }
}

// What a run says names its command and what varies, and no results that are gone.
TEST_F(StudyCommand, TellsWhichRunEndedEarlyOrWarns) {
  write("scene.toml",
        "[contact]\nmode = \"online\"\n[track]\nkind = \"rigid\"\n[integration]\nduration = 3.0\n"
        "[[load]]\nFy = 3e5\nMx = 6e5\nstart = 0.05\ngust_duration = 4.0\n"
        "[[load]]\nFy = 1.0\nstart = 500\ngust_duration = 4.0\n");
  write("plan.toml", "scene = \"scene.toml\"\n[[vary]]\nkey = \"train.speed_kmh\"\nvalues = [140, 150]\n");
  const Outcome outcome = vsi("study plan.toml -o out");
  EXPECT_EQ(outcome.exit_code, 1);
  for (const char* speed : {"140", "150"}) {
    const std::string run = std::string(", train.speed_kmh = ") + speed + ": the run ended at t = ";
    const std::size_t at = outcome.output.find(run);
    ASSERT_NE(at, std::string::npos) << outcome.output;
    EXPECT_EQ(outcome.output.rfind("vsi study: r", at), outcome.output.rfind('\n', at) + 1) << outcome.output;
  }
  EXPECT_EQ(outcome.output.find(".h5"), std::string::npos) << outcome.output;
  EXPECT_EQ(outcome.output.find("vsi run"), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find("vsi study: warning: [[load]] 2 of 2 is specified for t = 500 to 504 s"),
            std::string::npos)
      << outcome.output;
  EXPECT_NE(outcome.output.find(", and alike in 1 more)\n"), std::string::npos) << outcome.output;
  const std::string again = vsi("study plan.toml -o out --json").output;
  EXPECT_EQ(nlohmann::json::parse(again.substr(again.find('{')))["warnings"].size(), 1U) << again;
}

// Decks are judged at all their nodes, as vsi assess judges them: the largest of what the run followed, not midspan.
TEST_F(StudyCommand, JudgesWholeDecks) {
  write("scene.toml",
        "[contact]\nmode = \"online\"\n[track]\nlength_before = 30\nlength_after = 30\n"
        "[integration]\ntime_step = 1e-3\n[irregularity]\nfile = \"track.csv\"\n"
        "[[bridge]]\nlength = 25.0\nmass = 15e3\nE = 30e9\nIy = 1.0\n");
  // the right rail falls by 0.02 mm/m: 0.06 mm over 3 m
  write("track.csv", "x[m],y_left[mm],z_left[mm],y_right[mm],z_right[mm]\n-60,0,0,0,0\n100,0,0,0,3.2\n");
  write("plan.toml",
        "scene = \"scene.toml\"\nkeep_results = true\n[[vary]]\nkey = \"train.speed_kmh\"\nvalues = [250]\n");
  ASSERT_EQ(study("plan.toml -o out"), 0);
  for (const char* measure : {"deck_twist[m]", "deck_end_rotation[rad]", "horizontal_rotation[rad]",
                              "deck_joint_step[m]", "deck_joint_gap[m]"}) {
    const std::string value = column("out/runs.csv", measure)[0];
    ASSERT_NE(value, "") << measure;
    EXPECT_GE(std::stod(value), 0.0) << measure;
  }
  EXPECT_GT(std::stod(column("out/runs.csv", "deck_end_rotation[rad]")[0]), 1e-4);
  EXPECT_NEAR(std::stod(column("out/runs.csv", "track_twist[m]")[0]),
              std::stod(column("out/runs.csv", "deck_twist[m]")[0]) + 6e-5, 1e-9);
  const RunResults run = read_results(folder_ / ("out/" + table("out/runs.csv")[1][0] + ".h5"));
  double largest = 0.0, midspan = 0.0;
  for (std::size_t q = 0; q < run.header.deck.size(); ++q) {
    if (run.header.deck[q].quantity != "acceleration") continue;
    for (std::size_t i = 0; i < run.header.deck[q].x.size(); ++i) {
      const DeckExtremes& e = run.summary.deck[q];
      const double here = std::max(-e.smallest[i], e.largest[i]);
      largest = std::max(largest, here);
      if (std::abs(run.header.deck[q].x[i] - 12.5) < 1e-9) midspan = here;
    }
  }
  EXPECT_NEAR(std::stod(column("out/runs.csv", "deck_acceleration_unfiltered[m/s2]")[0]), largest, 1e-6 * largest);
  EXPECT_GT(largest, 1.005 * midspan) << "a node beside midspan";
}

// A plan that varies the bridge low-passes each run at the cut-off of its own deck: as a scene with that bridge.
TEST_F(StudyCommand, LowPassesEachDeckAtItsOwnCutOff) {
  const auto scene_of_length = [](const char* length) {
    return std::string(
               "[contact]\nmode = \"online\"\n[track]\nlength_before = 30\nlength_after = 30\n[integration]\n"
               "time_step = 1e-3\n[[bridge]]\nmass = 15e3\nE = 30e9\nIy = 1.0\nlength = ") +
           length + "\n";
  };
  const std::string speed =
      "scene = \"scene.toml\"\nkeep_results = true\n[[vary]]\nkey = \"train.speed_kmh\"\nvalues = [250]\n";
  const auto kept_text = [&](const std::string& folder, std::size_t row) {
    return read_results(folder_ / (folder + "/" + table(folder + "/runs.csv")[row][0] + ".h5")).header.scene_text;
  };
  write("scene.toml", scene_of_length("25.0"));
  write("plan.toml", speed + "[[vary]]\nkey = \"bridge.length\"\nvalues = [12.0, 25.0]\n");
  ASSERT_EQ(study("plan.toml -o varied"), 0);
  EXPECT_FALSE(json("varied/study.json").contains("deck_cut_off"));
  std::size_t row = 0;
  for (const char* length : {"12.0", "25.0"}) {
    const std::string own = std::string("own") + length;
    write("scene.toml", scene_of_length(length));
    write("plan.toml", speed);
    ASSERT_EQ(study("plan.toml -o " + own), 0);
    for (const char* measure : {"deck_acceleration[m/s2]", "deck_acceleration_unfiltered[m/s2]"}) {
      EXPECT_EQ(column("varied/runs.csv", measure)[row], column(own + "/runs.csv", measure)[0]) << length << measure;
    }
    ++row;
    const std::string text = kept_text(own, 1), cut_off = text.substr(text.rfind("output.deck_cut_off = "));
    EXPECT_NE(kept_text("varied", row).find(cut_off), std::string::npos) << cut_off;
  }
  // third natural frequencies: 139 and 32 Hz
  EXPECT_GT(json("own12.0/study.json")["deck_cut_off"], 4.0 * json("own25.0/study.json")["deck_cut_off"].get<double>());
}

// Integer keys by a formula or a table: the key's value is rounded down, not the variable.
TEST_F(StudyCommand, RoundsIntegerKeysDownNotTheirVariable) {
  const std::string begin =
      "scene = \"scene.toml\"\nkeep_results = true\n[[vary]]\nname = \"u\"\ndistribution = \"uniform\"\nlow = 0.5\n"
      "high = 1.5\n[[vary.set]]\nkey = \"irregularity.seed\"\n";
  for (const char* set : {"factor = 1000\noffset = -499\n", "table = [[0.5, 1], [1.5, 1001]]\n"}) {
    write("plan.toml", begin + set + "[sampling]\nsamples = 4\n");
    const std::string folder = std::string("by_") + set[0];
    ASSERT_EQ(study("plan.toml -o " + folder), 0) << set;
    const auto rows = table(folder + "/runs.csv");
    ASSERT_EQ(rows.size(), 5U) << set;
    std::set<std::string> unloading;
    for (std::size_t i = 1; i < rows.size(); ++i) {
      const double u = std::stod(rows[i][1]);
      EXPECT_NE(u, std::floor(u));
      const RunResults results = read_results(folder_ / (folder + "/" + rows[i][0] + ".h5"));
      const std::string seed = "irregularity.seed = " + std::to_string(int(std::floor(1.0 + 1000.0 * (u - 0.5))));
      EXPECT_NE(results.header.scene_text.find(seed), std::string::npos) << results.header.scene_text;
      unloading.insert(column(folder + "/runs.csv", "wheel_unloading_unfiltered[-]")[i - 1]);
    }
    EXPECT_EQ(unloading.size(), 4U) << "four tracks";
  }
}

// Five of six samples are one run and the sixth another: means are those of the samples.
TEST_F(StudyCommand, MeansAreOfAllSamples) {
  write(
      "plan.toml",
      "scene = \"scene.toml\"\n[[vary]]\nkey = \"irregularity.seed\"\ndistribution = \"uniform\"\nlow = 1\nhigh = 2.2\n"
      "[sampling]\nsamples = 6\n");
  ASSERT_EQ(study("plan.toml -o out"), 0);
  const auto rows = table("out/runs.csv");
  ASSERT_EQ(rows.size(), 3U);
  const std::vector<std::string> values = column("out/runs.csv", "wheel_unloading_unfiltered[-]");
  double mean = 0.0;
  for (std::size_t i = 0; i < 2; ++i) mean += std::stod(values[i]) * (rows[i + 1][1] == "1" ? 5.0 : 1.0) / 6.0;
  const nlohmann::json measure = json("out/study.json")["measures"]["wheel_unloading_unfiltered"];
  EXPECT_NEAR(measure["mean"], mean, 1e-12);
  EXPECT_EQ(measure["runs"], 2);
}

// Bytes are the same from one worker and two, from shards, and after five kills; a longer plan keeps what is there.
TEST_F(StudyCommand, MakesTheSameTableHoweverItIsMade) {
  const std::string plan = std::string(speeds) + seeds + "[sampling]\nmethod = \"monte-carlo\"\nseed = 3\nsamples = ";
  write("plan.toml", plan + "3\n");
  ASSERT_EQ(study("plan.toml -o one --threads 1"), 0);
  const std::string rows = text("one/runs.csv");
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 10);
  ASSERT_EQ(study("plan.toml -o two --threads 2"), 0);
  EXPECT_EQ(text("two/runs.csv"), rows);
  EXPECT_EQ(text("two/study.json"), text("one/study.json"));

  for (const char* shard : {"1/2", "2/2"}) {
    ASSERT_EQ(study(std::string("plan.toml -o parts --threads 1 --shard ") + shard), 0);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "parts/runs.csv"));
  }
  ASSERT_EQ(study("plan.toml -o parts"), 0);
  EXPECT_EQ(text("parts/runs.csv"), rows);

  int killed = 0;
  for (int k = 0; k < 5; ++k) {
    killed += run("timeout -s KILL 0.4 '" VSI_COMMAND "' study plan.toml -o killed --threads 2 --quiet").exit_code != 0;
  }
  EXPECT_GE(killed, 1) << "the kills came too late to say anything";
  ASSERT_EQ(study("plan.toml -o killed"), 0);
  EXPECT_EQ(text("killed/runs.csv"), rows);

  write("plan.toml", plan + "4\n");
  const auto before = std::filesystem::last_write_time(folder_ / ("one/" + table("one/runs.csv")[1][0] + ".row"));
  ASSERT_EQ(study("plan.toml -o one"), 0);
  EXPECT_EQ(table("one/runs.csv").size(), 13U);
  EXPECT_EQ(std::filesystem::last_write_time(folder_ / ("one/" + table("one/runs.csv")[1][0] + ".row")), before);
}

// Shares of runs beyond the limit are those of the table, with the intervals of the library.
TEST_F(StudyCommand, CountsExceedances) {
  const std::string plan = std::string(speeds) + seeds + "[sampling]\nsamples = 6\n[probability]\n" +
                           "measure = \"wheel_unloading_unfiltered\"\nlimit = 0.12\n";
  write("plan.toml", plan + "method = \"monte-carlo\"\n");
  ASSERT_EQ(study("plan.toml -o out"), 0);
  const std::vector<std::string> speed = column("out/runs.csv", "train.speed_kmh[km/h]");
  const std::vector<std::string> unloading = column("out/runs.csv", "wheel_unloading_unfiltered[-]");
  const auto rows = table("out/probability.csv");
  ASSERT_EQ(rows.size(), 4U);
  std::size_t all = 0;
  for (std::size_t level = 1; level < 4; ++level) {
    std::size_t hits = 0;
    for (std::size_t i = 0; i < speed.size(); ++i)
      hits += speed[i] == rows[level][0] && std::stod(unloading[i]) >= 0.12;
    all += hits;
    EXPECT_EQ(rows[level][1], "6");
    EXPECT_EQ(rows[level][2], std::to_string(hits));
    const ConfidenceInterval interval = wilson_interval(hits, 6, 0.95);
    EXPECT_NEAR(std::stod(rows[level][5]), interval.low, 1e-7);
    EXPECT_NEAR(std::stod(rows[level][6]), interval.high, 1e-7);
  }
  EXPECT_GT(all, 0U);
  EXPECT_LT(all, speed.size());

  write("plan.toml", plan + "method = \"fragility\"\nintensity = \"train.speed_kmh\"\n");
  ASSERT_EQ(study("plan.toml -o out"), 0);  // the runs are there
  const nlohmann::json found = json("out/study.json")["probability"];
  ASSERT_TRUE(found.contains("median")) << text("out/fragility.csv");
  EXPECT_GT(found["median"]["value"], 100.0);
  EXPECT_LT(found["median"]["value"], 200.0);
  EXPECT_EQ(table("out/fragility.csv")[0].back(), "curve_high[-]");
}

// Runs of a sample at several values of another variable, here of one that changes nothing, are no further trials.
TEST_F(StudyCommand, CountsSamplesAsTrialsOfAFragilityCurve) {
  const std::string end = std::string(seeds) +
                          "[sampling]\nsamples = 6\n[probability]\nmethod = \"fragility\"\nlimit = 0.12\n"
                          "measure = \"wheel_unloading_unfiltered\"\nintensity = \"train.speed_kmh\"\n";
  write("plan.toml", speeds + end);
  ASSERT_EQ(study("plan.toml -o one"), 0);
  write("plan.toml", std::string(speeds) + "[[vary]]\nkey = \"assessment.section_step\"\nvalues = [0.5, 1.0]\n" + end);
  ASSERT_EQ(study("plan.toml -o two"), 0);
  EXPECT_EQ(column("two/fragility.csv", "runs"), (std::vector<std::string>{"12", "12", "12"}));
  for (const char* name : {"probability[-]", "probability_low[-]", "probability_high[-]"}) {
    EXPECT_EQ(column("two/fragility.csv", name), column("one/fragility.csv", name)) << name;
  }
}

// An intensity that slows the train down.
TEST_F(StudyCommand, SaysThatExceedancesDoNotGrow) {
  write("plan.toml",
        std::string("scene = \"scene.toml\"\n[[vary]]\nname = \"w\"\nvalues = [100, 150, 200]\n[[vary.set]]\n"
                    "key = \"train.speed_kmh\"\nfactor = -1\noffset = 300\n") +
            seeds +
            "[sampling]\nsamples = 6\n[probability]\nmethod = \"fragility\"\nlimit = 0.12\n"
            "measure = \"wheel_unloading_unfiltered\"\nintensity = \"w\"\n");
  const Outcome outcome = vsi("study plan.toml -o out");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.output.find("no fragility curve: exceedances do not grow with the intensity\n"), std::string::npos)
      << outcome.output;
}

// Four levels of chains, whose runs are decided by those before them: the same after kills and on one worker.
TEST_F(StudyCommand, SubsetSimulationIsTheSameAfterKills) {
  write("plan.toml", std::string("scene = \"scene.toml\"\n") + friction +
                         "[[vary]]\nkey = \"train.speed_kmh\"\ndistribution = \"normal\"\nmean = 110\nstd = 10\n"
                         "[probability]\nmethod = \"subset\"\nmeasure = \"wheel_unloading_unfiltered\"\nlimit = 0.17\n"
                         "samples = 20\nlevel_probability = 0.2\nseed = 2\n");
  ASSERT_EQ(study("plan.toml -o whole --threads 2"), 0);
  const nlohmann::json found = json("whole/study.json")["probability"];
  EXPECT_EQ(found["outcome"], "found");
  EXPECT_GT(table("whole/subset.csv").size(), 2U) << "one level says nothing of chains";
  double product = 1.0;
  for (const std::string& p : column("whole/subset.csv", "probability[-]")) product *= std::stod(p);
  EXPECT_NEAR(found["probability"]["value"], product, 1e-6 * product);
  EXPECT_LT(found["probability"]["low"], product);
  EXPECT_GT(found["probability"]["high"], product);
  for (int k = 0; k < 4; ++k) {
    static_cast<void>(run("timeout -s KILL 0.5 '" VSI_COMMAND "' study plan.toml -o killed --threads 1 --quiet"));
  }
  ASSERT_EQ(study("plan.toml -o killed --threads 1"), 0);
  EXPECT_EQ(text("killed/runs.csv"), text("whole/runs.csv"));
  EXPECT_EQ(text("killed/study.json"), text("whole/study.json"));
}

// A limit that every sample of the first level exceeds: 20 of 20 trials.
TEST_F(StudyCommand, OneLevelHasTheIntervalOfItsTrials) {
  write("plan.toml", std::string("scene = \"scene.toml\"\n") + friction +
                         "[probability]\nmethod = \"subset\"\nmeasure = \"wheel_unloading_unfiltered\"\nlimit = "
                         "0.001\nsamples = 20\nlevel_probability = 0.2\nseed = 2\n");
  ASSERT_EQ(study("plan.toml -o out --threads 2"), 0);
  const nlohmann::json found = json("out/study.json")["probability"]["probability"];
  EXPECT_EQ(found["value"], 1.0);
  EXPECT_EQ(found["high"], 1.0);
  const double z = 1.959964;  // of 95 %
  EXPECT_NEAR(found["low"], 20.0 / (20.0 + z * z), 1e-6);
}

TEST_F(StudyCommand, FindsAPeakWithAQuarterOfTheGrid) {
  write("plan.toml",
        "scene = \"scene.toml\"\n[[vary]]\nkey = \"train.speed_kmh\"\nrange = \"100:199:1\"\n"
        "[peak]\nmeasure = \"wheel_unloading\"\n");
  ASSERT_EQ(study("plan.toml -o out"), 0);
  EXPECT_LE(table("out/runs.csv").size() - 1, 25U);
  const nlohmann::json peak = json("out/study.json")["peak"];
  double largest = 0.0;
  for (const std::string& value : column("out/runs.csv", "wheel_unloading[-]"))
    largest = std::max(largest, std::stod(value));
  EXPECT_EQ(peak["value"], largest);
  EXPECT_EQ(peak["grid"], 100);
  EXPECT_EQ(peak["ended_early"], false);
  const nlohmann::json measure = json("out/study.json")["measures"]["wheel_unloading"];
  EXPECT_EQ(measure["greatest"], largest);
  EXPECT_FALSE(measure.contains("mean")) << "points of a search have none";

  write("plan.toml",
        "scene = \"scene.toml\"\n[[vary]]\nkey = \"train.speed_kmh\"\nrange = \"100:140:10\"\n"
        "[peak]\nmeasure = \"wheel_unloading\"\ncoarse_step = 2\n");
  const std::string few = vsi("study plan.toml -o few").output;
  EXPECT_NE(few.find("3 of 5 points of the grid; not resolved to one step: the points that it begins with are more "
                     "than a quarter of the grid\n"),
            std::string::npos)
      << few;
}

// A run that derails has no largest value.
TEST_F(StudyCommand, HasNoPeakWhereRunsEndEarly) {
  write("scene.toml",
        "[contact]\nmode = \"online\"\n[track]\nkind = \"rigid\"\n[integration]\nduration = 3.0\n"
        "[[load]]\nFy = 3e5\nMx = 6e5\nstart = 0.05\ngust_duration = 4.0\n");
  write("plan.toml",
        "scene = \"scene.toml\"\n[[vary]]\nname = \"w\"\nunit = \"kN\"\nvalues = [0, 300]\n"
        "[[vary.set]]\nkey = \"load.1.Fy\"\nfactor = 1e3\n[[vary.set]]\nkey = \"load.1.Mx\"\nfactor = 2e3\n"
        "[peak]\nmeasure = \"wheel_unloading\"\n");
  const Outcome outcome = vsi("study plan.toml -o out");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(
      outcome.output.find("wheel_unloading: runs end early from w = 300 kN on, as far as computed: no largest value\n"),
      std::string::npos)
      << outcome.output;
  const nlohmann::json peak = json("out/study.json")["peak"];
  EXPECT_EQ(peak["ended_early"], true);
  EXPECT_EQ(peak["w"], 300.0);
  EXPECT_FALSE(peak.contains("value"));
}

// The wind at which wheels are unloaded by 0.3, at two speeds: what a table of all runs says, with a third of them.
TEST_F(StudyCommand, FindsWhereALimitIsReached) {
  write("wind.csv", "yaw[deg],C_Fy[1],C_Mx[1]\n0,0,0\n90,5,3\n");
  write("scene.toml", std::string(scene) +
                          "[[load]]\nbody = \"car-body\"\naerodynamics = \"wind.csv\"\n"
                          "wind_speed = 1.0\n");
  const std::string grid =
      "scene = \"scene.toml\"\n[[vary]]\nkey = \"train.speed_kmh\"\nvalues = [100, 160]\n"
      "[[vary]]\nkey = \"load.1.wind_speed\"\nrange = \"10:48:2\"\n";
  const std::string begin = "[threshold]\nmeasure = \"wheel_unloading\"\nvariable = \"load.1.wind_speed\"\nlimit = ";
  write("all.toml", grid);
  write("plan.toml", grid + begin + "0.3\n");
  ASSERT_EQ(study("all.toml -o all"), 0);
  ASSERT_EQ(study("plan.toml -o out"), 0);
  EXPECT_LE(table("out/runs.csv").size() - 1, 10U);
  const auto speed = column("all/runs.csv", "train.speed_kmh[km/h]"),
             wind = column("all/runs.csv", "load.1.wind_speed[m/s]"),
             unloading = column("all/runs.csv", "wheel_unloading[-]");
  const auto found = table("out/threshold.csv");
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0], (std::vector<std::string>{"train.speed_kmh[km/h]", "load.1.wind_speed[m/s]",
                                                "load.1.wind_speed_below[m/s]", "load.1.wind_speed_reached[m/s]",
                                                "wheel_unloading_below[-]", "wheel_unloading_reached[-]"}));
  for (std::size_t row = 1; row < 3; ++row) {
    std::size_t i = 0;
    while (i < speed.size() && (speed[i] != found[row][0] || std::stod(unloading[i]) < 0.3)) ++i;
    ASSERT_TRUE(i > 0 && i < speed.size());
    EXPECT_EQ(found[row][3], wind[i]);
    EXPECT_EQ(found[row][2], wind[i - 1]);
    EXPECT_NEAR(std::stod(found[row][5]), std::stod(unloading[i]), 1e-7);
    const double below = std::stod(unloading[i - 1]), share = (0.3 - below) / (std::stod(unloading[i]) - below);
    EXPECT_NEAR(std::stod(found[row][1]), std::stod(wind[i - 1]) + 2.0 * share, 1e-5);
  }
  EXPECT_LT(std::stod(found[2][1]), std::stod(found[1][1])) << "a faster train bears less wind";

  write("plan.toml", grid + begin + "5\n");  // beyond lift-off: no unloading is so large
  ASSERT_EQ(study("plan.toml -o out"), 0);
  EXPECT_EQ(table("out/threshold.csv")[1][2], "48");
  EXPECT_EQ(table("out/threshold.csv")[1][3], "");
  EXPECT_FALSE(json("out/study.json")["threshold"]["thresholds"][0].contains("reached"));
}

// A key that does not act on what is measured has no share of its variance.
TEST_F(StudyCommand, FindsWhichVariableMatters) {
  write(
      "plan.toml",
      "scene = \"scene.toml\"\n[[vary]]\nkey = \"train.speed_kmh\"\ndistribution = \"uniform\"\nlow = 100\nhigh = 200\n"
      "[[vary]]\nkey = \"assessment.section_step\"\ndistribution = \"uniform\"\nlow = 0.1\nhigh = 1\n"
      "[importance]\nmeasure = \"wheel_unloading\"\nsamples = 8\n");
  ASSERT_EQ(study("plan.toml -o out"), 0);
  EXPECT_EQ(table("out/runs.csv").size(), 33U);
  const nlohmann::json variables = json("out/study.json")["importance"]["variables"];
  EXPECT_GT(variables["train.speed_kmh"]["total"]["value"], 0.3);
  EXPECT_EQ(variables["assessment.section_step"]["total"]["value"], 0.0);
  EXPECT_GT(variables["train.speed_kmh"]["total"]["value"], 1.0);  // which no share is
  const Outcome again = vsi("study plan.toml -o out");
  EXPECT_NE(again.output.find("errors of sampling: 8 samples are too few"), std::string::npos) << again.output;

  write("plan.toml",
        "scene = \"scene.toml\"\n[[vary]]\nkey = \"assessment.section_step\"\ndistribution = \"uniform\"\nlow = 0.1\n"
        "high = 1\n[importance]\nmeasure = \"wheel_unloading\"\nsamples = 8\n");
  const Outcome none = vsi("study plan.toml -o none");
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_NE(none.output.find("importance: all 16 independent responses are "), std::string::npos) << none.output;
  EXPECT_EQ(none.output.find("nan"), std::string::npos) << none.output;
}

// Wind speed drives two forces, by its square.
TEST_F(StudyCommand, OneVariableSetsSeveralKeys) {
  write("scene.toml", std::string(scene) + "[[load]]\nbody = \"car-body\"\nFy = 1.0\nFz = 1.0\n");
  write("plan.toml",
        "scene = \"scene.toml\"\nkeep_results = true\n[[vary]]\nname = \"wind_speed\"\nunit = \"m/s\"\nvalues = [10, "
        "20]\n"
        "[[vary.set]]\nkey = \"load.1.Fy\"\nfactor = 50\npower = 2\n"
        "[[vary.set]]\nkey = \"load.1.Fz\"\nfactor = -10\npower = 2\n");
  ASSERT_EQ(study("plan.toml -o out"), 0);
  const auto rows = table("out/runs.csv");
  EXPECT_EQ(rows[0][1], "wind_speed[m/s]");
  const RunResults results = read_results(folder_ / ("out/" + rows[2][0] + ".h5"));
  EXPECT_NE(results.header.scene_text.find("load.1.Fy = 20000, load.1.Fz = -4000"), std::string::npos)
      << results.header.scene_text;
}

// Temperature drives a stiffness by a table and a damping by a line; it may be negative.
TEST_F(StudyCommand, KeysFollowATableOfTheVariable) {
  write("scene.toml",
        "[contact]\nnormal = \"rigid\"\n[track]\nlength_before = 30\nlength_after = 20\n"
        "[integration]\ntime_step = 1e-3\nduration = 0.1\n[[bridge]]\nlength = 16.0\nmass = 12e3\nE = 30e9\nIy = "
        "0.25\n");
  const std::string begin =
      "scene = \"scene.toml\"\nkeep_results = true\n[[vary]]\nname = \"temperature\"\nunit = \"degC\"\n";
  const std::string pads =
      "[[vary.set]]\nkey = \"track.pad.kz\"\ntable = [[-20, 120e6], [0, 80e6], [30, 50e6]]\n"
      "[[vary.set]]\nkey = \"track.pad.cz\"\nfactor = -200\noffset = 30e3\n";
  write("plan.toml", begin + "values = [-20, -5, 0, 15, 30]\n" + pads);
  ASSERT_EQ(study("plan.toml -o tables"), 0);
  const auto rows = table("tables/runs.csv");
  EXPECT_EQ(rows[0][1], "temperature[degC]");
  const std::vector<std::string> changes{
      "track.pad.kz = 120000000, track.pad.cz = 34000", "track.pad.kz = 90000000, track.pad.cz = 31000",
      "track.pad.kz = 80000000, track.pad.cz = 30000", "track.pad.kz = 65000000, track.pad.cz = 27000",
      "track.pad.kz = 50000000, track.pad.cz = 24000"};
  ASSERT_EQ(rows.size(), changes.size() + 1);
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const RunResults results = read_results(folder_ / ("tables/" + rows[i + 1][0] + ".h5"));
    EXPECT_NE(results.header.scene_text.find(changes[i]), std::string::npos) << results.header.scene_text;
  }
  EXPECT_NE(rows[1].back() + column("tables/runs.csv", "wheel_unloading_unfiltered[-]")[0],
            rows[5].back() + column("tables/runs.csv", "wheel_unloading_unfiltered[-]")[4]);
  const auto rejected = [&](const std::string& values, const std::string& sets, const std::string& message) {
    write("plan.toml", begin + values + sets);
    expect_rejected("study plan.toml -o no", message);
  };
  rejected("values = [-30, 0]\n", pads,
           "found a table of track.pad.kz from -20 to 30 for values from -30 to 0, expected a table as "
           "far as the values");
  rejected("distribution = \"normal\"\nmean = 10\nstd = 5\n", pads, "expected a table as far as the distribution");
  rejected("values = [0]\n", "[[vary.set]]\nkey = \"track.pad.kz\"\ntable = [[0, 1e8], [0, 2e8]]\n",
           "expected two points [[x, value], [x, value]] at least, x rising");
  rejected("values = [0]\n", "[[vary.set]]\nkey = \"track.pad.kz\"\nfactor = 2\ntable = [[0, 1e8], [1, 2e8]]\n",
           "set[1].factor: found a table too, expected a table, or factor, power and offset");
}

TEST_F(StudyCommand, RejectsWrongPlans) {
  const std::string begin = "scene = \"scene.toml\"\n[[vary]]\n";
  expect_plan_rejected(begin + "key = \"train.sped\"\nvalues = [1]\n",
                       "plan.toml:2: vary[1].train.sped: unknown key 'train.sped'; did you mean 'train.speed'?");
  expect_plan_rejected(begin + "key = \"train.speed_kmh\"\nvalues = [100, 9000]\n",
                       "plan.toml:2: vary[1].train.speed_kmh: found 9000, expected");
  std::string many = "scene = \"scene.toml\"\n";
  for (const char* key : {"train.speed_kmh", "contact.friction"}) {
    many += std::string("[[vary]]\nkey = \"") + key + "\"\nrange = \"0.1:0.9:1e-4\"\n";
  }
  expect_plan_rejected(
      many,
      "plan.toml: [[vary]]: found 6.4016e+07 points of all values together, times sampling.samples, expected "
      "at most 1000000");
  expect_plan_rejected(begin + "key = \"train.speed_kmh\"\nrange = \"1:2\"\n",
                       "plan.toml:4: vary[1].range: found the text \"1:2\", expected");
  expect_plan_rejected(begin + "key = \"train.speed_kmh\"\nvalus = [1]\n",
                       "plan.toml:4: unknown key 'vary[1].valus'; did you mean 'vary[1].values'?");
  write("plan.toml", "scene = \"scene.toml\"\n[[vary]]\nkey = \"train.sped\"\nvalues = [1]\n");
  expect_rejected("study plan.toml --count -o out", "unknown key 'train.sped'");
  expect_plan_rejected(begin + "key = \"assessment.seeds\"\nvalues = [1, 2]\n",
                       "vary[1].key: found 'assessment.seeds', expected a key that runs of a study depend on");
  expect_plan_rejected(
      begin +
          "key = \"contact.friction\"\ndistribution = \"normal\"\nmean = 0.3\nstd = 0.05\nat_least = 0.5\n"
          "at_most = 0.2\n",
      "vary[1].at_most: found 0.2, expected more than at_least = 0.5");
  expect_plan_rejected(begin + "key = \"train.speed_kmh\"\nvalues = []\n",
                       "plan.toml:4: vary[1].values: found an empty list, expected a list, [0.1, 0.2, 0.3]");
  expect_plan_rejected(
      begin +
          "key = \"contact.friction\"\ndistribution = \"normal\"\nmean = 0.3\nstd = 0.05\n[sampling]\nsamples = 20\n"
          "[probability]\nmethod = \"fragility\"\nmeasure = \"wheel_force\"\nlimit = 1\nintensity = \"a\"\n",
      "probability.intensity: found no [[vary]] with values or a range");
  expect_plan_rejected(begin + "key = \"train.speed_kmh\"\nvalues = [1, 1.0]\n",
                       "plan.toml:4: vary[1].values: found 1 twice");
  expect_plan_rejected(begin + "key = \"irregularity.seed\"\nvalues = [1.5]\n", "found 1.5, expected an integer");
  expect_plan_rejected(begin + "key = \"contact.friction\"\ndistribution = \"normal\"\nmean = 0.3\nstd = 5\n",
                       "plan.toml:1: sampling: found nothing");
  expect_plan_rejected(
      begin + "key = \"contact.friction\"\ndistribution = \"normal\"\nmean = 0.3\nstd = 5\n[sampling]\nsamples = 9\n",
      "contact.friction: found");
  expect_plan_rejected(begin + "key = \"contact.friction\"\ndistribution = \"normal\"\nmean = 0.3\n",
                       "found neither std nor cov");
  expect_plan_rejected("scene = \"none.toml\"\n[[vary]]\nkey = \"contact.friction\"\nvalues = [0.1]\n",
                       "plan.toml:1: scene: found no file none.toml");
  expect_plan_rejected("scene = \".\"\n[[vary]]\n",
                       "plan.toml:1: scene: found a folder ., expected the file of a scene, relative to the plan");
  expect_plan_rejected("scene = \"\"\n[[vary]]\n",
                       "plan.toml:1: scene: found the text \"\", expected a text that is not empty");
  expect_plan_rejected(std::string(speeds) + "[peak]\nmeasure = \"speed\"\n",
                       "plan.toml:6: peak.measure: found the text \"speed\", expected one of deck_acceleration");
  expect_plan_rejected(
      begin +
          "key = \"train.speed_kmh\"\nvalues = [200, 100]\n[threshold]\nmeasure = \"derailment\"\nlimit = 0.8\n"
          "variable = \"train.speed_kmh\"\n",
      "plan.toml:8: threshold.variable: found values of train.speed_kmh that do not rise, expected values that rise");
  expect_plan_rejected(
      std::string(speeds) + "[probability]\nmethod = \"subset\"\nmeasure = \"derailment\"\nlimit = 0.8\n",
      "found a variable with values, expected a distribution for each variable");
  expect_plan_rejected(std::string(speeds) + speeds, "plan.toml:5");
  const std::string first = begin + "key = \"load.1.Fz\"\nvalues = [1]\n[[vary]]\nname = \"again\"\nkey = ";
  expect_plan_rejected(first + "\"load.Fz\"\nvalues = [2]\n",
                       "vary[2].key: found load.1.Fz twice, expected each key once");
  for (const char* name : {"run", "complete", "message", "wheel_unloading"}) {
    expect_plan_rejected(begin + "name = \"" + name + "\"\nkey = \"train.speed_kmh\"\nvalues = [100]\n",
                         std::string("plan.toml:3: vary[1].name: found \"") + name +
                             "\", expected another name: runs.csv has a column of this one");
  }
  expect_plan_rejected(begin + "key = \"train.speed_kmh\"\nvalues = [200, 100]\n[peak]\nmeasure = \"derailment\"\n",
                       "plan.toml:2: vary[1].values: found values that do not rise, expected values that rise");
}

// A message about a key names the variable that sets this key, and none where it could be one of several.
TEST_F(StudyCommand, NamesTheVariableOfTheKey) {
  const std::string begin = "scene = \"scene.toml\"\n[[vary]]\nkey = ";
  expect_plan_rejected(
      begin + "\"integration.duration\"\nvalues = [1]\n[[vary]]\nkey = \"load.1.gust_duration\"\nvalues = [1]\n",
      "vsi: plan.toml:5: vary[2].load.1.gust_duration: found 0 [[load]] in the scene");
  write("scene.toml", std::string(scene) + "[[load]]\nFz = 1.0\n[[load]]\nFz = 1.0\n");
  expect_plan_rejected(begin + "\"load.2.Fz\"\nvalues = [\"x\"]\n",
                       "vsi: plan.toml:2: vary[1].load.2.Fz: found the text \"x\"");
  expect_plan_rejected(begin + "\"load.1.Fz\"\nvalues = [1]\n[[vary]]\nkey = \"load.2.Fz\"\nvalues = [\"x\"]\n",
                       "vsi: plan.toml: load.Fz: found the text \"x\"");
}

TEST_F(StudyCommand, KeepsOtherFilesAndOtherStudies) {
  write("plan.toml", std::string("scene = \"scene.toml\"\n[[vary]]\nkey = \"train.speed_kmh\"\nvalues = [100]\n"));
  std::filesystem::create_directory(folder_ / "mine");
  write("mine/runs.csv", "my numbers\n");
  const Outcome outcome = vsi("study plan.toml -o mine");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.output.find("mine/runs.csv: found a file that begins with 'my numbers'"), std::string::npos)
      << outcome.output;
  EXPECT_EQ(text("mine/runs.csv"), "my numbers\n");
  const std::string of_scene = vsi("study plan.toml -o .").output;
  EXPECT_NE(of_scene.find("-o .: found the scene itself, ./scene.toml, in this folder, expected another folder"),
            std::string::npos)
      << of_scene;
  ASSERT_EQ(study("plan.toml -o one"), 0);
  write("scene.toml", std::string(scene) + "time_step = 5e-4\n");
  const std::string other = vsi("study plan.toml -o one").output;
  EXPECT_NE(other.find("one/scene.toml: found another scene, expected that of the runs in this folder, or another "
                       "folder for -o; line 12 was an empty line and is 'time_step = 5e-4'\n"),
            std::string::npos)
      << other;
}

}  // namespace
}  // namespace railtab
