#pragma once

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

namespace railtab {

struct Outcome {
  int exit_code;  // 128 + signal where the program was killed
  std::string out, err;
};

inline std::string contents(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Runs the built tablegen in a folder of its own, which is gone afterwards.
class TablegenFixture : public ::testing::Test {
 protected:
  void SetUp() override {
    const ::testing::TestInfo& test = *::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(::testing::TempDir()) /
              (std::string(test.test_suite_name()) + "_" + std::string(test.name()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// scene.toml, a run on a rough track with checkpoints on its way, and its rough.csv.
  void write_long_scene(double duration) const {
    std::ofstream(folder_ / "scene.toml")
        << "[contact]\nnormal = \"rigid\"\n[track]\nkind = \"rigid\"\n[train]\nspeed = 50.0\n"
           "[irregularity]\nfile = \"rough.csv\"\n[integration]\nduration = "
        << std::fixed << duration << "\n[output]\nevery = 2\n";
    std::filesystem::copy_file(RAILTAB_SOURCE_DIR "/docs/examples/demo_irregularity.csv", folder_ / "rough.csv");
  }

  /// Of a process that wrote stdout.txt and stderr.txt, from what waitpid() says of it.
  [[nodiscard]] Outcome outcome(int status) const {
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), contents(folder_ / "stdout.txt"),
            contents(folder_ / "stderr.txt")};
  }
  [[nodiscard]] Outcome shell(const std::string& command) const {
    const std::string all = "cd '" + folder_.string() + "' && { " + command + "; } >stdout.txt 2>stderr.txt";
    return outcome(std::system(all.c_str()));
  }
  [[nodiscard]] Outcome tablegen(const std::string& arguments) const {
    return shell("'" TABLEGEN_COMMAND "' " + arguments);
  }

  /// Starts a program and kills it as soon as it is time. @returns true where it had not ended by then
  [[nodiscard]] bool killed_when(const char* program, const std::vector<std::string>& arguments,
                                 const std::function<bool()>& it_is_time) const {
    const pid_t child = started(program, arguments);
    int status = 0;
    bool ended = false;
    while (!it_is_time() && !ended) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      ended = waitpid(child, &status, WNOHANG) == child;
    }
    return ended ? by_signal(status) : killed(child);
  }
  [[nodiscard]] bool killed(const char* program, const std::vector<std::string>& arguments, double seconds) const {
    const pid_t child = started(program, arguments);
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
    return killed(child);
  }

  std::filesystem::path folder_;

 private:
  [[nodiscard]] pid_t started(const char* program, const std::vector<std::string>& arguments) const {
    std::vector<char*> argv{const_cast<char*>(program)};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    const pid_t child = fork();
    if (child == 0) {
      if (chdir(folder_.c_str()) == 0) execv(argv[0], argv.data());
      _exit(127);
    }
    return child;
  }
  [[nodiscard]] static bool killed(pid_t child) {
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    return by_signal(status);
  }
  /// A process that has ended by itself is to have done so well, and none has aborted before it was killed.
  [[nodiscard]] static bool by_signal(int status) {
    if (WIFSIGNALED(status)) {
      EXPECT_EQ(WTERMSIG(status), SIGKILL);
      return true;
    }
    EXPECT_EQ(WEXITSTATUS(status), 0);
    return false;
  }
};

}  // namespace railtab
