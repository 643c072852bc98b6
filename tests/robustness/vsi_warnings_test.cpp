// What vsi run says of scenes that are not wrong, but hardly what was meant, and of runs that cannot begin.

#include <gtest/gtest.h>

#include <string>

#include "vsi_fixture.hpp"

namespace railtab {
namespace {

TEST_F(VsiCommand, WhatActsNowhereInTheRunIsSaid) {
  write("rough.csv", "x[m],y_left[mm],z_left[mm],y_right[mm],z_right[mm]\n0,0,0,0,0\n50,1,1,1,1\n100,0,0,0,0\n");
  write("wind.csv", "x[m],Fy[kN]\n0,1\n50,2\n");
  write("quake.csv", "t[s],y[m/s2]\n0,0\n1,0.5\n2,0\n");
  const std::string far = rigid_scene +
                          "duration = 0.01\n[train]\nstart = 5000.0\n[irregularity]\nfile = \"rough.csv\"\n"
                          "[span_deviation]\nshape = \"bending\"\nstart = 100.0\n"
                          "[[load]]\nFy = 1e4\nstart = 30.0\ngust_duration = 4.0\n[[load]]\nfile = \"wind.csv\"\n"
                          "[[ground_motion]]\nfile = \"quake.csv\"\n";
  write("far.toml", far + "start = 10.0\n");
  const char* const warnings[] = {
      "vsi run: warning: [[load]] 1 of 2 is given for t = 30 to 34 s, the run is at t = 0 to 0.01 s: it does not act\n",
      "vsi run: warning: [[load]] 2 of 2 is given for x = 0 to 50 m",
      "vsi run: warning: [[ground_motion]] 1 of 1 begins at t = 10 s, the run ends at 0.01 s",
      "vsi run: warning: the spans of [span_deviation] turn at x = 100 to 140 m",
      "vsi run: warning: irregularity.file rough.csv is measured at x = 0 to 100 m"};
  for (const char* command : {"run far.toml --plan", "run far.toml -o r.h5"}) {
    const Outcome outcome = vsi(command);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    for (const char* warning : warnings) {
      EXPECT_NE(outcome.output.find(warning), std::string::npos) << warning << '\n' << outcome.output;
    }
  }
  EXPECT_NE(vsi("run far.toml --plan").output.find("built:    irregularity of rough.csv"), std::string::npos);
  write("zero.toml", far + "factor = 0\n");
  EXPECT_NE(vsi("run zero.toml --plan --json").output.find("is taken times 0: the ground stays at rest"),
            std::string::npos);

  // the same where the train meets them
  std::string near = far;
  for (const auto& [from, to] : {std::pair<std::string, std::string>{"start = 5000.0", "start = 60.0"},
                                 {"start = 100.0", "start = 40.0"},
                                 {"start = 30.0", "start = 0.0"}}) {
    near.replace(near.find(from), from.size(), to);
  }
  write("near.toml", near);
  EXPECT_EQ(vsi("run near.toml --plan").output.find("warning"), std::string::npos)
      << vsi("run near.toml --plan").output;
}

TEST_F(VsiCommand, ATrainPlacedOnItsFlangesIsSaidToBeginWithAnImpact) {
  const auto output_of = [&](const std::string& shift) {
    write("aside.toml", rigid_scene + "duration = 0.002\n[train]\ninitial_lateral_shift = " + shift + "\n");
    return vsi("run aside.toml -o r.h5").output;
  };
  for (const char* shift : {"0.007", "-0.007", "0.010", "0.014"}) {
    EXPECT_NE(output_of(shift).find("warning: the train begins"), std::string::npos) << shift;
  }
  for (const char* shift : {"0.0", "0.003", "0.005", "-0.005"}) {
    EXPECT_EQ(output_of(shift).find("warning"), std::string::npos) << shift;
  }
}

// What holds the train from rest is named: its acceleration, the loads, or the wheels that do not fit.
TEST_F(VsiCommand, NoStateOfRestSaysWhy) {
  const auto output_of = [&](const std::string& more, const std::string& contact = "") {
    std::string text = rigid_scene + "duration = 0.01\n" + more;
    write("scene.toml", text.insert(text.find("[track]"), contact));
    const Outcome outcome = vsi("run scene.toml -o r.h5 -q");
    EXPECT_EQ(outcome.exit_code, 1) << outcome.output;
    EXPECT_EQ(outcome.output.find(" 0 iterations"), std::string::npos) << outcome.output;
    return outcome.output;
  };
  const auto expect = [](const std::string& output, const std::string& text) {
    EXPECT_NE(output.find(text), std::string::npos) << output;
  };
  write("stop.csv", "t[s],V[m/s]\n0,60\n5,20\n");
  expect(output_of("[train]\nspeed_file = \"stop.csv\"\n"), "without the acceleration: the train cannot bear -8 m/s²");
  expect(output_of("[[load]]\nFy = 3e6\n"), "there is one without the loads that act at t = 0 s");
  expect(output_of("", "dimensions.flange_back = 1.50\n"), "flange backs 1.5 m apart");
}

TEST_F(VsiCommand, APlanRefusesWhatTheRunRefuses) {
  write("scene.toml", rigid_scene + "duration = 0.01\n[output]\nbodies = [\"nothing\"]\n");
  for (const char* command : {"run scene.toml --plan", "run scene.toml -o out"}) {
    expect_refused(command,
                   "scene.toml:8: output.bodies: found \"nothing\", expected a pattern that fits one of coach-1");
  }
  write("rigid.toml", "[contact]\nnormal = \"rigid\"\n[track]\nkind = \"rigid\"\n[integration]\nduration = 0.01\n");
  expect_refused("run rigid.toml --contact online -o out", "--contact: found a scene with contact.normal = \"rigid\"");
}

TEST_F(VsiCommand, AReductionIsCheckedAlone) {
  write("scene.toml",
        "[contact]\nmode = \"online\"\ncreep_law = \"polach\"\n[train]\nstart = -10.0\n"
        "[track]\nlength_before = 40\nlength_after = 60\n[[bridge]]\nlength = 12\nelements = 8\n"
        "[structure]\nreduction = \"window\"\n");
  for (const char* other : {"--plan", "--resume", "-o out"}) {
    expect_refused(std::string("run scene.toml --check-reduction 0.01 ") + other, "--check-reduction: found --");
  }
  expect_refused("run scene.toml --check-reduction 99", "found 99 s, expected at most 0.78408 s");
  const Outcome outcome = vsi("run scene.toml --check-reduction 0.02");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_NE(outcome.output.find("nothing to compare: compare until the train is on the bridge"), std::string::npos)
      << outcome.output;
  // the unknowns of the window, not those of the whole line
  const Outcome json = vsi("run scene.toml --check-reduction 0.02 --json");
  const auto number = [&](const std::string& name) {
    return std::atol(json.output.c_str() + json.output.find("\"" + name + "\": ") + name.size() + 4);
  };
  EXPECT_GT(number("unknowns"), 1000);
  EXPECT_LT(number("unknowns"), 0.9 * static_cast<double>(number("unknowns_none")));
}

}  // namespace
}  // namespace railtab
