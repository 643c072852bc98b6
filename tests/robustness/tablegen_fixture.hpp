#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

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

  std::filesystem::path folder_;
};

}  // namespace railtab
