// Warnings of vsi run: scenes that are valid, but most likely not what was meant, and runs that cannot begin.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <numbers>
#include <string>

#include "railtab/runtime/profile/profile_curve.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "vsi_fixture.hpp"

namespace railtab {
namespace {

TEST_F(VsiCommand, InputThatActsNowhereInTheRunIsWarnedOf) {
  write("rough.csv", "x[m],y_left[mm],z_left[mm],y_right[mm],z_right[mm]\n0,0,0,0,0\n50,1,1,1,1\n100,0,0,0,0\n");
  write("wind.csv", "x[m],Fy[kN]\n0,1\n50,2\n");
  write("quake.csv", "t[s],y[m]\n0,0\n1,0.05\n2,0\n");
  const std::string far = rigid_scene +
                          "duration = 0.01\n[train]\nstart = 5000.0\n[irregularity]\nfile = \"rough.csv\"\n"
                          "[span_deviation]\nshape = \"bending\"\nstart = 100.0\n"
                          "[[load]]\nFy = 1e4\nstart = 30.0\ngust_duration = 4.0\n[[load]]\nfile = \"wind.csv\"\n"
                          "[[ground_motion]]\nfile = \"quake.csv\"\n";
  write("far.toml", far + "start = 10.0\n");
  const char* const warnings[] = {
      "vsi run: warning: [[load]] 1 of 2 is specified for t = 30 to 34 s, the run is at t = 0 to 0.01 s: it does not "
      "act\n",
      "vsi run: warning: [[load]] 2 of 2 is specified for x = 0 to 50 m",
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
  EXPECT_NE(vsi("run zero.toml --plan --json")
                .output.find("is multiplied by ground_motion.factor = 0: the ground stays at rest"),
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

// What is said of a scene on flexible track with these lines more.
class SceneWarnings : public VsiCommand {
 protected:
  [[nodiscard]] std::string plan(const std::string& more, const std::string& contact = "mode = \"online\"") const {
    write("scene.toml", "[contact]\n" + contact + "\n[track]\nlength_before = 40\nlength_after = 20\n" + more +
                            "[integration]\nduration = 0.1\n");
    return vsi("run scene.toml --plan").output;
  }
  static void expect(const std::string& output, const std::string& text) {
    EXPECT_NE(output.find(text), std::string::npos) << output;
  }
};

TEST_F(SceneWarnings, OfRecordsThatMoveNothing) {
  const auto ground = [](const std::string& file, const std::string& more = "") {
    return "[[ground_motion]]\nfile = \"" + file + "\"\n" + more;
  };
  write("constant.csv", "t[s],y[m/s2]\n0,1\n1,1\n2,1\n");
  expect(plan(ground("constant.csv")),
         "y: up to 1 m/s² added to a peak of 1 m/s², which is 0 m/s² then (0 %)); check that the record is complete, "
         "and an acceleration");
  write("zero.csv", "t[s],z[m]\n0,0\n1,0\n");
  expect(plan(ground("zero.csv")), "[[ground_motion]] 1 of 1 is zero throughout: the ground stays at rest");
  write("both.csv", "t[s],y[m],z[m]\n0,0,0\n1,0.01,0.01\n2,0,0\n");
  const std::string stations =
      plan(ground("both.csv", "x = -500.0\n") + ground("both.csv", "x = -400.0\n") + ground("both.csv", "x = 900.0\n"));
  expect(stations, "[[ground_motion]] 1 of 3, at x = -500 m, moves nothing: wheels and supports are at x = -40.2 to");
  EXPECT_EQ(stations.find("2 of 3"), std::string::npos) << stations;
  EXPECT_EQ(plan(ground("both.csv")).find("warning"), std::string::npos);
  const std::string rigid = "normal = \"rigid\"";
  expect(plan(ground("both.csv"), rigid), "moves the ground along y too: nothing in a vertical scene follows it");
  write("lateral.csv", "t[s],y[m]\n0,0\n1,0.01\n2,0\n");
  expect(plan(ground("lateral.csv"), rigid),
         "scene.toml:6: [[ground_motion]] 1 of 1: found lateral motion alone with contact.normal = \"rigid\"");
  expect(plan(ground("both.csv") + ground("both.csv")),
         "scene.toml:8: [[ground_motion]] 2 of 2: found a station at x = 0 m after one at 0 m");
}

TEST_F(SceneWarnings, OfRecordsWithAGapOrTooStrong) {
  std::string gap = "t[s],z[m/s2]\n";
  for (int i = 0; i < 100; ++i) {
    if (i < 40 || i > 70) gap += std::to_string(0.01 * i) + "," + std::to_string(i % 4 < 2 ? 5 : -5) + "\n";
  }
  write("gap.csv", gap);
  expect(plan("[[ground_motion]]\nfile = \"gap.csv\"\n"),
         "[[ground_motion]] 1 of 1 has no point from t = 0.39 to 0.71 s, where most are 0.01 s apart");
  expect(plan("[[ground_motion]]\nfile = \"gap.csv\"\nfactor = 9.81\n"),
         "[[ground_motion]] 1 of 1 has a peak of 49.1 m/s² with ground_motion.factor = 9.81");
}

TEST_F(SceneWarnings, OfStepsAndRecordsTooFarApart) {
  const auto at = [this](const std::string& steps, const std::string& more = "") {
    write("scene.toml",
          "[contact]\nmode = \"online\"\n[train]\nspeed = 60.0\n" + more + "[integration]\nduration = 0.5\n" + steps);
    return vsi("run scene.toml --plan").output;
  };
  const std::string track = "[track]\nlength_before = 40\nlength_after = 60\n", rigid = "[track]\nkind = \"rigid\"\n";
  expect(at("time_step = 0.006\n", track), "a step is 0.36 m long, the distance between sleepers is 0.6 m");
  expect(at("time_step = 0.003\n", rigid + "[irregularity]\nspectrum = \"german-low\"\nshortest_wave = 0.5\n"),
         "a step is 0.18 m long, the shortest wave of the track is 0.5 m");
  expect(at("[output]\nevery = 1000\n", track), "output.every: records are 0.5 s apart, more than 0.05 s");
  EXPECT_EQ(at("time_step = 0.002\n[output]\nevery = 10\n", track).find("apart"), std::string::npos);
  EXPECT_EQ(at("time_step = 0.002\n", track).find("a step is"), std::string::npos);
}

// At 50 m/s and 0.5 ms a step is 25 mm long.
TEST_F(SceneWarnings, OfWavesAndFlatsThatStepsMiss) {
  const auto at = [this](const std::string& more, const std::string& step = "",
                         const char* contact = "mode = \"online\"") {
    write("scene.toml", std::string("[contact]\n") + contact + "\n[train]\nspeed = 50.0\n[track]\nkind = \"rigid\"\n" +
                            more + "[integration]\nduration = 0.5\n" + step);
    return vsi("run scene.toml --plan").output;
  };
  const auto silent = [](const std::string& output) {
    EXPECT_EQ(output.find("a step is"), std::string::npos) << output;
  };
  const std::string rest = ": forces and accelerations of so short waves are wrong or missing; use at most ";

  const std::string polygon = "[[wheel]]\npolygon_amplitude = 5e-6\npolygon_order = ";
  expect(at(polygon + "100\n"),
         "a step is 0.025 m long, a wave of the polygon of [[wheel]] 1 of 1 is 0.0289 m" + rest + "0.00014 s");
  silent(at(polygon + "100\n", "time_step = 1.4e-4\n"));
  silent(at(polygon + "24\n"));
  silent(at("[[wheel]]\npolygon_order = 100\nrun_out = 1e-4\n"));  // without amplitude

  const std::string flat = "[[wheel]]\nwheelset = 1\nflat_edges = \"rounded\"\nflat_length = ";
  expect(at(flat + "0.03\n"), "a step is 0.025 m long, the flat of [[wheel]] 1 of 1 is 0.03 m" + rest + "0.0003 s");
  silent(at(flat + "0.06\n"));
  const char* const follow = "normal = \"rigid\"";
  expect(at(flat + "0.06\n", "", follow), "the flat of [[wheel]] 1 of 1 is 0.06 m" + rest + "0.0003 s");

  std::string contour = "angle[deg],rise[mm]\n";
  for (int i = 0; i < 360; ++i) contour += std::to_string(i) + "," + (i % 6 < 3 ? "0.01" : "-0.01") + "\n";
  write("wheel.csv", contour);
  expect(at("[[wheel]]\nfile = \"wheel.csv\"\n"), "% of the rms slope of wheel.file wheel.csv of [[wheel]] 1 of 1");

  const auto corrugated = [this](double wave) {
    std::string rows = "x[m],y_left[mm],z_left[mm],y_right[mm],z_right[mm]\n";
    for (int i = -8000; i <= 8000; ++i) {
      const double x = 5e-3 * i, z = 0.02 * std::cos(2.0 * std::numbers::pi * x / wave);
      rows += std::to_string(x) + ",0," + std::to_string(z) + ",0,0\n";
    }
    write("corrugated.csv", rows);
    return std::string("[irregularity]\nfile = \"corrugated.csv\"\n");
  };
  // of a wave twice as long as the step 1 - 2/pi is lost, of one eight times as long 2.6 %
  const std::string short_wave = corrugated(0.05);
  expect(at(short_wave),
         "points so far apart lose 36 % of the rms slope of z_left in irregularity.file corrugated.csv" + rest +
             "0.00012 s");
  expect(at(short_wave, "", follow), "lose 36 % of the rms slope of irregularity.file corrugated.csv");
  silent(at(short_wave, "time_step = 1.2e-4\n"));
  silent(at(corrugated(0.2)));
}

TEST_F(SceneWarnings, OfSpansThatTheTrainHardlyReaches) {
  expect(plan("[[bridge]]\nlength = 1.5\n"),
         "bridge.length = 1.5 m is less than 3 times track.sleeper_spacing = 0.6 m: the train reaches the span through "
         "its sleepers, and its accelerations say little");
  expect(plan("[[bridge]]\nlength = 0.5\n"), "is not loaded, and its values are 0");
  expect(plan("[[bridge]]\nlength = 20.0\ntrack_offset = 50.0\n"),
         "bridge.track_offset = 50 m: the track is that far from the beam axis");
}

TEST_F(SceneWarnings, OfLoadsAndSpeedsThatChangeNothing) {
  expect(plan("[[load]]\nFy = 0.0\n"), "warning: [[load]] 1 of 1 is zero throughout: it does not act");
  expect(plan("[[load]]\nbody = \"car-body\"\n"), "[[load]] 1 of 1: found neither file nor component");
  write("late.csv", "t[s],V[m/s]\n10,30\n12,40\n");
  expect(plan("[train]\nspeed_file = \"late.csv\"\n"),
         "the run is at t = 0 to 0.1 s: its first speed holds throughout");
  write("brake.csv", "t[s],V[m/s]\n0,40\n0.1,39\n");
  const std::string braked = "[train]\nspeed_file = \"brake.csv\"\n";
  const std::string by_forces = "warning: train.speed_file brake.csv changes the speed by forces on the car bodies";
  expect(plan(braked), by_forces);
  expect(plan(braked + "[[load]]\nbody = \"wheelset-1\"\nFx = 1e3\n"), by_forces);
  const std::string torque = braked + "[[load]]\nbody = \"wheelset-1\"\nMy = 1e3\n";
  const std::string alone = plan(torque);
  expect(alone, "warning: train.speed_file brake.csv: [[load]]s turn wheelsets by My and no other body");
  EXPECT_EQ(alone.find("forces on the car bodies"), std::string::npos) << alone;
  const std::string reacted = plan(torque + "[[load]]\nbody = \"bogie-1\"\nMy = -1e3\n");
  EXPECT_EQ(reacted.find("warning"), std::string::npos) << reacted;
  write("flat.csv", "x[m],y_left[mm],z_left[mm],y_right[mm],z_right[mm]\n-90,0,0,0,0\n90,0,0,0,0\n");
  expect(plan("[irregularity]\nfile = \"flat.csv\"\n"), "flat.csv is zero throughout: the track is perfect");
}

TEST_F(SceneWarnings, OfRecordsThatMoveNoWheelThatFollowsTheRails) {
  const std::string follow = "normal = \"rigid\"", profiles = "mode = \"online\"";
  const auto record = [&](const std::string& rows, const std::string& contact) {
    write("track.csv", "x[m],y_left[mm],z_left[mm],y_right[mm],z_right[m]\n" + rows);
    return plan("[irregularity]\nfile = \"track.csv\"\n", contact);
  };
  const std::string lateral = "-90,0,0,0,0\n0,3,0,3,0\n90,0,0,0,0\n",
                    twist = "-90,0,0,0,0\n0,0,-3,0,3e-3\n90,0,0,0,0\n";
  const std::string message =
      "warning: irregularity.file track.csv has no effect: with contact.normal = \"rigid\" wheelsets follow the mean "
      "of z_left and z_right, which is zero throughout";
  for (const std::string& rows : {lateral, twist}) {
    expect(record(rows, follow), message);
    EXPECT_EQ(record(rows, profiles).find("warning"), std::string::npos);
  }
  EXPECT_EQ(record("-90,0,0,0,0\n0,0,-3,0,4e-3\n90,0,0,0,0\n", follow).find("warning"), std::string::npos);
}

TEST_F(SceneWarnings, OfARunThatEndsBeforeItIsJudged) {
  const std::string track = "[irregularity]\nspectrum = \"german-low\"\n";
  expect(plan(track), "warning: judging begins at x = 70 m (train.start + irregularity.fade_in), the wheels run at");
  EXPECT_EQ(plan(track + "fade_in = 0\n").find("warning"), std::string::npos);
  expect(plan("[assessment]\nbegin = 500\n"), "warning: judging begins at x = 500 m (assessment.begin)");
}

TEST_F(SceneWarnings, OfLoadsThatStepsMayPassBy) {
  const std::string wheelset = "[[load]]\nbody = \"wheelset-1\"\n";
  const auto gust = [&](const char* duration) {
    return plan(wheelset + "Fz = 1e5\nstart = 0.05\ngust_duration = " + duration + "\n");
  };
  expect(gust("4.9e-4"),
         "warning: [[load]] 1 of 1: Fz rises and falls within 0.00049 s at t = 0.05 s, in less than four "
         "time steps (0.002 s): it may act in part or not at all; an integration.time_step of 0.000122 s");
  EXPECT_EQ(gust("2e-3").find("warning"), std::string::npos);
  write("spike.csv", "t[s],Fy[kN]\n0,0\n0.05,0\n0.0502,50\n0.0505,0\n1,0\n");
  expect(plan(wheelset + "file = \"spike.csv\"\n"), "Fy rises and falls within 0.0005 s at t = 0.05 s");
  EXPECT_EQ(plan(wheelset + "file = \"spike.csv\"\nstart = 0.06\n").find("warning"), std::string::npos);  // too late
  // over the place of the body: 40 mm are 0.96 ms at 150 km/h and six times that at 25 km/h
  write("post.csv", "x[m],Fy[kN]\n-90,0\n5.50,0\n5.52,50\n5.54,0\n90,0\n");
  const std::string post = wheelset + "file = \"post.csv\"\n";
  expect(plan("[train]\nspeed_kmh = 150.0\nstart = 5.0\n" + post), "Fy rises and falls within 0.00096 s at t = ");
  EXPECT_EQ(plan("[train]\nspeed_kmh = 25.0\nstart = 5.0\n" + post).find("warning"), std::string::npos);
}

TEST_F(SceneWarnings, OfIrregularitiesThatEndInAStep) {
  const auto record = [&](const std::string& rows, const std::string& contact = "mode = \"online\"") {
    write("abrupt.csv", "x[m],y_left[mm],z_left[mm],y_right[mm],z_right[mm]\n" + rows);
    return plan("[train]\nspeed_kmh = 360.0\nstart = 0.0\n[irregularity]\nfile = \"abrupt.csv\"\n", contact);
  };
  expect(record("2,0,-9,0,-10\n6,0,-10,0.3,0\n"),
         "warning: irregularity.file abrupt.csv begins at x = 2 m with z_right = -10 mm and ends at x = 6 m with "
         "z_left = -10 mm, not with zero: wheels meet a step there");
  expect(record("2,0.09,0,0,0.1\n6,0,0,-0.2,0\n"), "abrupt.csv ends at x = 6 m with y_right = -0.2 mm, not with zero");
  expect(record("2,0,-9,0,-10\n6,0,0,0,0\n", "normal = \"rigid\""),
         "with z_right = -10 mm, not with zero: wheels that follow the rails jump there, without the force");
  const std::string step = "warning: irregularity.file";
  EXPECT_EQ(record("2,0.09,0,0,-0.1\n6,0,0,0,0\n").find(step), std::string::npos);
  EXPECT_EQ(record("-90,0,-9,0,-10\n90,0,-9,0,-10\n").find(step), std::string::npos);  // reaches beyond the run
}

TEST_F(SceneWarnings, OfIrregularitiesInOtherUnits) {
  const auto record = [&](const std::string& unit, const std::string& rows) {
    std::string text = "x[m]";
    for (const char* column : {"y_left", "z_left", "y_right", "z_right"}) {
      text += std::string(",") + column + "[" + unit + "]";
    }
    write("track.csv", text + "\n" + rows);
    return plan("[irregularity]\nfile = \"track.csv\"\n");
  };
  const std::string found = "warning: irregularity.file track.csv: ";
  expect(record("m", "-90,0,0,0,0\n0,0,0.3,0,0.2\n90,0,0,0,0\n"),
         found + "z_left is 300 mm at x = 0 m, tracks stay within 100 mm: is the column in mm, not in m?");
  expect(record("mm", "-90,0,0,0,0\n0,0,90,-200,0\n90,0,0,0,0\n"),
         found +
             "z_left has an rms of 52 mm, its largest value is 90 mm at x = 0 m, tracks stay below an rms of 20 mm: is "
             "the column in um, not in mm?");
  std::string joint;
  for (int i = -9000; i <= 9000; ++i) {
    if (i % 1000 == 0 || std::abs(i) < 20) joint += std::to_string(0.01 * i) + (i == 0 ? ",0,0,5,0\n" : ",0,0,0,0\n");
  }
  expect(
      record("mm", joint),
      found +
          "y_right has a slope of 0.5 at x = 0 m, no wheel follows more than 0.2: is the column in um, not in mm, or "
          "x not in m?");
  EXPECT_EQ(record("mm", "-90,0,0,0,0\n0,15,-15,15,15\n90,0,0,0,0\n").find("warning"), std::string::npos);
}

TEST_F(SceneWarnings, OfDisplacementsAtUnevenTimes) {
  const auto quake = [&](const std::string& rows) {
    write("quake.csv", "t[s],z[mm]\n" + rows);
    return plan("[[ground_motion]]\nfile = \"quake.csv\"\n");
  };
  const std::string uneven = quake("0,0\n1,0\n1.01,5\n1.02,10\n2,10\n3,10\n");
  expect(
      uneven,
      "warning: [[ground_motion]] 1 of 1: the curve through the displacements z swings out of the points around t = ");
  expect(uneven, " of their range; give points at even intervals, or accelerations");
  const std::string even = quake("0,0\n0.2,10\n0.4,6\n0.6,-6\n0.8,-10\n1,0\n1.2,10\n1.4,6\n1.6,0\n");
  EXPECT_EQ(even.find("swings"), std::string::npos) << even;
}

TEST_F(SceneWarnings, OfMeasuredProfilesThatAreNotSmoothed) {
  const ProfileCurve s1002(standard_profile(ProfileKind::wheel, "S1002", 0.0));
  const auto plan_with = [&](double noise) {
    std::string points;
    int i = 0;
    for (double s = s1002.s_begin(); s <= s1002.s_end(); s += 0.5e-3, ++i) {
      const double error = noise * (i * i % 7 - 2);  // 0, 1, 4, 2, 2, 4, 1 less 2
      points += std::to_string(1e3 * s1002.at(s).y) + ' ' + std::to_string(1e3 * (s1002.at(s).z + error)) + '\n';
    }
    write("wheel.txt", points);
    return plan("", "mode = \"online\"\nwheel = \"wheel.txt\"");
  };
  const std::string noisy = plan_with(1e-6);
  expect(noisy, "warning: the points of wheel.txt scatter by about ");
  expect(noisy, "make a table by tablegen geometry --smoothing ");
  EXPECT_EQ(noisy.find("the points of 60E1"), std::string::npos) << noisy;
  const std::string exact = plan_with(0.0);
  EXPECT_EQ(exact.find("warning"), std::string::npos) << exact;
}

// Wheelset 1 is lifted for some milliseconds: a wheel that follows its rail is held down.
TEST_F(VsiCommand, ForcesThatASceneCannotGiveAreSaidAtItsEnd) {
  const auto output_of = [&](const std::string& contact, const char* lift) {
    write("scene.toml", "[contact]\n" + contact +
                            "\n[track]\nlength_before = 40\nlength_after = 20\n[[load]]\nbody = \"wheelset-1\"\nFz = " +
                            lift + "\ngust_duration = 0.02\n[integration]\nduration = 0.02\n");
    const Outcome outcome = vsi("run scene.toml -o r.h5");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    return outcome.output;
  };
  const std::string online = "mode = \"online\"", rigid = "normal = \"rigid\"";
  EXPECT_EQ(output_of(online, "-2e5").find("warning"), std::string::npos);
  const std::string pull = output_of(rigid, "-2e5");
  const char* const held_down = "vsi run: warning: negative contact force (smallest Q -";
  EXPECT_NE(pull.find(held_down), std::string::npos) << pull;
  EXPECT_NE(vsi("run scene.toml -o r.h5 --resume").output.find(held_down), std::string::npos);
  EXPECT_EQ(vsi("run scene.toml -o r.h5 -q").output, "");
  for (const char* again : {"", " --resume"}) {
    const std::string json = vsi(std::string("run scene.toml -o r.h5 --json 2> /dev/null") + again).output;
    EXPECT_NE(json.find("\"warnings\": [\"negative contact force"), std::string::npos) << json;
  }
  EXPECT_EQ(output_of(rigid, "-5e4").find("warning"), std::string::npos);
}

// A structure command names the scene's file, a resumed run how its results are damaged.
TEST_F(VsiCommand, MessagesNameTheFileAndItsDamage) {
  write("plain.toml", "name = \"Anything\"\n" + rigid_scene + "duration = 0.02\n");
  expect_rejected("structure plain.toml", "plain.toml: found no bridge, expected a [[bridge]]");
  EXPECT_EQ(vsi("run plain.toml -o r.h5 -q").exit_code, 0);
  const auto bytes = std::filesystem::file_size(folder_ / "r.h5");
  std::filesystem::resize_file(folder_ / "r.h5", bytes / 2);
  expect_rejected("run plain.toml -o r.h5 --resume", "r.h5: found " + std::to_string(bytes / 2) + " bytes, expected " +
                                                         std::to_string(bytes) + " bytes: the file is cut short");
}

TEST_F(VsiCommand, ATrainPlacedOnItsFlangesBeginsWithAnImpact) {
  const auto output_of = [&](const std::string& shift) {
    write("aside.toml", rigid_scene + "duration = 0.002\n[train]\ninitial_lateral_shift = " + shift + "\n");
    return vsi("run aside.toml -o r.h5").output;
  };
  for (const char* shift : {"0.0063", "0.0065", "0.007", "-0.007", "0.010", "0.014", "0.020"}) {
    EXPECT_NE(output_of(shift).find("warning: the train begins"), std::string::npos) << shift;
  }
  for (const char* shift : {"0.0", "0.003", "0.005", "-0.005"}) {
    EXPECT_EQ(output_of(shift).find("warning"), std::string::npos) << shift;
  }
}

// The cause is named: its acceleration, the loads, or the wheels that do not fit.
TEST_F(VsiCommand, NoStaticEquilibriumNamesTheCause) {
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
  write("stop.csv", "t[s],V[m/s]\n0,190\n2,20\n");
  expect(output_of("[train]\nspeed_file = \"stop.csv\"\n"), "without the acceleration: -85 m/s² at t = ");
  expect(output_of("[[load]]\nFy = 3e6\n"), "% of the loads that act at t = 0 s: reduce them");
  expect(output_of("", "dimensions.flange_back = 1.50\n"), "flange backs 1.5 m apart");
  const ProfileCurve s1002(standard_profile(ProfileKind::wheel, "S1002", 0.0));
  std::string points;
  for (double s = s1002.s_begin(); s <= s1002.s_end(); s += 0.2e-3) {
    points += std::to_string(1e3 * s1002.at(s).y) + ' ' + std::to_string(1e3 * s1002.at(s).z) + '\n';
  }
  write("wheel.txt", points);
  expect(
      output_of("", "wheel = \"wheel.txt\"\ndimensions.flange_back = 1.50\n"),
      "the origins of the profile files; if the points of wheel.txt are measured, their noise may be the cause: make "
      "a table by tablegen geometry --smoothing SIGMA (3e-6 for 3 um) and name it in contact.table");
  write("aside.csv", "x[m],y_left[m],z_left[m],y_right[m],z_right[m]\n-90,0,0,0,0\n0,0.4,0,0.4,0\n90,0,0,0,0\n");
  expect(output_of("[irregularity]\nfile = \"aside.csv\"\n"), "deviations of the rails under it (0.");
}

TEST_F(VsiCommand, ARunGoesOnForTheFreeVibrationOfItsBridge) {
  const auto duration = [this](const std::string& more) {
    write("scene.toml", "[contact]\nmode = \"online\"\n[train]\nspeed = 50.0\n[[bridge]]\nlength = 20.0\n" + more);
    const Outcome outcome = vsi("run scene.toml --plan --json");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    return nlohmann::json::parse(outcome.output)["duration"].get<double>();
  };
  EXPECT_NEAR(duration("[integration]\nfree_vibration = 0.4\n") - duration(""), 0.4, 5.1e-4);
  write("stops.csv", "t[s],V[m/s]\n0,30\n0.5,0\n");
  write("stops.toml", "[contact]\nmode = \"online\"\n[train]\nspeed_file = \"stops.csv\"\n[[bridge]]\nlength = 20.0\n");
  const Outcome stops = vsi("run stops.toml --plan");
  EXPECT_EQ(stops.exit_code, 2);
  EXPECT_NE(stops.output.find("train.speed_file: found a train that stops before its last wheelset is at x = 20 m"),
            std::string::npos)
      << stops.output;
}

// Treads that rise to the field side drive wheelsets off the centre.
TEST_F(VsiCommand, AMotionThatGrowsWithoutOscillationHasNoFrequency) {
  std::string points;
  for (int y = -40; y <= 40; ++y) points += std::to_string(y) + ' ' + std::to_string(0.2 * y) + '\n';
  write("wheel.txt", points);
  std::string text = rigid_scene + "duration = 0.01\n[train]\nspeed_kmh = 200\n";
  write("scene.toml", text.insert(text.find("[track]"), "wheel = \"wheel.txt\"\n"));
  const Outcome plan = vsi("run scene.toml --plan");
  EXPECT_NE(plan.output.find("on these profiles: a small motion without oscillation grows by "), std::string::npos)
      << plan.output;
}

TEST_F(VsiCommand, APlanCountsWholeSteps) {
  write("scene.toml", rigid_scene + "duration = 0.01034\n");
  EXPECT_NE(vsi("run scene.toml --plan").output.find("21 steps of 0.0005 s, 0.0105 s in all\n"), std::string::npos);
  // and those before t = 0, here the most there are: 0.2 s of them
  std::string text = rigid_scene + "duration = 0.01034\n";
  const std::string kind = "kind = \"rigid\"";
  ASSERT_NE(text.find(kind), std::string::npos);
  write("scene.toml", text.replace(text.find(kind), kind.size(), "kind = \"flexible\"\nlength_before = 100"));
  EXPECT_NE(vsi("run scene.toml --plan").output.find("0.0105 s in all, after 400 of pre-roll\n"), std::string::npos);
}

TEST_F(VsiCommand, APlanRejectsWhatTheRunRejects) {
  write("scene.toml", rigid_scene + "duration = 0.01\n[output]\nbodies = [\"nothing\"]\n");
  for (const char* command : {"run scene.toml --plan", "run scene.toml -o out"}) {
    expect_rejected(command,
                    "scene.toml:8: output.bodies: found \"nothing\", expected a pattern that fits one of coach-1");
  }
  write("rigid.toml", "[contact]\nnormal = \"rigid\"\n[track]\nkind = \"rigid\"\n[integration]\nduration = 0.01\n");
  expect_rejected("run rigid.toml --contact online -o out", "--contact: found a scene with contact.normal = \"rigid\"");
}

TEST_F(VsiCommand, AReductionIsCheckedAlone) {
  write("scene.toml",
        "[contact]\nmode = \"online\"\ncreep_law = \"polach\"\n[train]\nstart = -10.0\n"
        "[track]\nlength_before = 40\nlength_after = 60\n[[bridge]]\nlength = 12\nelements = 8\n"
        "[structure]\nreduction = \"window\"\n");
  for (const char* other : {"--plan", "--resume", "-o out"}) {
    expect_rejected(std::string("run scene.toml --check-reduction 0.01 ") + other, "--check-reduction: found --");
  }
  expect_rejected("run scene.toml --check-reduction 99", "found 99 s, expected at most 0.78408 s");
  const Outcome outcome = vsi("run scene.toml --check-reduction 0.02");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_NE(outcome.output.find("nothing to compare: compare until the train is on the bridge"), std::string::npos)
      << outcome.output;
  // the unknowns of the window, not those of the whole line
  const Outcome json = vsi("run scene.toml --check-reduction 0.02 --json");
  const auto number = [&](const std::string& name) {
    return std::atol(json.output.c_str() + json.output.find("\"" + name + "\": ") + name.size() + 4);
  };
  EXPECT_NE(json.output.find("\"rms_Y\": "), std::string::npos) << json.output;
  EXPECT_GT(number("unknowns"), 1000);
  EXPECT_LT(number("unknowns"), 0.9 * static_cast<double>(number("unknowns_none")));
}

}  // namespace
}  // namespace railtab
