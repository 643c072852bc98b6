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

  [[nodiscard]] Outcome tablegen(const std::string& arguments) const {
    const std::string command =
        "cd '" + folder_.string() + "' && '" TABLEGEN_COMMAND "' " + arguments + " >stdout.txt 2>stderr.txt";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), contents(folder_ / "stdout.txt"),
            contents(folder_ / "stderr.txt")};
  }

  /// Starts the command and kills it as soon as it is time. @returns true where it had not ended by then
  [[nodiscard]] bool killed_when(const std::vector<std::string>& arguments,
                                 const std::function<bool()>& it_is_time) const {
    std::vector<char*> argv{const_cast<char*>(TABLEGEN_COMMAND)};
    for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
    argv.push_back(nullptr);
    const pid_t child = fork();
    if (child == 0) {
      if (chdir(folder_.c_str()) == 0) execv(argv[0], argv.data());
      _exit(127);
    }
    int status = 0;
    bool ended = false;
    while (!it_is_time() && !ended) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      ended = waitpid(child, &status, WNOHANG) == child;
    }
    if (!ended) {
      kill(child, SIGKILL);
      waitpid(child, &status, 0);
    }
    if (WIFSIGNALED(status)) return true;
    EXPECT_EQ(WEXITSTATUS(status), 0);
    return false;
  }

  [[nodiscard]] bool killed(const std::vector<std::string>& arguments, std::chrono::milliseconds after) const {
    const auto end = std::chrono::steady_clock::now() + after;
    return killed_when(arguments, [end] { return std::chrono::steady_clock::now() >= end; });
  }

  std::filesystem::path folder_;
};

}  // namespace railtab
