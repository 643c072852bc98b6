// The same input gives the same bits, whatever the number of threads.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "railtab/runtime/results/result_columns.hpp"
#include "railtab/runtime/results/result_file.hpp"
#include "railtab/tables/files/array_file.hpp"
#include "tablegen_fixture.hpp"

namespace railtab {
namespace {

class Determinism : public TablegenFixture {
 protected:
  void SetUp() override {
    TablegenFixture::SetUp();
    std::ofstream(folder_ / "scene.toml")
        << "[contact]\nmode = \"online\"\n[track]\nlength_before = 30.0\nlength_after = 15.0\n"
           "[[bridge]]\nlength = 10.0\nelements = 4\n[train]\nspeed = 50.0\nstart = 0.0\n[irregularity]\nspectrum = "
           "\"german-low\"\nfade_in = 0\nseed = 3\n[integration]\nduration = 0.05\n";
  }

  /// Runs the command with this number of threads for OpenMP.
  void run(const std::string& command, int threads) const {
    const std::string all = "cd '" + folder_.string() + "' && OMP_NUM_THREADS=" + std::to_string(threads) + " '" +
                            command + " >stdout.txt 2>stderr.txt";
    ASSERT_EQ(std::system(all.c_str()), 0) << command << '\n' << contents(folder_ / "stderr.txt");
  }

  /// Every history of two results, to the last bit.
  void expect_same_bits(const std::string& one, const std::string& other) const {
    SCOPED_TRACE(one + ", " + other);
    const ArrayFileReader a(folder_ / one, results_filetype, result_columns::format_version),
        b(folder_ / other, results_filetype, result_columns::format_version);
    int histories = 0;
    for (const std::string path : {"time",
                                   "position",
                                   "newton_iterations",
                                   "wheels/Q",
                                   "wheels/Y",
                                   "wheels/X",
                                   "wheels/patches",
                                   "wheels/y_rail",
                                   "wheels/y_wheel",
                                   "wheels/angle",
                                   "wheels/rolling_radius",
                                   "wheels/normal_force",
                                   "wheels/penetration",
                                   "wheels/second_y_rail",
                                   "wheels/second_normal_force",
                                   "bodies/displacement",
                                   "bodies/velocity",
                                   "bodies/acceleration",
                                   "nodes/displacement",
                                   "nodes/velocity",
                                   "nodes/acceleration"}) {
      const std::vector<double> x = a.read(path).values, y = b.read(path).values;
      ASSERT_EQ(x.size(), y.size()) << path;
      ASSERT_GT(x.size(), 0U) << path;
      EXPECT_EQ(std::memcmp(x.data(), y.data(), x.size() * sizeof(double)), 0) << path;
      ++histories;
    }
    EXPECT_EQ(histories, 21);
  }

  /// The summary of a sweep without the column run_time.
  [[nodiscard]] std::string summary(const std::string& folder) const {
    std::istringstream lines(contents(folder_ / folder / "summary.csv"));
    std::string text;
    std::size_t time_column = 0;
    for (std::string line; std::getline(lines, line);) {
      std::istringstream cells(line);
      std::size_t column = 0;
      for (std::string cell; std::getline(cells, cell, ','); ++column) {
        if (cell == "run_time[s]") time_column = column;
        if (column != time_column || time_column == 0) text += cell + ',';
      }
      text += '\n';
    }
    EXPECT_GT(time_column, 0U);
    return text;
  }
};

TEST_F(Determinism, TablesAreTheSameWithAnyThreads) {
  for (const std::string command :
       {"geometry --wheel cone-1:20 --rail 60E1 --lateral -0.002:0.002 --yaw 0:0.002 --tolerance 1e-6 -q ",
        "creep --nodes 5,5,5,8 --elements 12 -q "}) {
    const auto made = [&](const std::string& name, int threads) {
      const std::string file = command.substr(0, command.find(' ')) + "_" + name + ".h5";
      run(TABLEGEN_COMMAND "' " + command + "-o " + file, threads);
      return array_file_checksum(folder_ / file);
    };
    const std::string sum = made("one", 1);
    EXPECT_EQ(made("again", 1), sum) << command;
    EXPECT_EQ(made("two", 2), sum) << command;
  }
}

TEST_F(Determinism, ARunIsTheSameWithAnyThreads) {
  run(VSI_COMMAND "' run scene.toml -q -o one.h5", 1);
  run(VSI_COMMAND "' run scene.toml -q -o again.h5", 1);
  run(VSI_COMMAND "' run scene.toml -q -o two.h5 --threads 2", 2);
  expect_same_bits("one.h5", "again.h5");
  expect_same_bits("one.h5", "two.h5");
}

TEST_F(Determinism, ASweepIsTheSameWithAnyProcesses) {
  const std::string sweep = VSI_COMMAND "' sweep scene.toml --speed 40:50:10 --seeds 2 -q ";
  run(sweep + "--threads 1 -o one", 1);
  run(sweep + "--threads 2 -o two", 2);
  EXPECT_EQ(summary("one"), summary("two"));
  for (const std::string name : {"v040.000-s003", "v040.000-s004", "v050.000-s003", "v050.000-s004"}) {
    expect_same_bits("one/" + name + ".h5", "two/" + name + ".h5");
  }
}

}  // namespace
}  // namespace railtab
