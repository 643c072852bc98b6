#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "vsi_fixture.hpp"

namespace railtab {
namespace {

TEST_F(VsiCommand, HelpAndVersionOfEveryCommand) {
  for (const char* command : {"", "contact ", "creep ", "run ", "moving-load ", "report ", "check ", "new "}) {
    const Outcome help = vsi(std::string(command) + "--help");
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_NE(help.output.find("vsi " + std::string(command)), std::string::npos) << help.output;
    const Outcome version = vsi(std::string(command) + "--version");
    EXPECT_EQ(version.exit_code, 0);
    EXPECT_TRUE(version.output.starts_with("railtab ")) << version.output;
  }
}

TEST_F(VsiCommand, StandardOutputThatCannotBeWrittenIsAFailure) {
  for (const char* arguments : {"--version > /dev/full", "run --help > /dev/full"}) {
    EXPECT_EQ(vsi(arguments).exit_code, 1) << arguments;
  }
}

TEST_F(VsiCommand, WrongCommandLines) {
  expect_rejected("", "no command");
  expect_rejected("rnu", "unknown command 'rnu'; did you mean 'run'?\nvsi --help lists the commands\n");
  expect_rejected("help rnu", "unknown command 'rnu'; did you mean 'run'?");
  EXPECT_EQ(vsi("rnu").output.find("Usage"), std::string::npos) << "not all commands";
  expect_rejected("run", "found no SCENE.toml\nusage: vsi run SCENE.toml");
  expect_rejected("run scene.toml --contcat table", "--contcat");
  expect_rejected("run scene.toml --threads -1", "threads");
  expect_rejected("run scene.toml --threads many", "threads");
  expect_rejected("report results.h5", "found no -o REPORT.html\nusage: ");
  expect_rejected("contact pair.h5 -o out", "query");
  expect_rejected("contact pair.h5 --query q.csv -o none/out", "no folder none");
}

TEST_F(VsiCommand, HelpOfACommandByItsName) {
  EXPECT_EQ(vsi("help run").output, vsi("run --help").output);
  EXPECT_EQ(vsi("help").output, vsi("--help").output);
  EXPECT_EQ(vsi("help run").exit_code, 0);
}

TEST_F(VsiCommand, OutputsWithoutAName) {
  write("scene.toml", rigid_scene + "duration = 0.02\n");
  expect_rejected("run scene.toml -o ''", "-o: found an empty name, expected the name of a file");
  expect_rejected("new ''", "vsi new: found an empty name, expected the name of a file");
}

TEST_F(VsiCommand, MissingFiles) {
  expect_rejected("run absent.toml -o out", "absent.toml: found no such file");
  expect_rejected("run '' -o out", "scene: found an empty name, expected the name of a TOML scene");
  expect_rejected("study '' -o out", "plan: found an empty name, expected the name of a plan in TOML");
  expect_rejected("report absent.h5 -o out", "absent.h5");
  expect_rejected("contact absent.h5 --query q.csv -o out", "absent.h5");
  expect_rejected("creep --law polach --query absent.csv -o out", "absent.csv: found no such file");
}

TEST_F(VsiCommand, BridgesAloneNeedNoFilesOfContactAndLoads) {
  write("scene.toml",
        "[contact]\ntable = \"none.h5\"\n[irregularity]\nfile = \"none.csv\"\n[[load]]\nfile = \"none.csv\"\n"
        "[track]\nlength_before = 40.0\nlength_after = 40.0\n[[bridge]]\nlength = 20.0\n");
  expect_rejected("run scene.toml -o out", "scene.toml:2: contact.table: found no file none.h5");
  for (const char* command :
       {"structure scene.toml", "moving-load scene.toml --speed 50 --train hslm-a1", "fmu scene.toml -o track.fmu"}) {
    const Outcome outcome = vsi(command);
    EXPECT_EQ(outcome.exit_code, 0) << command << "\n" << outcome.output;
  }
  write("scene.toml", "[contact]\nmode = \"online\"\n[structure]\nstiffness = \"none.mtx\"\n");
  expect_rejected("structure scene.toml", "scene.toml:4: structure.stiffness: found no file none.mtx");
}

TEST_F(VsiCommand, WhatIsNoRegularFileIsNamed) {
  expect_rejected("run /dev/zero -o out", "/dev/zero: found a device, expected a TOML scene");
  expect_rejected("run . -o out", ".: found a folder");
  expect_rejected("report /dev/zero -o out", "/dev/zero: found a device");
  expect_rejected("creep --law polach --query /dev/zero -o out", "/dev/zero: found a device");
  write("device.toml", rigid_scene + "duration = 0.1\n[irregularity]\nfile = \"/dev/zero\"\n");
  expect_rejected("run device.toml -o out", "device.toml:8: irregularity.file: found a device /dev/zero");
}

// TOML's own reader rejects these numbers.
TEST_F(VsiCommand, NumbersThatAreNoneNameTheirKey) {
  write("large.toml", rigid_scene + "duration = 1e999\n");
  expect_rejected("run large.toml -o out", "large.toml:6: integration.duration: ");
  write("digits.toml", "[contact]\nmode = \"online\"\n[ track . pad ] # of the rail\nkz = 99999999999999999999\n");
  expect_rejected("run digits.toml -o out", "digits.toml:4: track . pad.kz: ");
  write("top.toml", "name = 1e999\n");
  expect_rejected("run top.toml -o out", "top.toml:1: name: ");
  write("nokey.toml", "[contact]\nmode \"online\"\n");
  expect_rejected("run nokey.toml -o out", "nokey.toml:2: Error");
}

TEST_F(VsiCommand, AMillimetreIsNoSpan) {
  write("short.toml", "[contact]\nmode = \"online\"\n[[bridge]]\nlength = 0.001\n");
  expect_rejected("run short.toml -o out",
                  "short.toml:4: bridge.length: found 0.001, expected a number, 0.5 to 1000 m");
}

// Messages that cannot be written do not change what a command says by its exit code.
TEST_F(VsiCommand, ExitCodesOutliveAFullStandardError) {
  write("lost.toml", rigid_scene + "duration = 0.1\n[irregularity]\nfile = \"jump.csv\"\n");
  write("jump.csv", "x[m],y_left[mm],z_left[mm],y_right[mm],z_right[mm]\n-40,300,0,300,0\n40,300,0,300,0\n");
  write("warned.toml", rigid_scene + "duration = 0.02\n[irregularity]\nfile = \"zero.csv\"\n");
  write("zero.csv", "x[m],y_left[mm],z_left[mm],y_right[mm],z_right[mm]\n-40,0,0,0,0\n40,0,0,0,0\n");
  const auto code = [&](const std::string& arguments) {
    const std::string command =
        "cd '" + folder_.string() + "' && '" VSI_COMMAND "' " + arguments + " > out.txt 2> /dev/full";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  };
  EXPECT_EQ(code("run absent.toml"), 2);
  EXPECT_EQ(code("rnu"), 2);
  EXPECT_NE(vsi("run warned.toml -o w.h5").output.find("warning: irregularity.file zero.csv"), std::string::npos);
  EXPECT_EQ(code("run warned.toml -o w.h5"), 0);
  EXPECT_EQ(vsi("run lost.toml -o l.h5").exit_code, 1);
  EXPECT_EQ(code("run lost.toml -o l.h5"), 1);
}

TEST_F(VsiCommand, FilesThatAreNotWhatTheyShouldBe) {
  write("text.h5", "not HDF5");
  write("empty.h5", "");
  write("q.csv", "y,yaw,roll,dz\n0,0,0,1e-5\n");
  for (const char* file : {"text.h5", "empty.h5", "q.csv"}) {
    expect_rejected(std::string("report ") + file + " -o out", file);
    expect_rejected(std::string("contact ") + file + " --query q.csv -o out", file);
  }
}

TEST_F(VsiCommand, WrongScenes) {
  write("key.toml", "[contact]\nmode = \"online\"\n\n[tran]\nsped = 3\n");
  expect_rejected("run key.toml -o out", "key.toml:5: unknown key 'tran.sped'; did you mean 'train.speed'?");
  write("toml.toml", "[contact\nmode = \"online\"\n");
  expect_rejected("run toml.toml -o out", "toml.toml:1: ");
  write("table.toml", "[train]\n");
  expect_rejected("run table.toml -o out", "without contact.table");
  write("online.toml", "[contact]\nmode = \"online\"\n");
  expect_rejected("run online.toml --contact table -o out", "without contact.table");
  expect_rejected("run online.toml --contact tabel -o out", "--contact: found tabel, expected table, online or paper");
  expect_rejected("run online.toml -o none/out", "no folder none");
  write("junk.h5", "junk");
  write("junk.toml", "[contact]\ntable = \"junk.h5\"\n[[bridge]]\n");
  expect_rejected("run junk.toml -o out", "junk.h5");
  expect_rejected("run junk.toml -o junk.h5", "-o junk.h5: found a file that this command reads");
}

TEST_F(VsiCommand, NoOutputDestroysAnInput) {
  write("q.csv", "ratio,ux,uy,phi\n1,0.1,0,0\n");
  write("wheel.txt", "# units: mm\n-70 0\n0 0\n30 0\n60 0\n");
  write("scene.toml",
        "[contact]\nmode = \"online\"\nwheel = \"wheel.txt\"\n[track]\nkind = \"rigid\"\n[integration]\nduration = "
        "1.0\n");
  const std::string rejection = "found a file that this command reads";
  const auto reject = [&](const std::string& arguments) {
    const Outcome outcome = vsi(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_NE(outcome.output.find(rejection), std::string::npos) << arguments << '\n' << outcome.output;
  };
  reject("creep --law polach --query q.csv -o q.csv");
  reject("run scene.toml -o scene.toml");
  reject("run scene.toml -o ./wheel.txt");
  reject("report scene.toml -o scene.toml");
  reject("contact table.h5 --query q.csv -o q.csv");
}

// Rails end where the modelled track does: a run must not go on beyond.
TEST_F(VsiCommand, ARunThatLeavesTheTrackIsRejected) {
  write("long.toml", "[contact]\nmode = \"online\"\n[track]\nlength_after = 12.0\n[[bridge]]\nlength = 20.0\n");
  expect_rejected("run long.toml -o out", "track.length_after");
  expect_rejected("run long.toml --plan -o out", "track.length_after");
  write("steps.toml",
        "[contact]\nmode = \"online\"\n[track]\nkind = \"rigid\"\n[integration]\nduration = 1e5\ntime_step = 1e-5\n");
  expect_rejected("run steps.toml --plan -o out", "integration.time_step");
}

TEST_F(VsiCommand, OptionsWithoutEffectAreRejected) {
  write("scene.toml", rigid_scene + "duration = 0.01\n");
  expect_rejected("run scene.toml --plan --resume", "--plan: found --resume too");
  expect_rejected("critical-speed scene.toml --shift 0.003", "--shift: found no --limit-cycles");
  expect_rejected("critical-speed scene.toml --max-cycles 5", "--max-cycles: found no --limit-cycles");
}

TEST_F(VsiCommand, CreepAnswersFromTheShippedTableAndSaysWhereItDoesNot) {
  write("q.csv", "ratio,ux,uy,phi\n1,0.1,0,0\n900,0.1,0,0\n2000,0.1,0,0\n");
  const Outcome outcome = vsi("creep --query q.csv -o r.csv");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_NE(outcome.output.find("2 of them outside the table"), std::string::npos) << outcome.output;
  std::ifstream result(folder_ / "r.csv");
  std::vector<std::string> lines;
  for (std::string line; std::getline(result, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_EQ(lines[0], "fx,fy,mz,source");
  EXPECT_EQ(lines[1].substr(lines[1].rfind(',')), ",table");
  EXPECT_EQ(lines[2].substr(lines[2].rfind(',')), ",blend");
  EXPECT_EQ(lines[3].substr(lines[3].rfind(',')), ",polach");
  EXPECT_EQ(lines[1][0], '-') << "positive creepage pushes the wheel back";
}

TEST_F(VsiCommand, WrongCreepLawsAndTablesAreRejected) {
  write("q.csv", "ratio,ux,uy,phi\n1,0.1,0,0\n");
  write("junk.h5", "junk");
  expect_rejected("creep absent.h5 --query q.csv -o out", "absent.h5");
  expect_rejected("creep junk.h5 --query q.csv -o out --law table", "junk.h5");
  expect_rejected("creep --query q.csv -o out --poisson 0.3", "Poisson's ratio");
  expect_rejected("creep --query q.csv -o out --law kalker", "kalker");
  expect_rejected("creep table.h5 --query q.csv -o out --law polach",
                  "--law polach: found with the creep table table.h5");
  expect_rejected("creep --query q.csv -o out --law polach --poisson 0.7", "--poisson");
}

TEST_F(VsiCommand, AByteOrderMarkBeforeTheHeaderIsNoneOfItsColumns) {
  write("q.csv", "\xEF\xBB\xBFratio,ux,uy,phi\r\n1,0.1,0,0\r\n");
  const Outcome outcome = vsi("creep --query q.csv -o r.csv");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
}

TEST_F(VsiCommand, WrongQueriesNameTheirLine) {
  const auto reject = [&](const std::string& text, const std::string& message) {
    write("q.csv", text);
    expect_rejected("creep --law polach --query q.csv -o out", message);
  };
  reject("", "q.csv: found no row of numbers");
  reject("ratio,ux,uy,phi\n", "q.csv: found no row of numbers");
  reject("ratio,ux,uy\n1,2,3\n", "q.csv:1: found 3 columns");
  reject("ratio,ux,uy,spin\n1,2,3,4\n", "q.csv:1: found column 'spin'");
  reject("ratio,ux,uy,ux\n1,2,3,4\n", "q.csv:1: found column 'ux' twice");
  reject("ratio,ux,uy,phi\n1,0,0,0\n1,0,0\n", "q.csv:3: found 3 columns");
  reject("ratio,ux,uy,phi\n1,0,zero,0\n", "q.csv:2: column uy: found 'zero'");
  reject("ratio,ux,uy,phi\n1,0,nan,0\n", "q.csv:2: column uy: found 'nan'");
  reject("ratio,ux,uy,phi\n1,,0,0\n", "q.csv:2: column ux: found ''");
  reject("# a comment\nratio,ux,uy,phi\n\n0,0,0,0\n", "q.csv:4: found ratio = 0, expected a/b > 0");
}

TEST_F(VsiCommand, CreepForcesOfEveryLawInTheColumnsOfTheContract) {
  write("q.csv", "phi, ux, uy, ratio\n0,1e-3,0,1\n0,1e3,0,1\n");
  for (const char* law : {"linear", "polach", "fastsim"}) {
    const Outcome outcome = vsi(std::string("creep --query q.csv -o r.csv --json --law ") + law);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    EXPECT_EQ(outcome.output,
              "{\"queries\": 2, \"law\": \"" + std::string(law) + "\", \"outside_table\": 0, \"output\": \"r.csv\"}\n");
    std::ifstream result(folder_ / "r.csv");
    std::string header, small;
    std::getline(result, header);
    std::getline(result, small);
    EXPECT_EQ(header, "fx,fy,mz,source");
    // c11 of a circular patch is near 4.2: a creepage of 1e-3 along x pulls back by about 4.2e-3
    EXPECT_NEAR(std::atof(small.c_str()), -4.2e-3, 0.4e-3) << law;
    EXPECT_TRUE(small.ends_with(law)) << small;
  }
}

TEST_F(VsiCommand, ATableAndProfilesAreTwoPairs) {
  write("two.toml", "[contact]\ntable = \"t.h5\"\nrail_inclination = \"1:20\"\n");
  write("t.h5", "");
  expect_rejected("run two.toml -o out", "two.toml:3: contact.rail_inclination: found contact.table too");
  write("gauge.toml", "[contact]\nmode = \"online\"\ntable = \"t.h5\"\ndimensions.track_gauge = 1.432\n");
  expect_rejected("run gauge.toml -o out", "gauge.toml:4: contact.dimensions.track_gauge: found contact.table too");
}

TEST_F(VsiCommand, RunSaysWhereItsTimeWent) {
  write("scene.toml", rigid_scene + "duration = 0.05\n");
  const Outcome outcome = vsi("run scene.toml -o r.h5");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  for (const char* part :
       {"set-up", "structure", "contact look-ups", "contact forces, tangents", "vehicle", "output"}) {
    EXPECT_NE(outcome.output.find(part), std::string::npos) << part << '\n' << outcome.output;
  }
  EXPECT_EQ(outcome.output.find("pre-roll"), std::string::npos) << outcome.output;  // rigid rails need none
}

TEST_F(VsiCommand, RunSaysWhatItsPreRollTook) {
  write("scene.toml",
        "[contact]\nmode = \"online\"\n[track]\nlength_before = 60.0\nlength_after = 10.0\n[[bridge]]\nlength = "
        "10.0\n[integration]\nduration = 0.01\n");
  const Outcome outcome = vsi("run scene.toml -o r.h5");
  EXPECT_NE(outcome.output.find("of it pre-roll"), std::string::npos) << outcome.output;
  const Outcome again = vsi("run scene.toml -o r.h5 --quiet --json 2> /dev/null");
  const auto seconds = nlohmann::json::parse(again.output).at("seconds");
  EXPECT_GT(seconds.at("pre_roll"), 0.0);
  EXPECT_LT(seconds.at("pre_roll"), seconds.at("setup"));
}

TEST_F(VsiCommand, RepairsOfAMeasuredProfileAreSaid) {
  // A cone of 1:40, one of its points twice.
  write("wheel.txt", "# units: mm\n-70 1.75\n-35 0.875\n0 0\n0 0\n30 -0.75\n60 -1.5\n");
  write("scene.toml",
        "[contact]\nmode = \"online\"\nwheel = \"wheel.txt\"\n[track]\nkind = \"rigid\"\n[integration]\nduration = "
        "0.01\n");
  const Outcome outcome = vsi("run scene.toml -o r.h5 --json");
  EXPECT_NE(outcome.output.find("vsi run: note: "), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find("wheel.txt"), std::string::npos) << outcome.output;
}

// The signal goes to the program alone, once its results file is there.
TEST_F(VsiCommand, CtrlCEndsARunThatCanBeTakenUpAgain) {
  write("scene.toml", rigid_scene + "duration = 4.0\n[output]\nevery = 3\n");
  const std::string interrupted =
      "--version; '" VSI_COMMAND
      "' run scene.toml -o r.h5 --json 2>&1 & pid=$!; while [ ! -e r.h5 ] && kill -0 $pid; do "
      "sleep 0.01; done; kill -INT $pid; wait $pid; echo \"code $?\"";
  const Outcome outcome = vsi(interrupted);
  ASSERT_NE(outcome.output.find("code 130"), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find("--resume"), std::string::npos) << outcome.output;

  const Outcome resumed = vsi("run scene.toml -o r.h5 --json --resume");
  EXPECT_EQ(resumed.exit_code, 0) << resumed.output;
  // The time that it names is that of the step from which it counts, recorded (every third one) or not.
  const auto number_after = [&](const std::string& words) {
    const std::size_t at = resumed.output.find(words);
    return at == std::string::npos ? -1.0 : std::stod(resumed.output.substr(at + words.size()));
  };
  const double from = number_after("\"counted_from_step\": ");
  EXPECT_GT(from, 0.0) << resumed.output;
  EXPECT_NEAR(number_after("resumed at t = "), 5e-4 * from, 1e-6) << resumed.output;
  // First and last record, the last at the end of the run though no multiple of output.every.
  EXPECT_NE(resumed.output.find("\"simulated_time\": 4"), std::string::npos) << resumed.output;
}

// A bump before the stretch that is judged counts for no wheel, not even for those that meet it while others are
// beyond.
TEST_F(VsiCommand, TheHeadlineBeginsWhereJudgingDoes) {
  std::string bump = "x[m],y_left[mm],z_left[mm],y_right[mm],z_right[mm]\n";
  for (int x = -60; x <= 100; ++x) bump += std::to_string(x) + (x == 4 ? ",0,-1,0,-1\n" : ",0,0,0,0\n");
  write("bump.csv", bump);
  const std::string rough = rigid_scene + "duration = 0.7\n[irregularity]\nfile = \"bump.csv\"\n";
  const auto headline = [&](const std::string& keys) {
    write("scene.toml", rough + keys);
    const Outcome run = vsi("run scene.toml -o results.h5 --json");
    EXPECT_EQ(run.exit_code, 0) << run.output;
    const nlohmann::json of_run = nlohmann::json::parse(run.output.substr(run.output.find('{')));
    // and the same from the file
    EXPECT_EQ(vsi("report results.h5 -o report.html -q").exit_code, 0);
    std::ifstream page(folder_ / "report.html");
    const std::string text{std::istreambuf_iterator<char>(page), {}};
    EXPECT_NE(text.find(of_run["extremes_of"].get<std::string>()), std::string::npos) << of_run["extremes_of"];
    return of_run;
  };
  const nlohmann::json whole = headline(""), judged = headline("[assessment]\nbegin = 30.0\n");
  EXPECT_EQ(whole["extremes_of"], "the recorded steps; Q, Y/Q and unloading of all steps");
  EXPECT_EQ(judged["extremes_of"],
            "the recorded steps; Q, Y/Q and unloading of all steps; wheels and car bodies from x = 30 m");
  const double speed = whole["distance"].get<double>() / whole["simulated_time"].get<double>();
  EXPECT_GT(judged["max_Q"]["time"].get<double>(), 30.0 / speed - 1e-3);
  EXPECT_LT(whole["max_wheel_unloading"]["time"].get<double>(), 30.0 / speed);
  EXPECT_LT(judged["max_wheel_unloading"]["value"].get<double>(),
            0.5 * whole["max_wheel_unloading"]["value"].get<double>());
}

TEST_F(VsiCommand, ACreepTableOfAnotherTypeNamesTheKeyThatAsksForIt) {
  write("scene.toml", rigid_scene + "duration = 0.01\n");
  ASSERT_EQ(vsi("run scene.toml -o other.h5 -q").exit_code, 0);
  write("wrong.toml",
        "[contact]\nmode = \"online\"\ncreep_law = \"table\"\ncreep_table = \"other.h5\"\n[track]\nkind = \"rigid\"\n"
        "[integration]\nduration = 0.01\n");
  expect_rejected("run wrong.toml -o out", "wrong.toml:4: contact.creep_table: other.h5: found a file of type");
}

// What stands in the way of results must be results; a link is followed, to where there is nothing yet, too.
TEST_F(VsiCommand, ResultsReplaceNothingButResults) {
  write("scene.toml", rigid_scene + "duration = 0.01\n");
  std::filesystem::copy_file(RAILTAB_SOURCE_DIR "/tables/data/creep_table_nu028.h5", folder_ / "table.h5");
  const std::uintmax_t bytes = std::filesystem::file_size(folder_ / "table.h5");
  const auto rejected = [&](const std::string& arguments, const std::string& words) {
    const Outcome outcome = vsi(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_NE(outcome.output.find(words), std::string::npos) << outcome.output;
  };
  for (const char* plan : {"", " --plan"}) {
    rejected("run scene.toml -o table.h5" + std::string(plan),
             "-o table.h5: found a file of type railtab-creep-table, expected a new name");
  }
  write("notes.txt", "mine");
  rejected("run scene.toml -o notes.txt", "a file of another kind");
  write("q.csv", "ratio,ux,uy,phi\n1,0.1,0,0\n");
  rejected("creep --law polach --query q.csv -o table.h5", "a table or results of railtab");
  rejected("creep --law polach --query q.csv -o notes.txt", "notes.txt: found a file that begins with 'mine'");
  EXPECT_EQ(std::filesystem::file_size(folder_ / "table.h5"), bytes);

  write("empty.h5", "");
  EXPECT_EQ(vsi("run scene.toml -o empty.h5 -q").exit_code, 0) << "nothing is lost";
  EXPECT_EQ(vsi("run scene.toml -o empty.h5 -q").exit_code, 0) << "results replace results";
  std::filesystem::create_directory(folder_ / "elsewhere");
  std::filesystem::create_symlink("elsewhere/r.h5", folder_ / "link.h5");
  EXPECT_EQ(vsi("run scene.toml -o link.h5 -q").exit_code, 0);
  EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "link.h5"));
  EXPECT_EQ(vsi("report elsewhere/r.h5 -o link.html -q").exit_code, 0);
  EXPECT_EQ(vsi("report elsewhere/r.h5 -o link.html -q").exit_code, 0) << "a report replaces a report";
  rejected("report elsewhere/r.h5 -o notes.txt", "notes.txt: found a file that begins with 'mine'");
  rejected("report elsewhere/r.h5 -o q.csv", "q.csv: found a file that begins with 'ratio,ux,uy,phi'");
  EXPECT_EQ(std::filesystem::file_size(folder_ / "notes.txt"), 4U);
  std::filesystem::create_symlink("circle.h5", folder_ / "circle.h5");
  rejected("run scene.toml -o circle.h5", "links in a circle");
}

// 5 m/s² turn a coach over, whose centre of gravity is 1.8 m above rails 1.5 m apart: that is named, not the profiles.
TEST_F(VsiCommand, ALateralAccelerationThatOverturnsTheTrainIsNamed) {
  write("curve.toml", rigid_scene + "duration = 0.01\n[train]\nlateral_acceleration = 5.0\n");
  const Outcome outcome = vsi("run curve.toml -o r.h5 -q");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.output.find("without the lateral acceleration of 5 m/s²"), std::string::npos) << outcome.output;
  EXPECT_EQ(outcome.output.find("wheels fit the rails"), std::string::npos) << outcome.output;
}

// A scene without a static equilibrium: its run cannot begin, and what another run has computed stays.
TEST_F(VsiCommand, ARunThatCannotBeginReplacesNothing) {
  write("jump.csv", "x[m],y_left[mm],z_left[mm],y_right[mm],z_right[mm]\n-40,300,0,300,0\n40,300,0,300,0\n");
  write("good.toml", rigid_scene + "duration = 0.01\n");
  write("lost.toml", rigid_scene + "duration = 0.01\n[irregularity]\nfile = \"jump.csv\"\n");
  ASSERT_EQ(vsi("run good.toml -o r.h5 -q").exit_code, 0);
  const auto contents = [&] {
    std::ifstream in(folder_ / "r.h5", std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  const std::string before = contents();
  const Outcome lost = vsi("run lost.toml -o r.h5");
  EXPECT_EQ(lost.exit_code, 1);
  EXPECT_NE(lost.output.find("no static equilibrium"), std::string::npos) << lost.output;
  EXPECT_NE(lost.output.find("r.h5 stays as it was"), std::string::npos) << lost.output;
  EXPECT_EQ(lost.output.find("replaces"), std::string::npos) << lost.output;
  EXPECT_TRUE(contents() == before);
  EXPECT_EQ(vsi("run lost.toml -o new.h5 -q").exit_code, 1);
  EXPECT_EQ(vsi("report new.h5 -o new.html -q").exit_code, 0) << "results that give the reason";
}

// A terminal obeys control characters: those of a file are shown, not sent.
TEST_F(VsiCommand, TextsOfFilesAreShownWithoutControlCharacters) {
  const std::string name = "name = \"red\\u001b[31m\\u009b2J\\u0007 <b>\"\n";
  write("scene.toml", name + rigid_scene + "duration = 0.01\n");
  const auto control = [](const std::string& text) {
    return text.find_first_of("\x1b\x07\x7f") != std::string::npos || text.find("\xC2\x9B") != std::string::npos;
  };
  const Outcome plan = vsi("run scene.toml --plan");
  EXPECT_TRUE(plan.output.starts_with("red\\x1B[31m\\xC2\\x9B2J\\x07 <b>: ")) << plan.output;
  for (const char* arguments : {"run scene.toml --plan --json", "run scene.toml -o r.h5", "report r.h5 -o r.html"}) {
    const Outcome outcome = vsi(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    EXPECT_FALSE(control(outcome.output)) << arguments;
  }
  EXPECT_NE(vsi("run scene.toml --plan --json").output.find("red\\u001b[31m\\u009b2J\\u0007 <b>"), std::string::npos);
  std::ifstream page(folder_ / "r.html");
  const std::string html(std::istreambuf_iterator<char>(page), {});
  EXPECT_FALSE(control(html));
  EXPECT_NE(html.find("<title>red\\x1B[31m\\xC2\\x9B2J\\x07 &lt;b&gt;"), std::string::npos);
  EXPECT_NE(html.find("<meta name=\"generator\" content=\"railtab: run report\">"), std::string::npos);
}

TEST_F(VsiCommand, ARunIsNotResumedWithOtherInputFiles) {
  std::filesystem::copy_file(RAILTAB_SOURCE_DIR "/docs/examples/demo_irregularity.csv", folder_ / "rough.csv");
  write("scene.toml", rigid_scene + "duration = 0.02\n[irregularity]\nfile = \"rough.csv\"\n");
  ASSERT_EQ(vsi("run scene.toml -o r.h5 -q").exit_code, 0);
  EXPECT_EQ(vsi("run scene.toml -o r.h5 -q --resume").exit_code, 0);
  std::ofstream(folder_ / "rough.csv", std::ios::app) << "\n";
  const Outcome outcome = vsi("run scene.toml -o r.h5 --resume");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.output.find("r.h5: found results made with other contents of rough.csv"), std::string::npos)
      << outcome.output;
}

TEST_F(VsiCommand, WhatTheModelRejectsNamesTheScene) {
  write("wheels.toml", "[train]\nvehicle = \"chinese-high-speed-car\"\n" + rigid_scene + "duration = 1.0\n");
  expect_rejected("run wheels.toml -o out", "wheels.toml: contact.dimensions.nominal_radius: found 0.46 m");
}

TEST_F(VsiCommand, MessagesNameWhatWasFound) {
  write("q.csv", "ratio;ux;uy;phi\n1;0.1;0;0\n");
  expect_rejected("creep --query q.csv -o out",
                  "q.csv:1: found columns separated by semicolons, expected the columns ratio");
  expect_rejected("creep --query q.csv -o out --law kalker", "--law: found kalker, expected table, polach");
  expect_rejected("run . -o out", ".: found a folder, expected a TOML scene");
  const auto rejected = [&](const std::string& more, const std::string& text) {
    write("scene.toml", rigid_scene + "duration = 0.01\n" + more);
    expect_rejected("run scene.toml -o out", text);
  };
  rejected("[output]\nbodies = [1]\n", "scene.toml:8: output.bodies: found 1 in the list, expected a list of texts");
  write("rough.csv", "x[m];y_left[mm];z_left[mm];y_right[mm];z_right[mm]\n0;0;0;0;0\n1;0;0;0;0\n");
  rejected("[irregularity]\nfile = \"rough.csv\"\n", "rough.csv:1: found columns separated by semicolons");
  write("rough.csv", "x[m],y_left[m],z_left[m],y_right[m],z_right[m]\n0,0,0,0,0\n1,0,2,0,0\n");
  rejected("[irregularity]\nfile = \"rough.csv\"\n", "rough.csv:3: column z_left: found 2 m, expected -0.5 to 0.5 m");
  write("wind.csv", "t[s],Fy[kN]\n0,0\n1,2e6\n");
  rejected("[[load]]\nfile = \"wind.csv\"\n", "wind.csv:3: column Fy: found 2000000 kN, expected -100000 to 100000 kN");
  write("quake.csv", "t[s],z[m]\n0,0\n1,0.1\n2,35\n");
  rejected("[[ground_motion]]\nfile = \"quake.csv\"\n", "quake.csv:4: column z: found 35 m, expected -20 to 20 m");
  write("nu.toml",
        "[contact]\nmode = \"online\"\nmaterial.nu = 0.3\n[track]\nkind = \"rigid\"\n[integration]\nduration = 0.1\n");
  expect_rejected("run nu.toml -o out", "tablegen creep --poisson 0.3 makes it (contact.creep_table)");
}

TEST_F(VsiCommand, ResultsThatARunReplacesAreNamed) {
  write("scene.toml", rigid_scene + "duration = 0.005\n");
  const std::string note = "note: r.h5 holds the results of a whole run, which this one replaces";
  EXPECT_EQ(vsi("run scene.toml -o r.h5").output.find(note), std::string::npos);
  EXPECT_NE(vsi("run scene.toml -o r.h5").output.find(note), std::string::npos);
  EXPECT_EQ(vsi("run scene.toml -o r.h5 --resume").output.find(note), std::string::npos);
  write("wrong.toml", rigid_scene + "duration = 0.005\n[output]\nbodies = [\"nothing\"]\n");
  const Outcome wrong = vsi("run wrong.toml -o r.h5");  // nothing is replaced
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_EQ(wrong.output.find("note:"), std::string::npos) << wrong.output;
}

TEST_F(VsiCommand, VehicleShowsWhatFollowsFromItsFile) {
  const Outcome list = vsi("vehicle");
  EXPECT_EQ(list.exit_code, 0);
  EXPECT_TRUE(list.output.find("manchester-coach") != std::string::npos) << list.output;
  const Outcome shown = vsi("vehicle metro-gz18");
  EXPECT_EQ(shown.exit_code, 0);
  for (const char* part : {"55685 kg, 22.8 m over couplers, wheels of 0.42 m radius", "68.284         13.921",
                           "mm  primary suspension", "car body bounce", "not linear: yaw damper along x",
                           "within range: mass 55685 kg", "bogie.height = 0.5 m: assumed, source: none", "SIMPACK"}) {
    EXPECT_NE(shown.output.find(part), std::string::npos) << part << "\n" << shown.output;
  }
  const Outcome json = vsi("vehicle velaro-e-coach --json --modes 2");
  EXPECT_EQ(json.exit_code, 0);
  for (const char* part :
       {"{\"name\": \"velaro-e-coach\"", "\"motion\": \"vertical\"", "\"top_speed\": 97.2", "\"dofs\": 10",
        "\"axle_load\": 155", "\"static_deflections\": [{\"suspension\": ", "\"standing\": \"verified\""}) {
    EXPECT_NE(json.output.find(part), std::string::npos) << part << "\n" << json.output;
  }
}

TEST_F(VsiCommand, VehicleSaysWhatNoVehicleHas) {
  EXPECT_EQ(vsi("vehicle manchester-coach --toml > mine.toml").exit_code, 0);
  const auto changed = [&](const std::string& what, const std::string& by) {
    std::ifstream in(folder_ / "mine.toml");
    std::string text{std::istreambuf_iterator<char>(in), {}};
    text.erase(text.find("[check]"));
    text.replace(text.find(what), what.size(), by);
    write("changed.toml", text);
    const Outcome outcome = vsi("vehicle changed.toml");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    return outcome.output;
  };
  const auto expect = [](const std::string& output, const std::string& text) {
    EXPECT_NE(output.find(text), std::string::npos) << output;
  };
  expect(changed("mass = 32000.0", "mass = 32.0"),
         "vsi vehicle: warning: manchester-coach: the car body of 32 kg is lighter than the wheelsets, 7252 kg in all");
  expect(changed("half_wheelbase = ", "half_wheelbase = 0.1 # "), "the wheels of wheelset-1 and wheelset-2 overlap");
  expect(changed("Jz = ", "Jz = 1.0 # "), "is more than twice the sum of the other two moments of inertia");
  const std::string soft = changed("kz = 0.430e6", "kz = 4.3e3");
  expect(soft, "the springs of secondary suspension deflect by 18");
  EXPECT_EQ(soft.find("primary suspension deflect"), std::string::npos) << soft;
  write("scene.toml", "[train]\nvehicle = \"changed.toml\"\n" + rigid_scene + "duration = 0.1\n");
  expect(vsi("run scene.toml --plan").output,
         "vsi run: warning: manchester-coach: the springs of secondary suspension");
  EXPECT_EQ(vsi("vehicle manchester-coach").output.find("warning"), std::string::npos);
}

// As a run rejects it.
TEST_F(VsiCommand, VehicleThatMissesItsChecksIsWrongInput) {
  EXPECT_EQ(vsi("vehicle manchester-coach --toml | sed 's/^mass = 32000.0/mass = 33000.0/' > heavy.toml").exit_code, 0);
  for (const char* form : {"", " --json"}) {
    const Outcome outcome = vsi(std::string("vehicle heavy.toml") + form);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.output;
    EXPECT_NE(outcome.output.find("vsi: heavy.toml: check: mass: found 45482 kg by the file's own values"),
              std::string::npos)
        << outcome.output;
  }
  expect_rejected("vehicle manchester-coach --toml --json", "--json: found --toml too, expected one of them");
}

TEST_F(VsiCommand, VehicleWritesAFileThatScenesAndItselfTake) {
  EXPECT_EQ(vsi("vehicle ordinary-coach --toml > mine.toml").exit_code, 0);
  EXPECT_EQ(vsi("vehicle mine.toml").output, vsi("vehicle ordinary-coach").output);
  write("scene.toml",
        "[train]\nvehicle = \"mine.toml\"\n[contact]\nnormal = \"rigid\"\n[track]\nkind = \"rigid\"\n"
        "[integration]\nduration = 0.05\n");
  EXPECT_EQ(vsi("run scene.toml -o r.h5 --quiet").exit_code, 0);
  expect_rejected("vehicle nowhere.toml", "nowhere.toml");
  expect_rejected("vehicle nothing", "vehicle: found 'nothing', expected a file that ends with .toml, or one of ");
  write("torn.toml", "name = \"torn\"\n");
  expect_rejected("vehicle torn.toml", "torn.toml:1: description: found nothing, expected a text");
}

}  // namespace
}  // namespace railtab
