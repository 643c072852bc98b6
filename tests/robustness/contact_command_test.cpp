#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
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

void expect_rejected(const std::string& arguments, const std::string& part) {
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

TEST(ContactCommand, RejectsBadInput) {
  expect_rejected("--creepage 0,0,0", "found no --ratio ");
  for (const char* option : {"friction 0.3", "velocity 7", "motion 0,0,0,0", "modulus 1e11", "gauge 1.4"}) {
    expect_rejected(std::string("--ratio 1 --creepage 0,0,0 --") + option, "only with a --pose");
  }
  expect_rejected("--ratio 1", "found no --creepage ");
  expect_rejected("--ratio -2 --creepage 0,0,0", "expected 1e-4..1e4");
  expect_rejected("--ratio nan --creepage 0,0,0", "a number");
  expect_rejected("--ratio 1 --creepage 0,0", "X,Y,PHI");
  expect_rejected("--ratio 1 --creepage 0,0,0,", "X,Y,PHI");
  expect_rejected("--ratio 1 --creepage 0,0,inf", "X,Y,PHI");
  expect_rejected("--ratio 1 --creepage 1e155,0,0", "creepages to");
  expect_rejected("--ratio 1 --creepage 0,0,0 --elements 41", "an even number");
  expect_rejected("--ratio 1 --creepage 0,0,0 --poisson 0.6", "0..0.5");
}

constexpr const char* pair = "--wheel S1002 --rail 60E1 ";

TEST(ContactCommand, AWheelCarriesItsLoad) {
  const Outcome outcome = contact(std::string(pair) + "--pose 0.005,0.012,-1e-4 --load 75000 --elements 20 --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
  const nlohmann::json j = nlohmann::json::parse(outcome.text);
  EXPECT_EQ(j["kind"], "loaded contact");
  EXPECT_NEAR(j["force_on_rail"][2].get<double>(), 75e3, 0.75);
  EXPECT_EQ(j["force_on_rail"][0].get<double>(), 0.0);
  ASSERT_EQ(j["bands"].size(), 2u);
  EXPECT_NEAR(j["bands"][0]["normal_force"].get<double>() + j["bands"][1]["normal_force"].get<double>(),
              j["normal_force"].get<double>(), 1e-6);
  EXPECT_LE(j["residual"].get<double>(), 1e-7);
  EXPECT_FALSE(j.contains("friction"));
  // the same height by --dz gives the same force
  const Outcome lowered = contact(std::string(pair) + "--pose 0.005,0.012,-1e-4 --elements 20 --json --dz " +
                                  std::to_string(1e6 * j["dz"].get<double>()) + "e-6");
  ASSERT_EQ(lowered.exit_code, 0) << lowered.text;
  EXPECT_NEAR(nlohmann::json::parse(lowered.text)["force_on_rail"][2].get<double>(), 75e3, 20.0);
}

TEST(ContactCommand, FrictionAndTheFileOfPressures) {
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "contact_command_pressure.csv";
  std::filesystem::remove(file);
  const Outcome outcome =
      contact(std::string(pair) + "--pose 0.007,0.005,0 --load 20000 --friction 0.25 --velocity 30 " +
              "--motion 0.01,0,0,0 --json -o '" + file.string() + "'");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.text;
  const nlohmann::json j = nlohmann::json::parse(outcome.text);
  EXPECT_NEAR(j["force_on_rail"][2].get<double>(), 20e3, 0.2);
  EXPECT_NEAR(j["friction"]["pitch_rate"].get<double>(), -30.0 / 0.46, 1e-9);
  EXPECT_LE(j["friction"]["residual"].get<double>(), 1e-6);
  EXPECT_EQ(j["friction"]["force_on_wheel"][0].get<double>(), -j["force_on_rail"][0].get<double>());
  EXPECT_GT(j["friction"]["force_on_wheel"][0].get<double>(), 0.0) << "a flange of larger radius drives the wheel";
  const Outcome text = contact(std::string(pair) + "--pose 0,0,0 --load 1e4 --friction 0.3 --elements 20");
  EXPECT_EQ(text.exit_code, 0) << text.text;
  EXPECT_NE(text.text.find("creepages"), std::string::npos) << text.text;
  // the file holds the pressures: they add up to the normal force, and no traction exceeds friction
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line, "x,s_rail,y,z,angle,overlap,pressure,traction_x,traction_y,band");
  double sum = 0.0;
  for (double v[10]; std::getline(in, line);) {
    std::istringstream fields(line);
    std::string field;
    for (double& value : v) {
      ASSERT_TRUE(std::getline(fields, field, ','));
      value = std::stod(field);
    }
    sum += v[6];
    EXPECT_LE(std::hypot(v[7], v[8]), 0.25 * v[6] * (1 + 1e-9));
  }
  const double area = j["elements"]["dx"].get<double>() * j["elements"]["ds"].get<double>();
  EXPECT_NEAR(sum * area / j["normal_force"].get<double>(), 1.0, 1e-9);
  std::filesystem::remove(file);
}

TEST(ContactCommand, RepairsOfProfileFilesAreSaid) {
  const std::filesystem::path wheel = std::filesystem::path(::testing::TempDir()) / "contact_command_wheel.txt";
  std::ofstream file(wheel);
  for (int y = -30; y <= 30; ++y) file << y << ' ' << 1e-4 * y * y - 0.05 * y << '\n';
  file.close();
  const std::string at = "--wheel '" + wheel.string() + "' --rail 60E1 --pose 0,0,0 --dz 1e-5 --elements 8";
  const Outcome said = contact(at);
  EXPECT_EQ(said.exit_code, 0) << said.text;
  EXPECT_NE(said.text.find("tablegen contact: note: "), std::string::npos) << said.text;
  EXPECT_NE(said.text.find("taken as mm from the width of 60"), std::string::npos) << said.text;
  EXPECT_EQ(contact(at + " --quiet").text, "");
  std::filesystem::remove(wheel);
}

TEST(ContactCommand, RejectsALoadedContactThatIsWrong) {
  const std::string at = std::string(pair) + "--pose 0,0,0 ";
  expect_rejected(std::string(pair) + "--pose 0,0 --load 1e4", "Y,YAW,ROLL");
  expect_rejected(std::string(pair) + "--pose 0,0,nan --load 1e4", "Y,YAW,ROLL");
  expect_rejected(std::string(pair) + "--pose 0.5,0,0 --load 1e4", "0.1");
  expect_rejected(at, "neither --load nor --dz");
  expect_rejected(at + "--load 1e4 --dz 1e-4", "both --load and --dz");
  expect_rejected(at + "--load 0", "--load: found 0, expected above 0");
  expect_rejected(at + "--load 75000e3", "--load: found 75000e3, expected above 0, at most 1e+07 N");
  expect_rejected(at + "--load 1e6 --modulus 1e10 --elements 8", "a load that lowers it by at most 2 mm; is it in N?");
  expect_rejected(at + "--load 1e4 --smoothing 3e-6", "--smoothing: found 3e-6 with the built-in profiles");
  expect_rejected(at + "--load 1e4 --gauge 2 --flange-back 1.4", "--pose: found 0,0,0, expected one at which wheel");
  expect_rejected(at + "--dz 1", "0..2e-3");
  expect_rejected(at + "--load 1e4 --ratio 2", "--ratio");
  expect_rejected(at + "--load 1e4 --pitch-rate -60", "--friction");
  expect_rejected(at + "--load 1e4 --friction 0.3 --motion 1,2", "VY,VZ,ROLL,YAW");
  expect_rejected(at + "--load 1e4 --friction 3", "friction");
  expect_rejected(at + "--load 1e4 --friction 5e-324", "expected 1e-6 to 2");
  expect_rejected(at + "--load 1e4 --friction 0.3 --velocity 5e-324", "expected 1e-6 to 1000 m/s");
  expect_rejected(at + "--load 1e4 --friction 0.3 --velocity 0", "speed");
  expect_rejected(at + "--load 1e4 --elements 2", "elements");
  expect_rejected(at + "--load 1e4 --table x.h5", "--wheel");
  expect_rejected("--pose 0,0,0 --load 1e4 --wheel S1002", "found no --rail ");
  expect_rejected("--ratio 2 --creepage 0,0,0 --load 1e4", "--pose");
  const Outcome many = contact(at + "--dz 1e-4 --most-elements 100");
  EXPECT_EQ(many.exit_code, 1);
  EXPECT_NE(many.text.find("--most-elements"), std::string::npos) << many.text;
}

}  // namespace
}  // namespace railtab
