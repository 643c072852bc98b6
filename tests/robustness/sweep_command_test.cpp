// Runs that are killed and resumed, and sweeps of them.

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
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "../folder_fixture.hpp"
#include "railtab/runtime/results/result_file.hpp"

namespace {

namespace fs = std::filesystem;
using railtab::RunResults;

class SweepCommand : public railtab::testing::InFolder {
 protected:
  [[nodiscard]] pid_t start(const std::vector<std::string>& arguments) const {
    const pid_t process = fork();
    if (process != 0) return process;
    if (chdir(folder_.c_str()) != 0 || !freopen("/dev/null", "w", stdout) || !freopen("log", "a", stderr)) _exit(99);
    std::vector<char*> argv{const_cast<char*>("vsi")};
    for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
    argv.push_back(nullptr);
    execv(VSI_COMMAND, argv.data());
    _exit(98);
  }
  /// Exit code, or 128 + signal.
  static int wait(pid_t process) {
    int status = 0;
    waitpid(process, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  [[nodiscard]] int vsi(const std::vector<std::string>& arguments) const { return wait(start(arguments)); }

  [[nodiscard]] std::string text(const std::string& name) const {
    std::ostringstream content;
    content << std::ifstream(folder_ / name).rdbuf();
    return content.str();
  }
};

bool same_motion(const railtab::MotionRecord& a, const railtab::MotionRecord& b) {
  for (int k = 0; k < 6; ++k) {
    if (a.displacement[k] != b.displacement[k] || a.velocity[k] != b.velocity[k] ||
        a.acceleration[k] != b.acceleration[k])
      return false;
  }
  return true;
}

void expect_same(const RunResults& a, const RunResults& b) {
  ASSERT_EQ(a.steps.size(), b.steps.size());
  for (std::size_t i = 0; i < a.steps.size(); ++i) {
    ASSERT_EQ(a.steps[i].time, b.steps[i].time);
    for (std::size_t w = 0; w < a.steps[i].wheels.size(); ++w)
      ASSERT_EQ(a.steps[i].wheels[w].Q, b.steps[i].wheels[w].Q) << "record " << i;
    for (std::size_t k = 0; k < a.steps[i].bodies.size(); ++k)
      ASSERT_TRUE(same_motion(a.steps[i].bodies[k], b.steps[i].bodies[k])) << "record " << i;
    for (std::size_t k = 0; k < a.steps[i].nodes.size(); ++k)
      ASSERT_TRUE(same_motion(a.steps[i].nodes[k], b.steps[i].nodes[k])) << "record " << i;
  }
}

// Ten kills at random moments, each followed by a run that goes on: set-up, steps and the writing of checkpoints are
// all hit. The result is that of a run which nobody disturbed, to the last bit; so it is with a moving window.
class KilledRun : public SweepCommand, public ::testing::WithParamInterface<const char*> {};

TEST_P(KilledRun, ResumesToTheLastBit) {
  write("scene.toml", std::string("[train]\nspeed = 30.0\nstart = -2.0\n[contact]\nnormal = \"rigid\"\n"
                                  "[track]\nlength_before = 40.0\nlength_after = 200.0\n"
                                  "[[bridge]]\nlength = 12.0\nelements = 12\ncount = 3\n"
                                  "[irregularity]\nspectrum = \"german-low\"\nfade_in = 0\n"
                                  "[integration]\nduration = 3.0\n[output]\nevery = 7\n[structure]\nreduction = \"") +
                          GetParam() + "\"\nwindow_ahead = 8.0\nwindow_behind = 8.0\n");
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(vsi({"run", "scene.toml", "-o", "whole.h5", "--quiet"}), 0) << text("log");
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> share(0.05, 0.6);
  int killed = 0;
  for (int k = 0; k < 10; ++k) {
    const pid_t process = start({"run", "scene.toml", "-o", "killed.h5", "--quiet", "--resume"});
    std::this_thread::sleep_for(share(generator) * took);
    kill(process, SIGKILL);
    if (wait(process) == 128 + SIGKILL) ++killed;
  }
  ASSERT_EQ(vsi({"run", "scene.toml", "-o", "killed.h5", "--quiet", "--resume"}), 0) << text("log");
  EXPECT_GE(killed, 3) << "the kills came too late to say anything";
  expect_same(railtab::read_results(folder_ / "killed.h5"), railtab::read_results(folder_ / "whole.h5"));
}
INSTANTIATE_TEST_SUITE_P(Reductions, KilledRun, ::testing::Values("none", "window"),
                         [](const auto& instance) { return std::string(instance.param); });

constexpr const char* scene = R"([contact]
mode = "online"
[track]
kind = "rigid"
[irregularity]
spectrum = "german-low"
fade_in = 0
[integration]
duration = 0.3
[output]
every = 5
wheels = true
bodies = ["*/car-body"]
)";

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

// All but the run time, which is the last column but one.
std::string numbers_of(const std::string& line) {
  const std::size_t message = line.rfind(',');
  return line.substr(0, line.rfind(',', message - 1));
}

TEST_F(SweepCommand, RunsOfOneNameAreRejectedBeforeTheFirst) {
  write("scene.toml", scene);
  EXPECT_EQ(vsi({"sweep", "scene.toml", "--speed", "50:50.0004:0.0004", "--seeds", "2", "-o", "close"}), 2);
  EXPECT_NE(text("log").find("speeds: found two runs of the name v050.000-s001, expected steps of at least 0.001 m/s"),
            std::string::npos)
      << text("log");
  EXPECT_FALSE(fs::exists(folder_ / "close/v050.000-s001.h5"));
}

TEST_F(SweepCommand, ShardsAndAKillMakeTheSameSummary) {
  write("scene.toml", scene);
  const std::vector<std::string> sweep{"sweep", "scene.toml", "--speed-kmh", "100:200:50", "--seeds", "2", "--quiet"};
  const auto with = [&](std::vector<std::string> more) {
    std::vector<std::string> all = sweep;
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  ASSERT_EQ(vsi(with({"-o", "whole"})), 0) << text("log");
  const std::vector<std::string> whole = lines_of(text("whole/summary.csv"));
  ASSERT_EQ(whole.size(), 7U);
  EXPECT_TRUE(whole[1].starts_with("v027.778-s001,27.7778,100,1,1,")) << whole[1];
  EXPECT_TRUE(whole[6].starts_with("v055.556-s002,")) << whole[6];
  EXPECT_NE(numbers_of(whole[1]).substr(20), numbers_of(whole[2]).substr(20)) << "two seeds, one track";

  const pid_t process = start(with({"-o", "parts", "--shard", "1/2", "--threads", "1"}));
  std::this_thread::sleep_for(std::chrono::milliseconds(400));
  kill(process, SIGKILL);
  wait(process);
  for (const char* shard : {"1/2", "2/2"}) ASSERT_EQ(vsi(with({"-o", "parts", "--shard", shard})), 0) << text("log");
  EXPECT_FALSE(fs::exists(folder_ / "parts/summary.csv"));
  const auto written = fs::last_write_time(folder_ / "parts/v027.778-s001.h5");
  ASSERT_EQ(vsi(with({"-o", "parts"})), 0) << text("log");
  EXPECT_EQ(fs::last_write_time(folder_ / "parts/v027.778-s001.h5"), written) << "a finished run was run again";
  const std::vector<std::string> parts = lines_of(text("parts/summary.csv"));
  ASSERT_EQ(parts.size(), whole.size());
  for (std::size_t i = 0; i < whole.size(); ++i) EXPECT_EQ(numbers_of(parts[i]), numbers_of(whole[i]));

  const RunResults one = railtab::read_results(folder_ / "whole/v027.778-s001.h5");
  EXPECT_EQ(one.header.body_names, (std::vector<std::string>{"coach-1/car-body"}));
  EXPECT_NE(one.header.scene_text.find("# vsi sweep: train.speed = 27.77"), std::string::npos);
}

// Rows alone are those of runs with results. Results that are there stay, and a later sweep can add them.
TEST_F(SweepCommand, SummaryOnlyHasTheSameRows) {
  write("scene.toml", scene);
  const auto sweep = [&](const std::string& folder, const std::vector<std::string>& more) {
    std::vector<std::string> all{"sweep", "scene.toml", "--speed-kmh", "100:150:50", "-o", folder, "--quiet"};
    all.insert(all.end(), more.begin(), more.end());
    return vsi(all);
  };
  ASSERT_EQ(sweep("whole", {}), 0) << text("log");
  ASSERT_EQ(sweep("rows", {"--summary-only"}), 0) << text("log");
  const std::vector<std::string> whole = lines_of(text("whole/summary.csv")), rows = lines_of(text("rows/summary.csv"));
  ASSERT_EQ(whole.size(), 3U);
  ASSERT_EQ(rows.size(), whole.size());
  for (std::size_t i = 0; i < whole.size(); ++i) EXPECT_EQ(numbers_of(rows[i]), numbers_of(whole[i]));
  EXPECT_FALSE(fs::exists(folder_ / "rows/v027.778-s001.h5"));

  ASSERT_EQ(sweep("whole", {"--summary-only"}), 0) << text("log");
  EXPECT_TRUE(fs::exists(folder_ / "whole/v027.778-s001.h5")) << "results were removed";
  ASSERT_EQ(sweep("rows", {}), 0) << text("log");
  EXPECT_TRUE(fs::exists(folder_ / "rows/v027.778-s001.h5"));
  EXPECT_EQ(numbers_of(lines_of(text("rows/summary.csv"))[2]), numbers_of(whole[2]));
}

// A wind that lifts the train off its rails is an answer, which the summary has to give.
TEST_F(SweepCommand, ATrainThatDerailsHasItsRow) {
  write("storm.toml",
        "[contact]\nmode = \"online\"\n[track]\nkind = \"rigid\"\n[integration]\nduration = 3.0\n"
        "[[load]]\nFy = 3e5\nMx = 6e5\nstart = 0.05\ngust_duration = 4.0\n");
  EXPECT_EQ(vsi({"sweep", "storm.toml", "--speed", "40", "-o", "out", "--quiet"}), 1);
  const std::vector<std::string> rows = lines_of(text("out/summary.csv"));
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_TRUE(rows[1].starts_with("v040.000,40,144,0,0,")) << rows[1];
  EXPECT_NE(rows[1].find("has left the rails"), std::string::npos) << rows[1];
  const auto written = fs::last_write_time(folder_ / "out/v040.000.h5");
  EXPECT_EQ(vsi({"sweep", "storm.toml", "--speed", "40", "-o", "out", "--quiet"}), 1);
  EXPECT_EQ(fs::last_write_time(folder_ / "out/v040.000.h5"), written) << "what has ended was run again";

  write("out/v040.000.row", "v040.000,40,144,0,1,\n");
  EXPECT_EQ(vsi({"sweep", "storm.toml", "--speed", "40", "-o", "out", "--quiet"}), 2);
  EXPECT_NE(text("log").find("v040.000.row: found no row of this run"), std::string::npos) << text("log");
}

// What is missing or damaged in a sweep's folder is made again, and no row is believed without its numbers.
TEST_F(SweepCommand, MissingAndDamagedResultsAreMadeAgain) {
  write("smooth.toml", "[contact]\nmode = \"online\"\n[track]\nkind = \"rigid\"\n[integration]\nduration = 0.02\n");
  const std::vector<std::string> sweep{"sweep", "smooth.toml", "--speed", "30", "-o", "out", "--quiet"};
  ASSERT_EQ(vsi(sweep), 0) << text("log");
  const std::string row = text("out/v030.000.row");
  fs::remove(folder_ / "out/v030.000.h5");
  ASSERT_EQ(vsi(sweep), 0) << text("log");
  EXPECT_TRUE(fs::exists(folder_ / "out/v030.000.h5")) << "a run without its results counted as finished";
  EXPECT_EQ(numbers_of(text("out/v030.000.row")), numbers_of(row));

  fs::remove(folder_ / "out/v030.000.row");
  fs::resize_file(folder_ / "out/v030.000.h5", fs::file_size(folder_ / "out/v030.000.h5") / 2);
  ASSERT_EQ(vsi(sweep), 0) << text("log");
  EXPECT_NE(text("log").find("v030.000.h5 is set aside as v030.000.h5.damaged"), std::string::npos);
  EXPECT_TRUE(fs::exists(folder_ / "out/v030.000.h5.damaged"));
  EXPECT_EQ(numbers_of(text("out/v030.000.row")), numbers_of(row));
  const std::string row_with_times = text("out/v030.000.row");

  // changed bytes beside a good row, where the file is full of numbers: what no dataset uses may be anything
  std::string bytes = text("out/v030.000.h5");
  constexpr std::ptrdiff_t block = 2000;
  const auto filled = [&](std::ptrdiff_t from) {
    return block - std::count(bytes.begin() + from, bytes.begin() + from + block, '\0');
  };
  std::ptrdiff_t densest = 0;
  for (std::ptrdiff_t at = block; at + block <= std::ssize(bytes); at += block)
    if (filled(at) > filled(densest)) densest = at;
  for (std::ptrdiff_t k = densest; k < densest + block; ++k) {
    char& byte = bytes[static_cast<std::size_t>(k)];
    byte = static_cast<char>(~byte);
  }
  write("out/v030.000.h5", bytes);
  ASSERT_EQ(vsi(sweep), 0) << text("log");
  EXPECT_EQ(text("out/v030.000.h5.damaged-2"), bytes);
  EXPECT_EQ(text("out/v030.000.row.damaged"), row_with_times);
  EXPECT_EQ(numbers_of(text("out/v030.000.row")), numbers_of(row));

  // results of another run, with and without a row beside them
  ASSERT_EQ(vsi({"run", "smooth.toml", "-o", "other.h5", "--quiet"}), 0) << text("log");
  for (const char* aside : {"out/v030.000.h5.other", "out/v030.000.h5.other-2"}) {
    write("out/v030.000.h5", text("other.h5"));
    ASSERT_EQ(vsi(sweep), 0) << text("log");
    EXPECT_EQ(text(aside), text("other.h5")) << text("log");
    EXPECT_EQ(numbers_of(text("out/v030.000.row")), numbers_of(row));
    fs::remove(folder_ / "out/v030.000.row");
  }
  ASSERT_EQ(vsi(sweep), 0) << text("log");

  const std::string whole = text("out/v030.000.row");
  for (const char* wrong : {"nan", "many", "1e", "0.5.0"}) {
    std::string changed = whole;
    const std::size_t begin = changed.find(",1,") + 3;  // the first number after `complete`; may be empty
    changed.replace(begin, changed.find(',', begin) - begin, wrong);
    write("out/v030.000.row", changed);
    EXPECT_EQ(vsi(sweep), 2) << wrong;
  }
  EXPECT_NE(text("log").find("v030.000.row: found no row of this run"), std::string::npos) << text("log");
}

// What killed processes left, also of runs that are finished and of which nothing is written any more.
TEST_F(SweepCommand, LeftOversOfItsOutputsGo) {
  write("smooth.toml", "[contact]\nmode = \"online\"\n[track]\nkind = \"rigid\"\n[integration]\nduration = 0.02\n");
  const std::vector<std::string> sweep{"sweep", "smooth.toml", "--speed", "30", "-o", "out", "--quiet"};
  ASSERT_EQ(vsi(sweep), 0) << text("log");
  const std::vector<std::string> outputs{"out/v030.000.h5", "out/v030.000.row", "out/summary.csv", "out/scene.toml"};
  for (const std::string& output : outputs) write(output + ".part-abcdefghijkl", "unfinished");
  write("out/notes.txt.part-abcdefghijkl", "somebody's");
  ASSERT_EQ(vsi(sweep), 0) << text("log");
  for (const std::string& output : outputs)
    EXPECT_FALSE(fs::exists(folder_ / (output + ".part-abcdefghijkl"))) << output;
  EXPECT_TRUE(fs::exists(folder_ / "out/notes.txt.part-abcdefghijkl"));
}

// A train that stands beside its track: only the model shows it, which each run builds for itself.
TEST_F(SweepCommand, InputThatIsWrongForAllRunsIsNamedOnce) {
  write("beside.toml", "[train]\nstart = -1000.0\n[contact]\nmode = \"online\"\n[integration]\nduration = 0.1\n");
  EXPECT_EQ(vsi({"sweep", "beside.toml", "--speed", "10:40:1", "--threads", "1", "-o", "out"}), 2) << text("log");
  const std::string log = text("log"), message = "train.start";
  const std::size_t first = log.find(message);
  ASSERT_NE(first, std::string::npos) << log;
  EXPECT_EQ(log.find(message, first + 1), std::string::npos) << log;
}

// Two sweeps into one folder: what one of them is computing is no wrong input of the other, which takes the next run.
TEST_F(SweepCommand, ASecondOneTakesOtherRuns) {
  write("long.toml",
        "[contact]\nmode = \"online\"\n[track]\nkind = \"rigid\"\n[integration]\nduration = 20\n"
        "[output]\nevery = 100000\n");
  const std::vector<std::string> command{"sweep", "long.toml", "--speed", "30:31:1", "--threads", "1", "-o", "out"};
  const pid_t first = start(command);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!fs::exists(folder_ / "out/v030.000.h5") && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  const int second = vsi(command);
  EXPECT_LE(second, 1) << text("log");
  EXPECT_LE(wait(first), 1) << text("log");
  EXPECT_NE(text("log").find("v030.000.h5: found a file that another run is writing"), std::string::npos)
      << text("log");
  EXPECT_EQ(vsi(command), 0) << text("log");
  const std::string summary = text("out/summary.csv");
  EXPECT_EQ(std::count(summary.begin(), summary.end(), '\n'), 3) << summary;
}

// Ctrl-C that the pool alone is told of ends the runs of its workers too, each with a checkpoint.
TEST_F(SweepCommand, AnInterruptEndsTheRunsInProgress) {
  write("long.toml",
        "[contact]\nmode = \"online\"\n[track]\nkind = \"rigid\"\n[integration]\nduration = 2000\n"
        "[output]\nevery = 100000\n");
  const pid_t process = start({"sweep", "long.toml", "--speed", "30:32:1", "--threads", "2", "-o", "out"});
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  const auto in_time = [&] { return std::chrono::steady_clock::now() < deadline; };
  const auto pause = [] { std::this_thread::sleep_for(std::chrono::milliseconds(20)); };
  while (!fs::exists(folder_ / "out/v031.000.h5") && in_time()) pause();
  kill(process, SIGINT);
  int status = 0;
  pid_t ended = 0;
  while ((ended = waitpid(process, &status, WNOHANG)) == 0 && in_time()) pause();
  if (ended == 0) kill(process, SIGKILL);
  ASSERT_EQ(ended, process) << "runs went on";
  EXPECT_EQ(WEXITSTATUS(status), 130);
  EXPECT_EQ(text("log"), "vsi sweep: interrupted; the same command goes on\n");
  EXPECT_FALSE(fs::exists(folder_ / "out/v031.000.row"));
  EXPECT_FALSE(fs::exists(folder_ / "out/v032.000.h5")) << "another run was begun";
  EXPECT_TRUE(railtab::ResultWriter::read_checkpoint(folder_ / "out/v031.000.h5").has_value());
}

// Each warning once, however many runs have it; those of finished runs are told again.
TEST_F(SweepCommand, WarningsOfItsRuns) {
  write("smooth.toml",
        "[contact]\nmode = \"online\"\n[track]\nkind = \"rigid\"\n[integration]\nduration = 0.02\n"
        "[[load]]\nFy = 1.0\nstart = 30\ngust_duration = 4\n");
  const std::string warning = "vsi sweep: warning: [[load]] 1 of 1 is specified for t = 30 to 34 s";
  for (int times = 1; times <= 3; ++times) {
    if (times == 3) {  // as after a kill between results and row
      for (const std::string run : {"v030.000", "v031.000", "v032.000"}) {
        ASSERT_TRUE(fs::remove(folder_ / "out" / (run + ".row")));
        ASSERT_TRUE(fs::remove(folder_ / "out" / (run + ".warnings")));
      }
    }
    ASSERT_EQ(vsi({"sweep", "smooth.toml", "--speed", "30:32:1", "-o", "out"}), 0) << text("log");
    const std::vector<std::string> log = lines_of(text("log"));
    ASSERT_EQ(log.size(), std::size_t(times)) << text("log");
    EXPECT_TRUE(log.back().starts_with(warning)) << log.back();
    EXPECT_TRUE(log.back().ends_with(" (run v030.000, and alike in 2 more)")) << log.back();
  }
  EXPECT_EQ(vsi({"sweep", "smooth.toml", "--speed", "33", "-o", "out"}), 0);
  EXPECT_NE(text("log").find("vsi sweep: note: 3 finished runs of other speeds or seeds in this folder are not in "
                             "summary.csv\n"),
            std::string::npos)
      << text("log");
  EXPECT_EQ(lines_of(text("out/summary.csv")).size(), 2U);
}

TEST_F(SweepCommand, RejectsWhatMakesNoSweep) {
  write("scene.toml", scene);
  write("smooth.toml", "[contact]\nmode = \"online\"\n[track]\nkind = \"rigid\"\n[integration]\nduration = 0.1\n");
  write("v.csv", "t[s],V[m/s]\n0,30\n12,40\n");
  write("faster.toml", std::string("[train]\nspeed_file = \"v.csv\"\n") + scene);
  const auto named = [&](const std::vector<std::string>& arguments, const std::string& message) {
    EXPECT_EQ(vsi(arguments), 2);
    EXPECT_NE(text("log").find(message), std::string::npos) << message << "\n" << text("log");
  };
  named({"sweep", "scene.toml", "--speed-kmh", "0", "-o", "out"},
        "--speed-kmh: found 0, expected 0.0036 to 720 km/h\n");
  named({"sweep", "scene.toml", "--speed-kmh", "100:2000:500", "-o", "out"}, "--speed-kmh: found 1100, expected");
  named({"sweep", "faster.toml", "--speed-kmh", "100", "-o", "out"},
        "--speed-kmh: found a scene with train.speed_file, expected");
  const auto rejected = [&](const std::vector<std::string>& arguments) { EXPECT_EQ(vsi(arguments), 2) << text("log"); };
  rejected({"sweep", "scene.toml", "-o", "out"});
  rejected({"sweep", "scene.toml", "--speed", "10:20", "-o", "out"});
  rejected({"sweep", "scene.toml", "--speed", "20:10:1", "-o", "out"});
  rejected({"sweep", "scene.toml", "--speed", "10:20:0", "-o", "out"});
  rejected({"sweep", "scene.toml", "--speed", "300", "-o", "out"});
  rejected({"sweep", "scene.toml", "--speed", "30", "--speed-kmh", "100", "-o", "out"});
  rejected({"sweep", "scene.toml", "--speed", "30", "--shard", "3/2", "-o", "out"});
  rejected({"sweep", "smooth.toml", "--speed", "30", "--seeds", "2", "-o", "out"});
  rejected({"sweep", "scene.toml", "--speed", "30", "--seeds", "2147483647", "-o", "out"});
  rejected({"sweep", "smooth.toml", "--speed", "30", "-o", "none/out"});
  EXPECT_FALSE(fs::exists(folder_ / "out"));
  EXPECT_FALSE(fs::exists(folder_ / "none"));
  const std::string too_long(300, 'f');
  named({"sweep", "scene.toml", "--speed", "30", "-o", too_long},
        "-o: found " + too_long + ": File name too long, expected a folder that can be created");
  named({"sweep", "scene.toml", "--speed", "30", "-o", too_long + "/out"}, "-o: found no folder ");
  named({"sweep", "scene.toml", "--speed", "30", "-o", "."},
        "-o .: found the scene itself, ./scene.toml, in this folder, expected another folder");
  ASSERT_EQ(vsi({"sweep", "smooth.toml", "--speed", "30", "-o", "out", "--quiet"}), 0) << text("log");
  named({"sweep", "scene.toml", "--speed", "30", "-o", "out"},
        "out/scene.toml: found another scene, expected that of the runs in this folder, or another folder for -o; line "
        "5 was '[integration]' and is '[irregularity]'\n");
}

}  // namespace
