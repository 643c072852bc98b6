#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "railtab/tablegen/rolling_contact.hpp"

namespace railtab {
namespace {

struct Outcome {
  int exit_code;
  std::string text;  // of both streams
};

Outcome contact(const std::string& arguments) {
  const std::string command = "'" TABLEGEN_COMMAND "' contact " + arguments + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) return {-1, ""};
  Outcome outcome{0, ""};
  char part[4096];
  while (std::fgets(part, sizeof part, pipe)) outcome.text += part;
  const int status = pclose(pipe);
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

void expect_refused(const std::string& arguments, const std::string& part) {
  const Outcome outcome = contact(arguments);
  EXPECT_EQ(outcome.exit_code, 2) << arguments;
  EXPECT_NE(outcome.text.find(part), std::string::npos) << outcome.text;
}

TEST(ContactCommand, PrintsTheSolutionOfTheLibrary) {
  const Outcome outcome = contact("--ratio 2 --creepage 0.1,-0.05,0.2 --elements 20 --poisson 0.25 --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
  const nlohmann::json j = nlohmann::json::parse(outcome.text);
  RollingContactOptions options;
  options.elements = 20;
  const ExtrapolatedContactSolution s = ExtrapolatedRollingContact(2.0, 0.25, options).solve({0.1, -0.05, 0.2});
  // the plan of the FFT may differ from run to run: to a part of the residual, not to rounding
  EXPECT_NEAR(j["fx"].get<double>(), s.force.x, 1e-6);
  EXPECT_NEAR(j["fy"].get<double>(), s.force.y, 1e-6);
  EXPECT_NEAR(j["mz"].get<double>(), s.force.moment, 1e-6);
  EXPECT_LT(j["fx"].get<double>(), 0.0) << "positive creepage pushes the wheel back";
  EXPECT_NEAR(j["fx"].get<double>(), 2 * j["fine"]["fx"].get<double>() - j["coarse"]["fx"].get<double>(), 1e-12);
  EXPECT_EQ(j["fine"]["elements"], 20);
  EXPECT_LE(j["fine"]["residual"].get<double>(), 1e-6);
  EXPECT_TRUE(j["fine"]["converged"].get<bool>());
}

TEST(ContactCommand, ExtremesAreFinite) {
  for (const char* arguments : {"--ratio 1000 --creepage 1e60,0,1", "--ratio 1e-3 --creepage 0,0,0"}) {
    const Outcome outcome = contact(std::string(arguments) + " --elements 20 --json");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
    EXPECT_TRUE(nlohmann::json::parse(outcome.text)["fx"].is_number());
  }
}

TEST(ContactCommand, RefusesBadInput) {
  expect_refused("--creepage 0,0,0", "ratio is missing");
  expect_refused("--ratio 1", "creepage is missing");
  expect_refused("--ratio -2 --creepage 0,0,0", "expected 1e-4..1e4");
  expect_refused("--ratio nan --creepage 0,0,0", "a number");
  expect_refused("--ratio 1 --creepage 0,0", "X,Y,PHI");
  expect_refused("--ratio 1 --creepage 0,0,0,", "X,Y,PHI");
  expect_refused("--ratio 1 --creepage 0,0,inf", "X,Y,PHI");
  expect_refused("--ratio 1 --creepage 1e155,0,0", "creepages to");
  expect_refused("--ratio 1 --creepage 0,0,0 --elements 41", "an even number");
  expect_refused("--ratio 1 --creepage 0,0,0 --poisson 0.6", "0..0.5");
}

}  // namespace
}  // namespace railtab
