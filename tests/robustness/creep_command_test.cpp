#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "railtab/tables/files/creep_table_file.hpp"
#include "tablegen_fixture.hpp"

namespace railtab {
namespace {

namespace fs = std::filesystem;

class CreepCommand : public TablegenFixture {
 protected:
  void made(const std::string& arguments) const {
    const Outcome outcome = tablegen(arguments);
    ASSERT_EQ(outcome.exit_code, 0) << arguments << "\n" << outcome.err;
  }
  void expect_rejected(const std::string& arguments, const std::vector<std::string>& texts) const {
    const Outcome outcome = tablegen(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments << "\n" << outcome.err;
    for (const std::string& text : texts) {
      EXPECT_NE(outcome.err.find(text), std::string::npos) << arguments << "\n" << outcome.err << "\nlacks " << text;
    }
    EXPECT_FALSE(fs::exists(folder_ / "out.h5")) << arguments;
  }

  /// All but who made the tables and when.
  void expect_equal(const std::string& one, const std::string& other) const {
    const CreepTableData a = read_creep_table(folder_ / one), b = read_creep_table(folder_ / other);
    EXPECT_EQ(a.values, b.values);
    EXPECT_EQ(a.nodes, b.nodes);
    EXPECT_EQ(a.statistics, b.statistics);
    EXPECT_EQ(a.poisson, b.poisson);
    EXPECT_EQ(a.elements, b.elements);
  }
};

// 510 cases, a tenth of a second
const std::string small = "creep --nodes 5,5,5,8 --elements 12 ";

TEST_F(CreepCommand, KilledAtAnyTimeItGoesOnToTheSameBits) {
  const std::vector<std::string> arguments{"creep",   "--nodes",   "9,10,8,12", "--elements", "20",
                                           "--quiet", "--threads", "2",         "-o",         "killed.h5"};
  std::string command;
  for (const std::string& a : arguments) command += a + " ";
  const auto start = std::chrono::steady_clock::now();
  made(command.substr(0, command.find("-o")) + "-o whole.h5");
  const double whole = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

  std::mt19937 random(20241);
  std::uniform_real_distribution<double> share(0.15, 0.4);
  int kills = 0;
  bool partial_seen = false;
  while (kills < 4 && killed(TABLEGEN_COMMAND, arguments, 1e-3 + whole * share(random))) {
    ++kills;
    partial_seen = partial_seen || fs::exists(folder_ / "killed.h5.partial");
    EXPECT_FALSE(fs::exists(folder_ / "killed.h5")) << "an unfinished table has its final name";
  }
  EXPECT_GE(kills, 2);
  EXPECT_TRUE(partial_seen);
  if (!fs::exists(folder_ / "killed.h5")) {
    const Outcome last = tablegen(command + "--json");
    ASSERT_EQ(last.exit_code, 0) << last.err;
    const nlohmann::json j = nlohmann::json::parse(last.out);
    EXPECT_GT(j["cases_resumed"], 0);
    EXPECT_LE(j["cases_resumed"], j["cases"]);
  }
  expect_equal("whole.h5", "killed.h5");
  EXPECT_FALSE(fs::exists(folder_ / "killed.h5.partial"));
}

TEST_F(CreepCommand, ThreadsAndShardsDoNotChangeABit) {
  made(small + "--threads 1 -o one.h5");
  made(small + "--threads 3 -o three.h5");
  expect_equal("one.h5", "three.h5");
  for (const char* i : {"1", "2", "3"}) made(small + "--shard " + i + "/3 -o " + i + ".h5");
  made("merge 3.h5 1.h5 2.h5 -o merged.h5");
  expect_equal("one.h5", "merged.h5");
}

TEST_F(CreepCommand, ShardsThatDoNotBelongTogetherAreRejected) {
  for (const char* i : {"1", "2", "3"}) made(small + "--shard " + i + "/3 -o " + i + ".h5");
  expect_rejected("merge 1.h5 3.h5 -o out.h5", {"none with number 2", "1 to 3"});
  expect_rejected("merge 1.h5 2.h5 3.h5 2.h5 -o out.h5", {"2.h5", "shard 2/3", "already"});
  made(small + "--poisson 0.3 --shard 2/3 -o poisson.h5");
  expect_rejected("merge 1.h5 poisson.h5 3.h5 -o out.h5",
                  {"poisson.h5", "poisson: found 0.3, expected 0.28 as in 1.h5"});
  made(small + "--shard 2/4 -o four.h5");
  expect_rejected("merge 1.h5 four.h5 3.h5 -o out.h5", {"four.h5", "number of shards", "4", "3"});
  made("creep --nodes 5,5,5,9 --elements 12 --shard 2/3 -o nodes.h5");
  expect_rejected("merge 1.h5 nodes.h5 3.h5 -o out.h5", {"nodes.h5: nodes: found 5,5,5,9, expected 5,5,5,8"});
  made("creep --nodes 5,5,5,8 --elements 16 --shard 2/3 -o elements.h5");
  expect_rejected("merge 1.h5 elements.h5 3.h5 -o out.h5", {"elements.h5: elements: found 16, expected 12"});
  made(small + "-o whole.h5");
  expect_rejected("merge 1.h5 whole.h5 3.h5 -o out.h5", {"whole.h5", "a shard of a table"});
  expect_rejected("merge 1.h5 none.h5 3.h5 -o out.h5", {"none.h5"});
  fs::resize_file(folder_ / "2.h5", fs::file_size(folder_ / "2.h5") - 100);
  expect_rejected("merge 1.h5 2.h5 3.h5 -o out.h5", {"2.h5"});
  expect_rejected("merge 1.h5 2.h5 3.h5 -o 1.h5", {"1.h5", "a file that this command reads"});
  expect_rejected("merge -o out.h5", {"found no SHARD.h5"});
  for (const char* command : {"info", "verify"}) {
    expect_rejected(std::string(command) + " 1.h5", {"1.h5", "a shard of a creep table", "merge"});
  }
}

TEST_F(CreepCommand, APartialFileBelongsToItsJob) {
  const std::vector<std::string> long_job{"creep", "--quiet", "--shard", "2/5", "-o", "shard.h5"};
  ASSERT_TRUE(killed(TABLEGEN_COMMAND, long_job, 0.7));
  ASSERT_TRUE(fs::exists(folder_ / "shard.h5.partial"));
  expect_rejected("creep --shard 2/5 --poisson 0.3 -o shard.h5", {"shard.h5.partial: poisson: found 0.28", "0.3"});
  expect_rejected("creep --shard 3/5 -o shard.h5", {"shard.h5.partial: shard: found 2", "3"});
  expect_rejected("creep --layout paper --shard 2/5 -o shard.h5", {"shard.h5.partial: layout"});
  expect_rejected("creep -o shard.h5", {"shard.h5.partial: number of shards"});
  expect_rejected("merge shard.h5.partial -o out.h5", {"shard.h5.partial", "unfinished"});
  fs::resize_file(folder_ / "shard.h5.partial", 1000);
  expect_rejected("creep --shard 2/5 -o shard.h5", {"shard.h5.partial"});
}

TEST_F(CreepCommand, WrongOptions) {
  expect_rejected("creep", {"found no -o "});
  expect_rejected("creep -o none/out.h5", {"none"});
  expect_rejected("creep --poisson 0.6 -o out.h5", {"0.6", "0..0.5"});
  expect_rejected("creep --elements 41 -o out.h5", {"41", "even"});
  expect_rejected("creep --elements 4 -o out.h5", {"--elements"});
  expect_rejected("creep --layout fine -o out.h5", {"fine"});
  expect_rejected("creep --nodes 5,5,5 -o out.h5", {"--nodes", "5,5,5"});
  expect_rejected("creep --layout paper --nodes 5,5,5,8 -o out.h5", {"--nodes", "paper"});
  for (const char* wrong : {"0/3", "4/3", "1", "1/3/5", "a/3", "1.5/3"}) {
    expect_rejected(std::string("creep -o out.h5 --shard ") + wrong, {"--shard", "I/N"});
  }
}

}  // namespace
}  // namespace railtab
