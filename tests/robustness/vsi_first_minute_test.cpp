// What a new user meets first: vsi FILE, vsi new, vsi check, and names of outputs that contradict their content.
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "vsi_fixture.hpp"

namespace railtab {
namespace {

class FirstMinute : public VsiCommand {
 protected:
  void expect_said(const std::string& arguments, std::initializer_list<const char*> texts) const {
    const Outcome outcome = vsi(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << arguments << "\n" << outcome.output;
    for (const char* text : texts) EXPECT_NE(outcome.output.find(text), std::string::npos) << text << outcome.output;
  }
  [[nodiscard]] std::string text_of(const std::string& name) const {
    std::ifstream in(folder_ / name);
    return {std::istreambuf_iterator<char>(in), {}};
  }
};

TEST_F(FirstMinute, EveryKindOfFileIsNamedWithItsCommands) {
  write("s.toml", "name = \"A scene\"\n" + rigid_scene + "duration = 0.02\n");
  expect_said("s.toml",
              {"s.toml: a scene", "A scene", "> vsi check s.toml", "> vsi run s.toml", "> vsi critical-speed s.toml"});
  ASSERT_EQ(vsi("run s.toml -o r.h5 -q").exit_code, 0);
  expect_said("r.h5", {"r.h5: results of a run", "A scene: complete", "8 wheels", "> vsi report r.h5 -o report.html"});
  ASSERT_EQ(vsi("export r.h5 -o run.pvd -q").exit_code, 0);
  expect_said("run.pvd", {"instants of a run for ParaView", "> paraview run.pvd"});
  ASSERT_EQ(vsi("r.h5 --json > r.json").exit_code, 0);
  expect_said("r.json", {"values of a command (JSON)"});
  ASSERT_EQ(vsi("report r.h5 -o r.html -q").exit_code, 0);
  expect_said("r.html", {"a page of railtab: run report"});
  write("t.html",
        "<!DOCTYPE html><html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"generator\" "
        "content=\"railtab: contact geometry table\">\n<title>");
  expect_said("t.html", {"a page of railtab: contact geometry table", "> open it in a browser"});
  ASSERT_EQ(vsi("check s.toml -o s.svg -q").exit_code, 0);
  expect_said("s.svg", {"a picture (SVG)", "> open it in a browser"});
  ASSERT_EQ(run("'" VSI_COMMAND "' vehicle manchester-coach --toml > v.toml").exit_code, 0);
  expect_said("v.toml", {"v.toml: a vehicle", "> vsi vehicle v.toml"});
  write("K.mtx", "%%MatrixMarket matrix coordinate real symmetric\n1 1 1\n1 1 2.0\n");
  expect_said("K.mtx", {"a sparse matrix"});
  write("K1.mtx", "1,1, 1,1, 2.0\n");
  expect_said("K1.mtx", {"a matrix, of Abaqus if it is by *MATRIX OUTPUT", "structure.format = \"abaqus\""});
  write("wheel.prw", "header.begin\n");
  expect_said("wheel.prw", {"a wheel profile", "> tablegen geometry --wheel wheel.prw"});
  write("q.csv", "ratio,ux,uy,phi\n1,0,0,0\n");
  expect_said("q.csv", {"queries of creep forces", "> vsi creep --query q.csv"});
  write("modes.csv", "mode,frequency,mass\n1,5,1\n");
  expect_said("modes.csv", {"natural modes of a structure", "> a scene's structure.mode_table = \"modes.csv\""});
  write("commented.csv", "# made by hand\n\ny,z,roll,yaw\n0,0,0,0\n");
  expect_said("commented.csv", {"queries of the contact", "y,z,roll,yaw"});
  write("points.txt", "# y z\n-60.5 20.1\n-59.0;19.0\n");
  expect_said("points.txt", {"points of two columns, as of a profile", "--wheel points.txt", "--rail points.txt"});
  const nlohmann::json json = nlohmann::json::parse(vsi("r.h5 --json").output);
  EXPECT_EQ(json["kind"], "results of a run");
  EXPECT_EQ(json["commands"][0], "vsi report r.h5 -o report.html");
}

TEST_F(FirstMinute, WhatIsNoFileOfRailtabIsSaid) {
  write("notes", "milk, bread\n");
  expect_rejected("notes", "notes: found a file that begins with 'milk, bread', expected a scene");
  write("empty", "");
  expect_rejected("empty", "found an empty file");
  write("broken.toml", "[train\n");
  expect_rejected("broken.toml", "broken.toml:1: ");
  expect_rejected("absent.toml", "absent.toml: found no such file, expected a file, or a command");
  expect_rejected("./", "./: found a folder");
  expect_rejected("absent", "unknown command 'absent'");
  std::filesystem::create_directory(folder_ / "ex");
  expect_rejected("ex", "ex: found a folder, expected a file, as of those in this folder, or a command (vsi --help)");
}

TEST_F(FirstMinute, ATrainBehindTheEndOfItsRunIsSaid) {
  for (const char* start : {"60", "500"}) {
    write("late.toml", std::string("[train]\nstart = ") + start +
                           "\n[contact]\nmode = \"online\"\n[[bridge]]\nlength = 32\n"
                           "[irregularity]\nspectrum = \"german-low\"\n");
    expect_rejected("check late.toml", "late.toml:2: train.start: found the last wheelset at x = ");
  }
}

TEST_F(FirstMinute, SpansUnlikeABridgeAreWarnedOf) {
  const std::string scene = "[train]\nstart = -2\n[contact]\nmode = \"online\"\n[[bridge]]\nlength = 32\n";
  write("as_it_is.toml", scene);
  EXPECT_EQ(vsi("check as_it_is.toml").output.find("first natural frequency"), std::string::npos);
  write("total_mass.toml", scene + "mass = 1093e3\n");
  expect_said("check total_mass.toml",
              {"warning: a span of 32 m has its first natural frequency at 0.902 Hz", "3.03 to 7.09 Hz"});
}

TEST_F(FirstMinute, AMisspeltKeyOfAVehicleIsNamed) {
  std::string vehicle = vsi("vehicle manchester-coach --toml").output;
  vehicle.replace(vehicle.find("half_wheelbase"), 14, "half_wheel_base");
  write("coach.toml", vehicle);
  expect_rejected("vehicle coach.toml", "layout.half_wheelbase: found nothing, but 'layout.half_wheel_base'");
}

TEST_F(FirstMinute, ANewSceneIsValidAndRuns) {
  expect_said("new s.toml --train manchester-coach --coaches 2 --span 32 --spans 2 --speed 160",
              {"Scene: s.toml. vsi check s.toml draws it"});
  const std::string scene = text_of("s.toml");
  EXPECT_NE(scene.find("# A scene of railtab"), std::string::npos);
  EXPECT_NE(scene.find("speed_kmh = 160"), std::string::npos);
  expect_said("check s.toml", {"The scene is valid", "bridge", "recorded: deck-midspan-2 at x = 48 m"});
  const nlohmann::json json = nlohmann::json::parse(vsi("check s.toml --json").output);
  EXPECT_EQ(json["spans"], (nlohmann::json{{0.0, 32.0}, {32.0, 64.0}}));
  EXPECT_EQ(json["wheelsets"].size(), 8u);
  EXPECT_LT(json["track"][0], json["wheelsets"][7]) << "the whole train stands on the track";
  const double rear_at_end = json["wheelsets"][7].get<double>() + json["travel"].get<double>();
  EXPECT_GE(rear_at_end, 64.0) << "and leaves the bridge";
  expect_rejected("new s.toml", "s.toml: found a file, expected a new name");
}

TEST_F(FirstMinute, ANewSceneFindsItsVehicleFromWhereItStands) {
  std::filesystem::create_directory(folder_ / "sub");
  ASSERT_EQ(run("'" VSI_COMMAND "' vehicle manchester-coach --toml > sub/mine.toml").exit_code, 0);
  ASSERT_EQ(run("cd sub && '" VSI_COMMAND "' new ../s.toml -q --train mine.toml").exit_code, 0);
  EXPECT_NE(text_of("s.toml").find("vehicle = \"sub/mine.toml\""), std::string::npos) << text_of("s.toml");
  expect_said("check s.toml", {"The scene is valid"});
}

TEST_F(FirstMinute, ANewSceneWithoutABridgeIsValid) {
  for (const char* train : {"ice3-like-coach", "freight-21t", "traxx-locomotive"}) {
    const std::string name = std::string(train) + ".toml";
    EXPECT_EQ(vsi("new " + name + " -q --train " + train).exit_code, 0);
    expect_said("check " + name, {"The scene is valid"});
  }
}

TEST_F(FirstMinute, ModesThatAreWrittenAreRead) {
  const std::string track = "[contact]\nnormal = \"rigid\"\n[integration]\nduration = 0.01\n";
  write("s.toml", track + "[[bridge]]\nlength = 20\n");
  const Outcome outcome = vsi("structure s.toml --modes 12 -o span");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const std::size_t section = outcome.output.find("[structure]");
  ASSERT_NE(section, std::string::npos) << outcome.output;
  write("m.toml", track + outcome.output.substr(section));
  const nlohmann::json own = nlohmann::json::parse(vsi("structure s.toml --modes 12 --json").output);
  const nlohmann::json read = nlohmann::json::parse(vsi("structure m.toml --modes 12 --json").output);
  for (std::size_t m = 0; m < 12; ++m) {
    const double frequency = own["frequencies"][m];
    EXPECT_NEAR(read["frequencies"][m], frequency, 1e-9 * frequency);
  }
  EXPECT_TRUE(read["mass_z"].is_null());
  EXPECT_NE(read["left_out"][0].get<std::string>().find("static flexibility beyond the modes"), std::string::npos);
  EXPECT_EQ(vsi("structure s.toml --modes 12 -o span -q").exit_code, 0) << "modes replace modes";
  write("damped.toml", track + "[[bridge]]\nlength = 20\ndamping_ratio = 0.15\n");
  const std::string damped = vsi("structure damped.toml --modes 40 -o damped").output;
  EXPECT_NE(damped.find("of 40 modes, "), std::string::npos) << damped;
  write("m2.toml", track + damped.substr(damped.find("[structure]")));
  EXPECT_EQ(vsi("structure m2.toml").exit_code, 0);
  expect_rejected("structure m.toml -o again", "-o: found a scene whose structure is given by modes");
  write("span.modes.csv", "mine\n");
  expect_rejected("structure s.toml -o span", "span.modes.csv: found a file that begins with 'mine'");
  expect_rejected("structure s.toml --modes 0 -o again", "--modes: found 0 with -o");
}

TEST_F(FirstMinute, WrongFlagsOfANewScene) {
  expect_rejected("new s.toml --train mancester-coach", "mancester-coach");
  expect_rejected("new s.toml --span -3", "--span: found -3, expected 0.5 to 1000 m");
  expect_rejected("new s.toml --spans 3", "--span METRES too");
  expect_rejected("new s.html", "found the ending .html, expected .toml");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "s.toml"));
}

TEST_F(FirstMinute, CheckNamesWhatIsMissingAndWhatIsUnused) {
  write("s.toml", rigid_scene + "duration = 0.1\n[irregularity]\nfile = \"absent.csv\"\n");
  expect_rejected("check s.toml", "s.toml:8: irregularity.file: found no file absent.csv");
  write("s.toml", rigid_scene + "duration = 0.1\n[[bridge]]\nlength = 20\n");
  expect_rejected("check s.toml", "track.kind: found \"rigid\" and a [[bridge]]");
  write("s.toml",
        "[output]\nnodes = [\"dekc-*\"]\n[[bridge]]\n[contact]\nmode = \"online\"\n[track]\nlength_before = 90\n");
  expect_rejected("check s.toml", "a pattern that fits one of deck-midspan-1");
}

TEST_F(FirstMinute, CheckDrawsTheLayout) {
  ASSERT_EQ(vsi("new s.toml -q --span 30").exit_code, 0);
  expect_said("check s.toml -o s.svg", {"The scene is valid"});
  const std::string svg = text_of("s.svg");
  EXPECT_TRUE(svg.starts_with("<svg ")) << svg.substr(0, 80);
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
  EXPECT_EQ(vsi("check s.toml -o s.svg -q").exit_code, 0) << "a picture replaces a picture";
  const std::string before = text_of("s.toml");
  EXPECT_EQ(vsi("check s.toml -o s.toml").exit_code, 2);
  EXPECT_EQ(text_of("s.toml"), before);
  // the train, the rails and the bridge are drawn to scale: as far apart as the numbers say
  const Outcome text = vsi("check s.toml");
  const std::size_t line = text.output.find("  bridge     ");
  ASSERT_NE(line, std::string::npos) << text.output;
  const std::string bridge = text.output.substr(line + 13, 68);
  const nlohmann::json json = nlohmann::json::parse(vsi("check s.toml --json").output);
  const double metres = json["track"][1].get<double>() - json["track"][0].get<double>();
  const double drawn = static_cast<double>(bridge.rfind('^') - bridge.find('^'));
  EXPECT_NEAR(drawn / 67.0, 30.0 / metres, 1.5 / 67.0) << bridge;
}

TEST_F(FirstMinute, NamesThatContradictTheirContentAreRejected) {
  write("s.toml", rigid_scene + "duration = 0.02\n");
  expect_rejected("run s.toml -o r.pdf",
                  "-o r.pdf: found the ending .pdf, expected .h5, for the output is an HDF5 file");
  ASSERT_EQ(vsi("run s.toml -o r.h5 -q").exit_code, 0);
  expect_rejected("report r.h5 -o x.pdf", "-o x.pdf: found the ending .pdf, expected .html");
  expect_rejected("report r.h5 -o x.PNG", "found the ending .png");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "x.pdf"));
  EXPECT_EQ(vsi("report r.h5 -o page -q").exit_code, 0) << "a name without an ending contradicts nothing";
  EXPECT_EQ(vsi("report r.h5 -o run.v2 -q").exit_code, 0) << "nor does one that no other program has";
}

TEST_F(FirstMinute, RunsAreComparedOnOnePage) {
  write("s.toml", rigid_scene + "duration = 0.05\n");
  write("t.toml", "[train]\nspeed_kmh = 100\n" + rigid_scene + "duration = 0.05\n");
  ASSERT_EQ(vsi("run s.toml -o a.h5 -q").exit_code, 0);
  ASSERT_EQ(vsi("run t.toml -o b.h5 -q").exit_code, 0);
  expect_said("report a.h5 b.h5 -o both.html", {"Report: both.html"});
  const std::string page = text_of("both.html");
  EXPECT_NE(page.find("Comparison of 2 runs"), std::string::npos);
  EXPECT_NE(page.find("against a</th>"), std::string::npos);
  EXPECT_NE(page.find("speed_kmh = 100"), std::string::npos) << "where the scenes differ";
  expect_rejected("report a.h5 a.h5 -o out", "a.h5 twice");
}

}  // namespace
}  // namespace railtab
