#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "../folder_fixture.hpp"

namespace railtab {

struct Outcome {
  int exit_code;  // 128 + signal where the program was killed
  std::string output;
};

/// Runs the built vsi in a folder of its own; stdout and stderr together.
class VsiCommand : public testing::InFolder {
 protected:
  [[nodiscard]] Outcome vsi(const std::string& arguments) const { return run("'" VSI_COMMAND "' " + arguments); }

  [[nodiscard]] Outcome run(const std::string& command) const {
    FILE* pipe = popen(("cd '" + folder_.string() + "' && " + command + " 2>&1").c_str(), "r");
    if (!pipe) return {-1, "no shell"};
    Outcome outcome{0, ""};
    std::array<char, 4096> buffer;
    for (std::size_t n; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
      outcome.output.append(buffer.data(), n);
    const int status = pclose(pipe);
    outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return outcome;
  }

  /// Exit code 2, one message that begins with "vsi: " and has this text in it, and no output file.
  void expect_rejected(const std::string& arguments, const std::string& text) const {
    const Outcome outcome = vsi(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments << "\n" << outcome.output;
    EXPECT_TRUE(outcome.output.starts_with("vsi: ")) << outcome.output;
    EXPECT_NE(outcome.output.find(text), std::string::npos) << arguments << "\n" << outcome.output;
    EXPECT_EQ(outcome.output.find("vsi: ", 1), std::string::npos) << outcome.output;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
  }
};

// A scene on rigid track that takes a few milliseconds per simulated second.
inline const std::string rigid_scene = "[contact]\nmode = \"online\"\n[track]\nkind = \"rigid\"\n[integration]\n";

}  // namespace railtab
