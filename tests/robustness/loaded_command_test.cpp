// tablegen loaded and what vsi contact makes of it, by the commands.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <fstream>
#include <sstream>
#include <vector>

#include "railtab/tables/files/array_file.hpp"
#include "vsi_fixture.hpp"

namespace railtab {
namespace {

class LoadedCommand : public VsiCommand {
 protected:
  [[nodiscard]] Outcome tablegen(const std::string& arguments) const {
    return run(fmt::format("'{}' {}", TABLEGEN_COMMAND, arguments));
  }
  /// A geometry table of the tread only, t.h5.
  void make_table() const {
    const Outcome made =
        tablegen("geometry --wheel S1002 --rail 60E1 --lateral=-0.004:0.001 --yaw 0:0 --roll 0:0 --quiet -o t.h5");
    ASSERT_EQ(made.exit_code, 0) << made.output;
  }
  void add_loaded_part() const {
    const Outcome made = tablegen(
        "loaded t.h5 --lateral=-0.003:-0.001 --roll=-0.0005:0.0005 --yaw 0 --levels 9 --elements 12 "
        "--force-error 0.02 --light-error 0.05 --largest-load 150e3 --quiet");
    ASSERT_EQ(made.exit_code, 0) << made.output;
  }
  /// Kills `tablegen loaded` once a condition of the shell holds. @return columns of the file that it leaves
  [[nodiscard]] std::size_t columns_after_a_kill(const std::string& condition) const {
    const Outcome killed = run(
        fmt::format("{{ '{}' loaded t.h5 --lateral=-0.003:-0.001 --roll=-0.001:0.001 --levels 25 --elements 40 "
                    "--threads 1 --quiet & p=$!; until {}; do kill -0 $p || exit 1; sleep 0.01; done; kill -9 $p; }}",
                    TABLEGEN_COMMAND, condition));
    EXPECT_EQ(killed.exit_code, 0) << "not killed in time: " << killed.output;
    const ArrayFileReader file(folder_ / "t.h5.loaded-partial", "railtab-loaded-partial", 4);
    return file.read("columns").shape.at(0);
  }
  std::vector<std::vector<std::string>> rows(const std::string& file) const {
    std::ifstream in(folder_ / file);
    std::vector<std::vector<std::string>> table;
    for (std::string line; std::getline(in, line);) {
      std::istringstream cells(line);
      table.emplace_back();
      for (std::string cell; std::getline(cells, cell, ',');) table.back().push_back(cell);
    }
    return table;
  }
};

TEST_F(LoadedCommand, FirstTouchIsPartOfTheRange) {
  make_table();
  std::string queries = "y,yaw,roll,dz\n";
  constexpr int count = 60;
  for (int i = 0; i < count; ++i) {
    queries += fmt::format("{},0,0,0\n", -0.0035 + 7e-5 * i);
  }
  write("q.csv", queries);
  ASSERT_EQ(vsi("contact t.h5 --query q.csv -o r.csv --quiet").exit_code, 0);
  const auto table = rows("r.csv");
  std::array<bool, count> answered{};
  for (std::size_t i = 1; i < table.size(); ++i) {
    answered[std::stoul(table[i][0])] = true;
    EXPECT_LE(std::stod(table[i][9]), 1e-13);  // penetration
  }
  for (const bool found : answered) EXPECT_TRUE(found);
}

TEST_F(LoadedCommand, LoadsTotalsAndColumnsOfBothKindsOfTable) {
  make_table();
  write("load.csv", "y,yaw,roll,load\n-0.002,0,0,60e3\n-0.0018,0,0,20e3\n");
  for (const bool loaded : {false, true}) {
    if (loaded) add_loaded_part();
    ASSERT_EQ(vsi("contact t.h5 --query load.csv -o total.csv --total --quiet").exit_code, 0);
    const auto total = rows("total.csv");
    ASSERT_EQ(total.size(), 3U);
    EXPECT_EQ(total[0], (std::vector<std::string>{"query", "dz", "fy", "fz", "mx"}));
    EXPECT_NEAR(std::stod(total[1][3]), 60e3, 1e-3);
    EXPECT_NEAR(std::stod(total[2][3]), 20e3, 1e-3);
    EXPECT_GT(std::stod(total[1][2]), 0.0);  // a right rail is pushed to the field side
    // the moment about the rail-head origin is that of forces near it
    EXPECT_LT(std::abs(std::stod(total[1][4])), 0.03 * 60e3);
    write("dz.csv", fmt::format("y,yaw,roll,dz\n-0.002,0,0,{}\n-0.0018,0,0,{}\n", total[1][1], total[2][1]));
    std::filesystem::remove(folder_ / "patches.csv");
    ASSERT_EQ(vsi("contact t.h5 --query dz.csv -o patches.csv --quiet").exit_code, 0);
    const auto patches = rows("patches.csv");
    ASSERT_EQ(patches.size(), 3U);
    ASSERT_EQ(patches[0].size(), loaded ? 18U : 14U);
    if (!loaded) continue;
    for (std::size_t i = 1; i < 3; ++i) {
      const double angle = std::stod(patches[i][7]), N = std::stod(patches[i][14]);
      EXPECT_NEAR(N * std::cos(angle), std::stod(total[i][3]), 1e-3 * N);
      const double a = std::stod(patches[i][15]), b = std::stod(patches[i][16]);
      EXPECT_NEAR(std::stod(patches[i][17]), 1.5 * N / (3.14159265 * a * b), 0.1 * std::stod(patches[i][17]));
    }
  }
  // The approach under 60 kN: an ellipse per patch and the half-space solution agree on a tread.
  const Outcome info = tablegen("info t.h5");
  EXPECT_NE(info.output.find("loaded part"), std::string::npos) << info.output;
  const Outcome verified = tablegen("verify t.h5 --samples 200 --loaded-samples 20 --json --quiet");
  EXPECT_EQ(verified.exit_code, 0) << verified.output;
  EXPECT_NE(verified.output.find("\"light_force\""), std::string::npos) << verified.output;
}

// Killed ever later, from the moments in which a run takes up the file of the one before to those in which it adds to
// it.
TEST_F(LoadedCommand, KeepsColumnsThroughKills) {
  make_table();
  const std::size_t first = columns_after_a_kill("test -n \"$(find . -name t.h5.loaded-partial -size +50k)\"");
  ASSERT_GT(first, 0U);
  // The first file itself goes on: there is no moment between an earlier one and a copy of it.
  const std::string inode = run("stat -c %i t.h5.loaded-partial").output;
  std::size_t columns = first;
  for (double delay = 0.02; columns == first && delay < 20.0; delay *= 1.4) {
    const std::size_t kept = columns_after_a_kill(fmt::format("sleep {}", delay));
    ASSERT_GE(kept, columns) << "killed after " << delay << " s";
    EXPECT_EQ(run("stat -c %i t.h5.loaded-partial").output, inode);
    columns = kept;
  }
  EXPECT_GT(columns, first);
}

TEST_F(LoadedCommand, WrongInputIsSaid) {
  write("q.csv", "y,yaw,roll,load\n0,0,0,-5\n");
  make_table();
  expect_rejected("contact t.h5 --query q.csv -o out", "load = -5, expected above 0");
  const std::string expected = "expected the columns y,yaw,roll and one of dz and load, separated by commas";
  write("q.csv", "y,yaw,roll,dz,load\n0,0,0,1e-5,1\n");
  expect_rejected("contact t.h5 --query q.csv -o out", "q.csv:1: found columns dz and load, " + expected);
  write("q.csv", "y,yaw,roll\n0,0,0\n");
  expect_rejected("contact t.h5 --query q.csv -o out", "q.csv:1: found no column dz or load, " + expected);
  const auto rejected = [&](const std::string& arguments, const std::string& message) {
    const Outcome outcome = tablegen("loaded " + arguments);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.output;
    EXPECT_NE(outcome.output.find(message), std::string::npos) << outcome.output;
  };
  const Outcome none_loaded = tablegen("verify t.h5 --loaded-samples 5");
  EXPECT_EQ(none_loaded.exit_code, 2) << none_loaded.output;
  EXPECT_NE(none_loaded.output.find("--loaded-samples: found 5, expected a table with a loaded part"),
            std::string::npos)
      << none_loaded.output;
  rejected("absent.h5", "absent.h5");
  rejected("t.h5 --lateral 0.001:-0.001", "lateral");
  rejected("t.h5 --levels 2", "levels");
  rejected("t.h5 --yaw -1", "yaw");
  rejected("t.h5 --roll 0:0", "roll");
  add_loaded_part();
  const Outcome other_steel = tablegen("verify t.h5 --samples 100 --loaded-samples 5 --modulus 200e9");
  EXPECT_EQ(other_steel.exit_code, 2) << other_steel.output;
  EXPECT_NE(other_steel.output.find("--modulus, --poisson: found 200000000000 Pa, 0.28, expected those of the loaded"),
            std::string::npos)
      << other_steel.output;
  write("scene.toml",
        "[contact]\ntable = \"t.h5\"\nelastic = \"half-space\"\n[track]\nkind = \"rigid\"\n[integration]\nduration = "
        "0.1\n");
  make_table();
  expect_rejected("run scene.toml -o out", "a table with a loaded part (tablegen loaded adds it)");
}

}  // namespace
}  // namespace railtab
