#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tablegen_fixture.hpp"

namespace railtab {
namespace {

namespace fs = std::filesystem;

class BatchCommand : public TablegenFixture {
 protected:
  void SetUp() override {
    TablegenFixture::SetUp();
    fs::create_directories(folder_ / "lists");
  }

  /// Runs `tablegen batch lists/list.toml`: outputs stand beside the list, not in the working folder.
  [[nodiscard]] Outcome batch(const std::string& list, const std::string& arguments = "") const {
    std::ofstream(folder_ / "lists/list.toml") << list;
    return tablegen("batch lists/list.toml " + arguments);
  }
  void expect_rejected(const std::string& list, const std::vector<std::string>& texts) const {
    const Outcome outcome = batch(list);
    EXPECT_EQ(outcome.exit_code, 2) << list << outcome.err;
    for (const std::string& text : texts) {
      EXPECT_NE(outcome.err.find(text), std::string::npos) << list << outcome.err << "\nlacks " << text;
    }
    EXPECT_FALSE(fs::exists(folder_ / "lists/a.h5"));
  }
  /// "file state" of each pair, from the JSON output.
  static std::vector<std::string> states(const Outcome& outcome) {
    std::vector<std::string> result;
    const nlohmann::json j = nlohmann::json::parse(outcome.out);
    for (const auto& pair : j["pairs"]) {
      result.push_back(fs::path(pair["file"].get<std::string>()).filename().string() + " " +
                       pair["state"].get<std::string>());
    }
    return result;
  }
};

using States = std::vector<std::string>;

const std::string defaults = "[defaults]\nrail = \"60E1\"\nlateral = [-0.0005, 0.0005]\nyaw = \"0:0.005\"\n";
// cones: their tables take no time
const std::string pair_a = "[[pair]]\nwheel = \"cone-1:20\"\noutput = \"a.h5\"\n";
const std::string pair_b = "[[pair]]\nwheel = \"cone-1:20\"\noutput = \"b.h5\"\nrail-inclination = \"1:20\"\n";

TEST_F(BatchCommand, MakesWhatIsMissingAndSkipsWhatIsDone) {
  EXPECT_EQ(states(batch(defaults + pair_a, "--plan --json")), States{"a.h5 to do"});
  EXPECT_FALSE(fs::exists(folder_ / "lists/a.h5"));
  EXPECT_EQ(states(batch(defaults + pair_a, "--json")), States{"a.h5 made"});
  const std::string bytes = contents(folder_ / "lists/a.h5");
  ASSERT_FALSE(bytes.empty());
  EXPECT_EQ(states(batch(defaults + pair_a + pair_b, "--json")), (States{"a.h5 done before", "b.h5 made"}));
  EXPECT_EQ(contents(folder_ / "lists/a.h5"), bytes) << "a finished table was touched";

  // the same numbers said in another way are the same options; others are rejected, unless --overwrite
  const std::string same = defaults + "tolerance = \"0.00000001\"\n" + pair_a;
  EXPECT_EQ(states(batch(same, "--json")), States{"a.h5 done before"});
  EXPECT_EQ(states(batch(defaults + "rail-inclination = 0.025\n" + pair_a, "--json")), States{"a.h5 done before"});
  const Outcome other = batch(defaults + "tolerance = 3e-8\n" + pair_a);
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_NE(other.err.find("lists/list.toml:6"), std::string::npos) << other.err;
  EXPECT_NE(other.err.find("tolerance=1e-08, expected tolerance=3e-08"), std::string::npos) << other.err;
  EXPECT_EQ(states(batch(defaults + "tolerance = 3e-8\n" + pair_a, "--overwrite --json")), States{"a.h5 made"});

  const Outcome wheel = batch(defaults + "tolerance = 3e-8\n[[pair]]\nwheel = \"cone20\"\noutput = \"a.h5\"\n");
  EXPECT_EQ(wheel.exit_code, 2) << wheel.err;
}

TEST_F(BatchCommand, AFailedTableDoesNotStopTheOthers) {
  // so far to the left, the right wheel stands beside the rail
  const std::string failing = "[[pair]]\nwheel = \"S1002\"\noutput = \"f.h5\"\nlateral = [-0.099, -0.095]\n";
  const Outcome outcome = batch(defaults + failing + pair_a, "--json");
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  EXPECT_EQ(states(outcome), (States{"f.h5 failed", "a.h5 made"}));
  EXPECT_NE(outcome.err.find("1 of 2 tables failed"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("lists/list.toml:5"), std::string::npos) << outcome.err;
  EXPECT_FALSE(fs::exists(folder_ / "lists/f.h5"));
}

TEST_F(BatchCommand, OnlyTakesEveryNthPair) {
  const std::string list = defaults + pair_a + pair_b;
  EXPECT_EQ(states(batch(list, "--only 2/2 --plan --json")), States{"b.h5 to do"});
  EXPECT_EQ(states(batch(list, "--only 1/1 --plan --json")), (States{"a.h5 to do", "b.h5 to do"}));
  EXPECT_EQ(states(batch(list, "--only 3/3 --plan --json")), States{}) << "more tasks than pairs";
  EXPECT_EQ(batch(list, "--only 0/2").exit_code, 2);
}

// As in tablegen geometry; a default is none of the pairs on whose profiles it does not act, unless there are no
// others.
TEST_F(BatchCommand, FilesAreNotInclinedAndBuiltInProfilesNotSmoothed) {
  std::ofstream(folder_ / "lists/rail.txt") << "points\n";
  const std::string of_file = "[[pair]]\nwheel = \"cone-1:20\"\nrail = \"rail.txt\"\noutput = \"a.h5\"\n";
  const std::string inclined = "rail-inclination = \"1:20\"\n", smoothed = "smoothing = 3e-6\n";
  const std::string message =
      "--rail-inclination: found 1:20 with the rail file lists/rail.txt, expected a built-in rail";
  expect_rejected(of_file + inclined, {"lists/list.toml:1: " + message});
  expect_rejected("[defaults]\n" + inclined + of_file, {"lists/list.toml:3: " + message});
  expect_rejected(defaults + inclined + of_file + inclined + pair_b, {"lists/list.toml:6: " + message});
  // with a built-in rail beside it only the points are wrong
  expect_rejected(defaults + inclined + of_file + pair_b, {"lists/list.toml:6: lists/rail.txt:1: "});

  const std::string built_in = ": --smoothing: found 3e-06 with the built-in profiles cone-1:20 and 60E1";
  expect_rejected(defaults + pair_a + smoothed, {"lists/list.toml:5" + built_in});
  expect_rejected(defaults + smoothed + pair_a, {"lists/list.toml:6" + built_in});
  expect_rejected(defaults + smoothed + pair_b + of_file, {"lists/list.toml:10: lists/rail.txt:1: "});
}

TEST_F(BatchCommand, WrongLists) {
  expect_rejected("", {"list.toml", "[[pair]]"});
  expect_rejected("[[pair]\n", {"lists/list.toml:1"});
  expect_rejected(defaults + pair_a + "yow = 1\n", {"lists/list.toml:8: yow", "unknown key", "yaw"});
  expect_rejected("[defaults]\noutput = \"a.h5\"\n" + pair_a, {"lists/list.toml:2: output", "unknown key"});
  expect_rejected(defaults + "[[pair]]\nwheel = \"" + std::string(300, 'w') + "\"\noutput = \"a.h5\"\n",
                  {"neither a built-in name nor a file"});
  expect_rejected("[pears]\nrail = 1\n", {"lists/list.toml:1: pears", "[[pair]]"});
  expect_rejected("[contact]\nmode = \"online\"\n",
                  {"lists/list.toml: found a scene, expected a list of wheel and rail pairs"});
  expect_rejected(pair_a, {"lists/list.toml:1", "no rail"});
  expect_rejected(defaults + "[[pair]]\nwheel = \"S1002\"\n", {"lists/list.toml:5", "no output"});
  expect_rejected(defaults + pair_a + pair_a, {"lists/list.toml:10: output", "a.h5", "lists/list.toml:5"});
  expect_rejected(defaults + pair_a + "gauge = true\n", {"lists/list.toml:8: gauge", "boolean"});
  expect_rejected(defaults + pair_a + "roll = [0.1, 0.2, 0.3]\n", {"lists/list.toml:8: roll", "[low, high]"});
  expect_rejected(defaults + pair_a + "tolerance = 0\n", {"lists/list.toml:5", "tolerance"});
  expect_rejected(defaults + pair_a + pair_b + "tolerance = \"small\"\n",
                  {"lists/list.toml:8", "--tolerance", "small"});
  expect_rejected(defaults + "[[pair]]\nwheel = \"none.prw\"\noutput = \"a.h5\"\n", {"lists/list.toml:5", "none.prw"});
  std::ofstream(folder_ / "lists/b.h5") << "not a table";
  expect_rejected(defaults + pair_a + pair_b, {"lists/list.toml:8", "b.h5"});
}

}  // namespace
}  // namespace railtab
