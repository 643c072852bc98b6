// Real processes killed at random times, and outputs that cannot be written: what is left is whole, or says that it is
// not and can be gone on with. Creep generation has its own test (creep_command_test).

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/results/result_columns.hpp"
#include "railtab/runtime/results/result_file.hpp"
#include "railtab/tables/files/array_file.hpp"
#include "tablegen_fixture.hpp"

namespace railtab {
namespace {

namespace fs = std::filesystem;

class KilledProcess : public TablegenFixture {
 protected:
  void SetUp() override {
    TablegenFixture::SetUp();
    write_long_scene(8.0);
  }

  [[nodiscard]] Outcome vsi(const std::string& arguments) const { return shell("'" VSI_COMMAND "' " + arguments); }

  /// Time of a command from its start to its end [s].
  template <class Command>
  [[nodiscard]] static double seconds_of(const Command& command) {
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_EQ(command().exit_code, 0);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }

  std::mt19937 random_{20240131};
};

/// RAILTAB_KILLS for a longer search.
int kills() {
  const char* text = std::getenv("RAILTAB_KILLS");
  return text == nullptr ? 40 : std::atoi(text);
}

/// The first records of `whole`, to the last bit.
void expect_prefix(const RunResults& part, const RunResults& whole) {
  ASSERT_LE(part.steps.size(), whole.steps.size());
  for (std::size_t i = 0; i < part.steps.size(); ++i) {
    const StepRecord &a = part.steps[i], &b = whole.steps[i];
    ASSERT_EQ(a.time, b.time);
    for (std::size_t w = 0; w < a.wheels.size(); ++w) ASSERT_EQ(a.wheels[w].Q, b.wheels[w].Q) << "record " << i;
    for (std::size_t k = 0; k < a.bodies.size(); ++k) {
      for (int d = 0; d < 6; ++d) {
        ASSERT_EQ(a.bodies[k].displacement[d], b.bodies[k].displacement[d]) << "record " << i;
        ASSERT_EQ(a.bodies[k].acceleration[d], b.bodies[k].acceleration[d]) << "record " << i;
      }
    }
  }
}

TEST_F(KilledProcess, ARunGoesOnToTheSameBits) {
  const double whole = seconds_of([&] { return vsi("run scene.toml -o whole.h5 -q"); });
  ASSERT_EQ(vsi("run scene.toml -o again.h5 -q").exit_code, 0);
  const RunResults expected = read_results(folder_ / "whole.h5");
  const RunResults again = read_results(folder_ / "again.h5");
  ASSERT_EQ(again.steps.size(), expected.steps.size()) << "the same run twice";
  expect_prefix(again, expected);

  const fs::path file = folder_ / "r.h5";
  std::uniform_real_distribution<double> time(0.0, 0.7 * whole);
  int done = 0, left = 0;
  for (int tries = 0; done < kills() && tries < 3 * kills(); ++tries) {
    if (!killed(VSI_COMMAND, {"run", "scene.toml", "-o", "r.h5", "--resume", "-q"}, time(random_))) {
      expect_prefix(read_results(file), expected);
      fs::remove(file);
      continue;
    }
    ++done;
    if (!fs::exists(file)) continue;
    ++left;
    const RunResults part = read_results(file);
    EXPECT_FALSE(part.summary.complete && part.steps.size() < expected.steps.size());
    expect_prefix(part, expected);
    if (HasFailure()) FAIL() << "after kill " << done;
  }
  EXPECT_EQ(done, kills());
  EXPECT_GT(left, done / 4);
  ASSERT_EQ(vsi("run scene.toml -o r.h5 --resume -q").exit_code, 0);
  const RunResults last = read_results(file);
  EXPECT_TRUE(last.summary.complete);
  ASSERT_EQ(last.steps.size(), expected.steps.size());
  expect_prefix(last, expected);
  ASSERT_EQ(vsi("run scene.toml -o r.h5 -q").exit_code, 0);
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
    EXPECT_EQ(entry.path().filename().string().find(".part-"), std::string::npos) << entry.path();
  }
}

const std::string geometry =
    "geometry --wheel cone-1:20 --rail 60E1 --lateral -0.002:0.002 --yaw 0:0 --tolerance 1e-6 -q ";

TEST_F(KilledProcess, AGeometryTableIsWholeOrNotThereWithAnyThreads) {
  const double whole = seconds_of([&] { return tablegen(geometry + "--threads 2 -o whole.h5"); });
  ASSERT_EQ(tablegen(geometry + "--threads 1 -o one.h5").exit_code, 0);
  EXPECT_EQ(array_file_checksum(folder_ / "one.h5"), array_file_checksum(folder_ / "whole.h5"));
  std::uniform_real_distribution<double> time(0.0, 1.1 * whole);
  std::vector<std::string> arguments;
  for (std::size_t begin = 0, end = 0; (end = geometry.find(' ', begin)) != std::string::npos; begin = end + 1) {
    arguments.push_back(geometry.substr(begin, end - begin));
  }
  arguments.insert(arguments.end(), {"--threads", "2", "-o", "table.h5"});
  const int wanted = std::max(1, kills() / 4);
  int done = 0;
  for (int tries = 0; done < wanted && tries < 4 * wanted; ++tries) {
    done += killed(TABLEGEN_COMMAND, arguments, time(random_)) ? 1 : 0;
    if (!fs::exists(folder_ / "table.h5")) continue;
    EXPECT_EQ(array_file_checksum(folder_ / "table.h5"), array_file_checksum(folder_ / "whole.h5"));
    fs::remove(folder_ / "table.h5");
  }
  EXPECT_EQ(done, wanted);
}

TEST_F(KilledProcess, AMergedTableIsWholeOrNotThere) {
  ASSERT_EQ(tablegen(geometry + "--shard 1/2 -o a.h5").exit_code, 0);
  ASSERT_EQ(tablegen(geometry + "--shard 2/2 -o b.h5").exit_code, 0);
  // the least of three: a merge that waits for the disk would leave most kills behind the end of the others
  const auto merge = [&] { return tablegen("merge a.h5 b.h5 -o whole.h5 -q"); };
  const double whole = std::min({seconds_of(merge), seconds_of(merge), seconds_of(merge)});
  std::uniform_real_distribution<double> time(0.0, whole);
  int done = 0;
  for (int tries = 0; done < kills() && tries < 3 * kills(); ++tries) {
    done += killed(TABLEGEN_COMMAND, {"merge", "a.h5", "b.h5", "-o", "m.h5", "-q"}, time(random_)) ? 1 : 0;
    if (!fs::exists(folder_ / "m.h5")) continue;
    EXPECT_EQ(array_file_checksum(folder_ / "m.h5"), array_file_checksum(folder_ / "whole.h5"));
    fs::remove(folder_ / "m.h5");
  }
  EXPECT_EQ(done, kills());
}

TEST_F(KilledProcess, AFolderThatCannotBeWrittenIsSaidAtOnce) {
  // no one can create files there, root included
  const Outcome run = vsi("run scene.toml -o /proc/r.h5 -q");
  EXPECT_EQ(run.exit_code, 2) << run.err;
  EXPECT_NE(run.err.find("/proc/r.h5"), std::string::npos) << run.err;
  const Outcome table = tablegen(geometry + "-o /proc/t.h5");
  EXPECT_EQ(table.exit_code, 2) << table.err;
  EXPECT_NE(table.err.find("/proc/t.h5"), std::string::npos) << table.err;
}

// The file grows between the moments at which a reader looks at its size, at "records" and at the rows.
TEST_F(KilledProcess, ALiveRunCanBeReadAtAnyTime) {
  const fs::path file = folder_ / "r.h5";
  std::string scene = contents(folder_ / "scene.toml");
  scene.replace(scene.find("8.0"), 3, "60.0");
  std::ofstream(folder_ / "scene.toml") << scene;
  const pid_t child = fork();
  if (child == 0) {
    if (chdir(folder_.c_str()) == 0) execl(VSI_COMMAND, "vsi", "run", "scene.toml", "-o", "r.h5", "-q", nullptr);
    _exit(127);
  }
  std::size_t records = 0;
  int reads = 0, growths = 0, status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (!fs::exists(file)) continue;
    const ArrayFileReader live(file, results_filetype, result_columns::format_version);
    const std::size_t now = live.read("wheels/Q").shape.at(0);
    ASSERT_EQ(now, live.records());
    ASSERT_GE(now, records);
    growths += now > records ? 1 : 0;
    records = now;
    ++reads;
  }
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_GT(reads, 20);
  EXPECT_GT(growths, 5);
  const RunResults whole = read_results(file);
  EXPECT_TRUE(whole.summary.complete);
  EXPECT_GE(whole.steps.size(), records);
}

TEST_F(KilledProcess, ASecondRunOfOneNameIsRejected) {
  const Outcome both =
      shell("'" VSI_COMMAND
            "' run scene.toml -o r.h5 -q & first=$!; while [ ! -e r.h5 ] && kill -0 $first; do "
            "sleep 0.01; done; '" VSI_COMMAND "' run scene.toml -o r.h5 -q; code=$?; wait $first; exit $code$?");
  EXPECT_EQ(both.exit_code, 20) << "2 of the second, 0 of the first: " << both.err;
  EXPECT_NE(both.err.find("another run is writing"), std::string::npos) << both.err;
  EXPECT_TRUE(read_results(folder_ / "r.h5").summary.complete);
}

}  // namespace
}  // namespace railtab
