// Outputs on a disk that gets full, by a limit of the size of files: the commands end with exit code 1 and a message
// that names the file, and what they leave is whole, or can be gone on with.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "railtab/runtime/results/result_file.hpp"
#include "railtab/tables/files/array_file.hpp"
#include "tablegen_fixture.hpp"

namespace railtab {
namespace {

namespace fs = std::filesystem;

/// RAILTAB_FULL_DISKS for a longer search.
int limits() {
  const char* text = std::getenv("RAILTAB_FULL_DISKS");
  return text == nullptr ? 12 : std::atoi(text);
}

class FullDisk : public TablegenFixture {
 protected:
  void SetUp() override {
    TablegenFixture::SetUp();
    write_long_scene(5.0);
  }

  /// The command where no file can grow beyond `bytes`; 0: with room.
  [[nodiscard]] Outcome run(const char* program, const std::string& arguments, rlim_t bytes = 0) const {
    std::istringstream stream(arguments);
    std::vector<std::string> words{std::istream_iterator<std::string>(stream), {}};
    std::vector<char*> argv{const_cast<char*>(program)};
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    const pid_t child = fork();
    if (child == 0) {
      if (chdir(folder_.c_str()) != 0 || !freopen("stdout.txt", "w", stdout) || !freopen("stderr.txt", "w", stderr)) {
        _exit(127);
      }
      std::signal(SIGXFSZ, SIG_IGN);  // a write beyond the limit fails instead
      const rlimit limit{bytes, bytes};
      if (bytes == 0 || setrlimit(RLIMIT_FSIZE, &limit) == 0) execv(program, argv.data());
      _exit(127);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return outcome(status);
  }

  /// Sizes up to that of `file`, which lack the most one after the other: any, and those just short of it.
  [[nodiscard]] std::vector<rlim_t> sizes_below(const fs::path& file) {
    const auto whole = static_cast<rlim_t>(fs::file_size(file));
    std::vector<rlim_t> sizes{whole - 1, whole - 4096, 8192, 4096};
    std::uniform_int_distribution<rlim_t> any(4096, whole - 1);
    while (static_cast<int>(sizes.size()) < limits()) sizes.push_back(any(random_));
    return sizes;
  }

  [[nodiscard]] std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_)) names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }

  static void expect_failure(const Outcome& outcome, const std::string& file) {
    EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
    EXPECT_NE(outcome.err.find(file), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("could not be written"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("File too large"), std::string::npos) << outcome.err;
  }

  std::mt19937 random_{20240131};
};

const std::string whole_run = "run scene.toml -q -o whole.h5", limited_run = "run scene.toml -q -o r.h5";

bool same_loads(const StepRecord& a, const StepRecord& b) {
  return a.time == b.time &&
         std::equal(a.wheels.begin(), a.wheels.end(), b.wheels.begin(), b.wheels.end(),
                    [](const WheelRecord& one, const WheelRecord& other) { return one.Q == other.Q; });
}

TEST_F(FullDisk, ARunKeepsItsLastCheckpointAndGoesOnToTheSameBits) {
  ASSERT_EQ(run(VSI_COMMAND, whole_run).exit_code, 0);
  const RunResults expected = read_results(folder_ / "whole.h5");
  int resumable = 0, left = 0;
  for (const rlim_t bytes : sizes_below(folder_ / "whole.h5")) {
    SCOPED_TRACE(bytes);
    fs::remove(folder_ / "r.h5");
    const Outcome ended = run(VSI_COMMAND, limited_run, bytes);
    expect_failure(ended, "r.h5");
    if (fs::exists(folder_ / "r.h5")) {
      ++left;
      const RunResults part = read_results(folder_ / "r.h5");
      EXPECT_FALSE(part.summary.complete);
      ASSERT_LE(part.steps.size(), expected.steps.size());
      EXPECT_TRUE(std::equal(part.steps.begin(), part.steps.end(), expected.steps.begin(), same_loads));
      const bool checkpoint = ResultWriter::read_checkpoint(folder_ / "r.h5").has_value();
      EXPECT_EQ(ended.err.find("--resume") != std::string::npos, checkpoint) << ended.err;
      resumable += checkpoint ? 1 : 0;
    }
    const Outcome last = run(VSI_COMMAND, limited_run + " --resume");
    ASSERT_EQ(last.exit_code, 0) << last.err;
    const RunResults results = read_results(folder_ / "r.h5");
    EXPECT_TRUE(results.summary.complete);
    ASSERT_EQ(results.steps.size(), expected.steps.size());
    EXPECT_TRUE(std::equal(results.steps.begin(), results.steps.end(), expected.steps.begin(), same_loads));
  }
  EXPECT_GE(resumable, limits() / 4);
  EXPECT_GE(left, limits() / 2);
}

const std::string geometry =
    "geometry --wheel cone-1:20 --rail 60E1 --lateral -0.002:0.002 --yaw 0:0 --tolerance 1e-6 -q ";

/// What is no table: "a.h5" and what a generation keeps to go on with may be left, no file of the writers' own.
bool of_a_writer(const std::string& name) {
  const std::size_t part = name.find(".part-");
  return part != std::string::npos && std::count(name.begin() + static_cast<long>(part), name.end(), '.') > 1;
}

TEST_F(FullDisk, AGeometryTableIsNotThere) {
  ASSERT_EQ(run(TABLEGEN_COMMAND, geometry + "-o whole.h5").exit_code, 0);
  for (const rlim_t bytes : {rlim_t{4096}, rlim_t{8192}, rlim_t{fs::file_size(folder_ / "whole.h5") - 1024}}) {
    SCOPED_TRACE(bytes);
    expect_failure(run(TABLEGEN_COMMAND, geometry + "-o t.h5", bytes), "t.h5");
    EXPECT_FALSE(fs::exists(folder_ / "t.h5"));
    const std::vector<std::string> names = files();
    EXPECT_EQ(std::count_if(names.begin(), names.end(), of_a_writer), 0) << ::testing::PrintToString(names);
  }
  ASSERT_EQ(run(TABLEGEN_COMMAND, geometry + "-o t.h5").exit_code, 0);
  EXPECT_EQ(array_file_checksum(folder_ / "t.h5"), array_file_checksum(folder_ / "whole.h5"));
}

TEST_F(FullDisk, AMergedTableAndThoseOfABatchAreNotThere) {
  ASSERT_EQ(run(TABLEGEN_COMMAND, geometry + "--shard 1/2 -o a.h5").exit_code, 0);
  ASSERT_EQ(run(TABLEGEN_COMMAND, geometry + "--shard 2/2 -o b.h5").exit_code, 0);
  expect_failure(run(TABLEGEN_COMMAND, "merge a.h5 b.h5 -o t.h5 -q", 8192), "t.h5");
  EXPECT_FALSE(fs::exists(folder_ / "t.h5"));

  std::ofstream(folder_ / "list.toml") << "[[pair]]\nwheel = \"cone-1:20\"\nrail = \"60E1\"\noutput = \"t.h5\"\n"
                                          "lateral = [-0.002, 0.002]\nyaw = \"0:0\"\n";
  expect_failure(run(TABLEGEN_COMMAND, "batch list.toml -q", 8192), "t.h5");
  EXPECT_FALSE(fs::exists(folder_ / "t.h5"));
}

TEST_F(FullDisk, ACreepTableGoesOnToTheSameBits) {
  const std::string creep = "creep --nodes 5,5,5,8 --elements 12 -q ";
  ASSERT_EQ(run(TABLEGEN_COMMAND, creep + "-o whole.h5").exit_code, 0);
  for (const rlim_t bytes : {rlim_t{4096}, rlim_t{8192}, rlim_t{fs::file_size(folder_ / "whole.h5") - 1024}}) {
    SCOPED_TRACE(bytes);
    expect_failure(run(TABLEGEN_COMMAND, creep + "-o t.h5", bytes), "t.h5");
    EXPECT_FALSE(fs::exists(folder_ / "t.h5"));
    ASSERT_EQ(run(TABLEGEN_COMMAND, creep + "-o t.h5").exit_code, 0);
    EXPECT_EQ(array_file_checksum(folder_ / "t.h5"), array_file_checksum(folder_ / "whole.h5"));
    fs::remove(folder_ / "t.h5");
  }
}

TEST_F(FullDisk, RunsOfASweepAreMadeWhenThereIsRoomAgain) {
  const std::string sweep = "sweep scene.toml --speed 40:50:10 -q -o runs";
  const Outcome ended = run(VSI_COMMAND, sweep, 200000);
  EXPECT_EQ(ended.exit_code, 1) << ended.err;
  EXPECT_NE(ended.err.find("v040.000.h5: could not be written"), std::string::npos) << ended.err;
  EXPECT_FALSE(fs::exists(folder_ / "runs/v040.000.row"));
  ASSERT_EQ(run(VSI_COMMAND, sweep).exit_code, 0);
  EXPECT_TRUE(read_results(folder_ / "runs/v050.000.h5").summary.complete);
}

// A page and a query's answer.
TEST_F(FullDisk, TextIsWholeOrNotThere) {
  ASSERT_EQ(run(VSI_COMMAND, "run scene.toml -q -o whole.h5").exit_code, 0);
  expect_failure(run(VSI_COMMAND, "report whole.h5 -q -o page.html", 8192), "page.html");
  EXPECT_FALSE(fs::exists(folder_ / "page.html"));
  for (const std::string& name : files()) EXPECT_EQ(name.find(".part"), std::string::npos) << name;
}

}  // namespace
}  // namespace railtab
