// `vsi run --plan` names an upper bound of what the process of the run occupies, and not a far one.

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "vsi_fixture.hpp"

namespace railtab {
namespace {

// Sanitizers take memory of their own.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool instrumented = true;
#else
constexpr bool instrumented = false;
#endif

class PlanMemory : public VsiCommand {
 protected:
  void SetUp() override {
    VsiCommand::SetUp();
    if (instrumented) GTEST_SKIP() << "memory under a sanitizer is not the run's";
  }

  /// Peak resident memory of a run of scene.toml [bytes].
  [[nodiscard]] double peak() const {
    const pid_t child = fork();
    if (child == 0) {
      if (chdir(folder_.c_str()) != 0) _exit(127);
      execl(VSI_COMMAND, VSI_COMMAND, "run", "scene.toml", "--quiet", "-o", "results.h5", nullptr);
      _exit(127);
    }
    int status = 0;
    rusage usage{};
    EXPECT_EQ(wait4(child, &status, 0, &usage), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
    return 1024.0 * static_cast<double>(usage.ru_maxrss);
  }

  void expect_bound(const std::string& scene, double least_share) const {
    write("scene.toml", scene);
    const Outcome outcome = vsi("run scene.toml --plan --json");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
    const nlohmann::json plan = nlohmann::json::parse(outcome.output);
    const double taken = peak(), undivided = plan["memory_undivided_bytes"];
    std::printf("%s: peak %.1f MB of %.1f MB, results %.2f MB\n", plan["scene"].get<std::string>().c_str(),
                1e-6 * taken, 1e-6 * undivided, 1e-6 * plan["results_bytes"].get<double>());
    EXPECT_LE(taken, undivided);
    EXPECT_GE(taken, least_share * undivided);
    EXPECT_GE(plan["memory_bytes"].get<double>(), undivided);
    const auto results = static_cast<double>(std::filesystem::file_size(folder_ / "results.h5"));
    EXPECT_LE(results, plan["results_bytes"].get<double>());
    EXPECT_GE(results, 0.5 * plan["results_bytes"].get<double>());
  }
};

TEST_F(PlanMemory, BoundsARunOnRigidTrack) {
  expect_bound("name = \"rigid\"\n" + rigid_scene + "duration = 0.5\n", 0.5);
}

// Of twenty steps: most of it is the program and its libraries, whose pages the plan has not all touched.
TEST_F(PlanMemory, BoundsATinyRunClosely) {
  expect_bound("name = \"tiny\"\n" + rigid_scene + "time_step = 1e-3\nduration = 0.02\n", 0.8);
  expect_bound(
      "name = \"tinier\"\n[contact]\nnormal = \"rigid\"\n[track]\nkind = \"rigid\"\n[integration]\n"
      "time_step = 1e-3\nduration = 0.02\n",
      0.8);
}

constexpr const char* long_track =
    "[contact]\nnormal = \"rigid\"\n[track]\nlength_before = 2000.0\nlength_after = 2000.0\n"
    "[integration]\ntime_step = 1e-3\nduration = 0.02\n";

TEST_F(PlanMemory, BoundsARunOnALongTrackClosely) { expect_bound(std::string("name = \"long\"\n") + long_track, 0.6); }

// A step in a window reads the factor of the window, not of the line.
TEST_F(PlanMemory, CountsTheWindowAndNotTheLine) {
  const std::string windowed =
      std::string("name = \"window\"\n") + long_track + "[structure]\nreduction = \"window\"\n";
  expect_bound(windowed, 0.8);
  const auto reads = [&](const std::string& scene) {
    write("scene.toml", scene);
    return nlohmann::json::parse(vsi("run scene.toml --plan --json").output)["step_reads_bytes"].get<double>();
  };
  EXPECT_LT(reads(windowed), 0.1 * reads(long_track));
}

// The table of rail compliances goes with the train; what it leaves behind makes room for what lies ahead.
TEST_F(PlanMemory, BoundsARunWhoseTableOfCompliancesMoves) {
  expect_bound(
      "name = \"fine rails\"\n[train]\nspeed_kmh = 720\n[contact]\nmode = \"online\"\ncreep_law = \"polach\"\n"
      "[track]\nlength_before = 40.0\nlength_after = 40.0\nsleeper_spacing = 1.0\nelements_per_bay = 10\n"
      "[integration]\ntime_step = 1e-3\nduration = 0.12\ncontact_force = \"endpoint\"\n",
      0.8);
}

// A long train in 10⁹ steps: 130 TB.
TEST_F(PlanMemory, WarnsOfResultsThatTheDiskHasNoRoomFor) {
  write("scene.toml",
        "[train]\ncount = 64\n[contact]\nmode = \"online\"\ncreep_law = \"polach\"\n[track]\nkind = \"rigid\"\n"
        "[integration]\ntime_step = 1e-5\nduration = 1e4\n");
  const std::string warning = "output.every writes fewer records";
  const Outcome as_text = vsi("run scene.toml --plan"), as_json = vsi("run scene.toml --plan --json");
  EXPECT_NE(as_text.output.find(warning), std::string::npos) << as_text.output;
  ASSERT_EQ(as_json.exit_code, 0) << as_json.output;
  const nlohmann::json warnings = nlohmann::json::parse(as_json.output)["warnings"];
  EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), [&](const nlohmann::json& text) {
    return text.get<std::string>().find(warning) != std::string::npos;
  })) << as_json.output;

  // a run says so before its first step, here one that cannot begin
  write("scene.toml",
        "[train]\ncount = 4\n[contact]\nmode = \"online\"\ncreep_law = \"polach\"\ndimensions.flange_back = 1.5\n"
        "[track]\nkind = \"rigid\"\n[integration]\ntime_step = 1e-5\nduration = 1e4\n");
  const Outcome run = vsi("run scene.toml -o r.h5");
  EXPECT_EQ(run.exit_code, 1) << run.output;
  EXPECT_NE(run.output.find("vsi run: warning: the results take "), std::string::npos) << run.output;
  EXPECT_NE(run.output.find(warning), std::string::npos) << run.output;
}

}  // namespace
}  // namespace railtab
