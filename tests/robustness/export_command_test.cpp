// vsi export: what ParaView gets of a run, read back by a reader of its own, and what happens to files that are there.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "railtab/runtime/results/result_file.hpp"
#include "vsi_fixture.hpp"
#include "vtu_reader.hpp"

namespace railtab {
namespace {

using testing::VtuFile;

// A coach that meets a bridge, as in the demo; the deck is recorded at four places.
const std::string short_scene =
    "name = \"A <short> run\"\n[train]\nvehicle = \"manchester-coach\"\nspeed_kmh = 200\nstart = 2.0\n"
    "initial_lateral_shift = 0.002\n"
    "[contact]\nmode = \"online\"\ncreep_law = \"polach\"\n[track]\nkind = \"flexible\"\nlength_before = 30\n"
    "length_after = 10\n"
    "[[bridge]]\nlength = 16\nelements = 8\ncount = 2\n[structure]\nreport = [4.0, 8.0, 12.0, 24.0]\n"
    "[integration]\nduration = 0.02\ntime_step = 1e-3\n";

class ExportCommand : public VsiCommand {
 protected:
  void SetUp() override {
    VsiCommand::SetUp();
    write("s.toml", short_scene);
    const Outcome ran = vsi("run s.toml -o r.h5 -q");
    ASSERT_EQ(ran.exit_code, 0) << ran.output;
    results_ = read_results(folder_ / "r.h5");
    ASSERT_EQ(results_.steps.size(), 21u);
  }
  [[nodiscard]] std::string text_of(const std::string& name) const {
    std::ifstream in(folder_ / name);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  [[nodiscard]] VtuFile vtu(const std::string& name) const { return VtuFile((folder_ / name).string()); }
  [[nodiscard]] std::vector<std::string> entries(const std::string& folder) const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / folder)) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  RunResults results_;
};

void expect_equal(const std::array<double, 3>& found, const double* expected) {
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(found[k], static_cast<double>(static_cast<float>(expected[k]))) << "component " << k;
  }
}

TEST_F(ExportCommand, NodesAreThoseOfTheResultsToFloat32) {
  ASSERT_EQ(vsi("export r.h5 -o run.pvd --times 0.005,0.02 --scale 0 -q").exit_code, 0);
  const std::vector<std::size_t> records{5, 20};
  for (std::size_t frame = 0; frame < records.size(); ++frame) {
    const VtuFile file = vtu(fmt::format("run/nodes-{:05}.vtu", frame));
    const StepRecord& step = results_.steps[records[frame]];
    ASSERT_EQ(step.nodes.size(), 12u) << "deck and both rails at four places";
    ASSERT_EQ(file.points, 12);
    EXPECT_EQ(file.texts.at("node_names"), results_.header.node_names);
    double largest = 0.0;
    for (std::size_t n = 0; n < step.nodes.size(); ++n) {
      expect_equal(file.vector("displacement", n), step.nodes[n].displacement);
      expect_equal(file.vector("rotation", n), step.nodes[n].displacement + 3);
      expect_equal(file.vector("velocity", n), step.nodes[n].velocity);
      expect_equal(file.vector("acceleration", n), step.nodes[n].acceleration);
      EXPECT_EQ(file.vector("Points", n)[0], static_cast<float>(results_.header.node_x[n]));
      largest = std::max(largest, std::abs(step.nodes[n].displacement[2]));
    }
    EXPECT_GT(largest, 1e-6) << "the bridge moves";
    EXPECT_EQ(file.arrays.at("TimeValue"), std::vector<double>{step.time});
  }
}

TEST_F(ExportCommand, NodesStandWhereTheBridgeHasThem) {
  ASSERT_EQ(vsi("export r.h5 -o run.pvd --times 0 --scale 0 -q").exit_code, 0);
  const VtuFile file = vtu("run/nodes-00000.vtu");
  const std::vector<std::string>& names = file.texts.at("node_names");
  ASSERT_EQ(names[0], "deck-4");
  EXPECT_EQ(file.vector("Points", 0), (std::array<double, 3>{4.0, 0.0, static_cast<double>(1.9F)}));
  ASSERT_EQ(names[1], "rail-left-4");
  EXPECT_EQ(file.vector("Points", 1)[1], -0.75);
  EXPECT_EQ(file.vector("Points", 2)[1], 0.75);
  EXPECT_EQ(names[9], "deck-24");
  EXPECT_EQ(file.vector("Points", 9)[0], 24.0) << "in the second span";
}

TEST_F(ExportCommand, TheBridgePassesThroughItsNodesAndRestsOnItsSupports) {
  ASSERT_EQ(vsi("export r.h5 -o run.pvd --times 0.02 --scale 50 -q").exit_code, 0);
  const VtuFile file = vtu("run/bridge-00000.vtu");
  const StepRecord& step = results_.steps.back();
  EXPECT_EQ(file.arrays.at("displacement_scale"), std::vector<double>{50.0});
  std::size_t recorded = 0, supports = 0;
  for (std::size_t p = 0; p < static_cast<std::size_t>(file.points); ++p) {
    const auto at = file.vector("Points", p), u = file.vector("displacement", p);
    const double rest = at[0] - 50.0 * u[0];
    if (file.arrays.at("recorded")[p] == 1.0) {
      ++recorded;
      const std::vector<double>& x = results_.header.node_x;
      const auto node = std::find_if(x.begin(), x.end(), [&](double other) { return std::abs(other - rest) < 1e-4; });
      ASSERT_NE(node, x.end()) << rest;
      expect_equal(u, step.nodes[static_cast<std::size_t>(node - x.begin())].displacement);
      EXPECT_NEAR(at[2], 1.9 + 50.0 * u[2], 1e-6);
    } else if (std::abs(rest - 16.0) < 1e-4) {
      ++supports;
      EXPECT_EQ(u, (std::array<double, 3>{0.0, 0.0, 0.0}));
    }
  }
  EXPECT_EQ(recorded, 4u);
  EXPECT_EQ(supports, 10u) << "the last section of one span and the first of the next, five points each";
}

TEST_F(ExportCommand, BodiesMoveWithTheTrain) {
  ASSERT_EQ(vsi("export r.h5 -o run.pvd --times 0.01 --scale 1 -q").exit_code, 0);
  const StepRecord& step = results_.steps[10];
  std::size_t found = 0;
  for (const char* part : {"bodies", "wheelsets"}) {
    const VtuFile file = vtu(fmt::format("run/{}-00000.vtu", part));
    const std::vector<double>& types = file.arrays.at("types");
    for (std::size_t cell = 0, corner = 0; cell < types.size(); ++cell) {
      const std::size_t first = corner;
      corner = static_cast<std::size_t>(file.arrays.at("offsets")[cell]);
      if (types[cell] != 1.0) continue;  // a body's own point
      ++found;
      const auto point = static_cast<std::size_t>(file.arrays.at("connectivity")[first]);
      const auto body = static_cast<std::size_t>(file.arrays.at("body")[cell]);
      expect_equal(file.vector("displacement", point), step.bodies[body].displacement);
      expect_equal(file.vector("acceleration", point), step.bodies[body].acceleration);
      const double x = step.position + results_.header.body_x[body] + step.bodies[body].displacement[0];
      EXPECT_NEAR(file.vector("Points", point)[0], x, 1e-5);
      const double z = results_.header.body_z[body] + step.bodies[body].displacement[2];
      EXPECT_NEAR(file.vector("Points", point)[2], z, 1e-6);
    }
  }
  EXPECT_EQ(found, 7u) << "a car body, two bogies, four wheelsets";
}

TEST_F(ExportCommand, CornersOfABoxMoveAsARigidBody) {
  ASSERT_EQ(vsi("export r.h5 -o run.pvd --times 0.02 --scale 0 -q").exit_code, 0);
  const VtuFile file = vtu("run/bodies-00000.vtu");
  const double* u = results_.steps.back().bodies[0].displacement;  // of the car body, whose box follows its point
  for (std::size_t corner = 1; corner <= 8; ++corner) {
    std::array<double, 3> r = file.vector("Points", corner);
    for (std::size_t k = 0; k < 3; ++k) r[k] -= file.vector("Points", 0)[k];
    const auto moved = file.vector("displacement", corner);
    EXPECT_NEAR(moved[0], u[0] + u[4] * r[2] - u[5] * r[1], 1e-9);
    EXPECT_NEAR(moved[1], u[1] + u[5] * r[0] - u[3] * r[2], 1e-9);
    EXPECT_NEAR(moved[2], u[2] + u[3] * r[1] - u[4] * r[0], 1e-9);
  }
}

TEST_F(ExportCommand, ForcesAreThoseOnTheRails) {
  ASSERT_EQ(vsi("export r.h5 -o run.pvd --times 0.01 -q").exit_code, 0);
  const VtuFile file = vtu("run/contact_forces-00000.vtu");
  const StepRecord& step = results_.steps[10];
  ASSERT_EQ(file.points, 8);
  for (std::size_t w = 0; w < 8; ++w) {
    const double force[3] = {step.wheels[w].X, step.wheels[w].Y, step.wheels[w].Q};
    expect_equal(file.vector("force", w), force);
    EXPECT_GT(force[2], 1e4) << "pressed down: z is down";
    const double y = (w % 2 == 0 ? -1.0 : 1.0) * (0.75 + step.wheels[w].y_rail);
    EXPECT_NEAR(file.vector("Points", w)[1] - file.vector("displacement", w)[1], y, 1e-6);
  }
}

TEST_F(ExportCommand, ZUpTurnsEverythingAboutX) {
  ASSERT_EQ(vsi("export r.h5 -o down.pvd --times 0.02 -q").exit_code, 0);
  ASSERT_EQ(vsi("export r.h5 -o up.pvd --times 0.02 --z-up -q").exit_code, 0);
  for (const char* part : {"nodes", "bodies", "contact_forces"}) {
    const VtuFile down = vtu(fmt::format("down/{}-00000.vtu", part)), up = vtu(fmt::format("up/{}-00000.vtu", part));
    for (const char* array : {"Points", "displacement", "rotation", "acceleration"}) {
      for (std::size_t p = 0; p < static_cast<std::size_t>(down.points); ++p) {
        const auto a = down.vector(array, p), b = up.vector(array, p);
        EXPECT_EQ(b, (std::array<double, 3>{a[0], -a[1], -a[2]})) << part << " " << array;
      }
    }
  }
  EXPECT_NE(vtu("up/nodes-00000.vtu").texts.at("axes").front().find("z up"), std::string::npos);
}

TEST_F(ExportCommand, CollectionsNameFilesThatAreThere) {
  ASSERT_EQ(vsi("export r.h5 -o run.pvd --every 0.01 -q").exit_code, 0);
  ASSERT_EQ(vsi("export r.h5 -o folder -q").exit_code, 0) << "without an interval: every record of a short run";
  for (const auto& [collection, folder, files] :
       {std::tuple{"run.pvd", "", 18u}, {"run/nodes.pvd", "run/", 3u}, {"folder/all.pvd", "folder/", 126u}}) {
    const std::string text = text_of(collection);
    std::size_t count = 0;
    for (std::size_t at = text.find("file=\""); at != std::string::npos; at = text.find("file=\"", at + 1)) {
      const std::string file = text.substr(at + 6, text.find('"', at + 6) - at - 6);
      EXPECT_TRUE(std::filesystem::is_regular_file(folder_ / folder / file)) << file;
      ++count;
    }
    EXPECT_EQ(count, files) << collection;
  }
  EXPECT_NE(text_of("run.pvd").find("timestep=\"0.01\""), std::string::npos);
}

TEST_F(ExportCommand, ItReplacesItsOwnFilesOnly) {
  ASSERT_EQ(vsi("export r.h5 -o run.pvd -q").exit_code, 0);
  ASSERT_EQ(vsi("export r.h5 -o run.pvd --times 0 -q").exit_code, 0) << "an export replaces an export";
  EXPECT_EQ(entries("run").size(), 12u) << "six parts, each a file and a collection: none of the earlier ones";
  write("run/notes.txt", "mine");
  expect_rejected("export r.h5 -o run.pvd", "run: found notes.txt in it, which no export wrote");
  EXPECT_EQ(text_of("run/notes.txt"), "mine");
  EXPECT_EQ(entries("run").size(), 13u);
  write("other.pvd", "<VTKFile type=\"Collection\">\n");
  expect_rejected("export r.h5 -o other.pvd", "other.pvd: found a file that begins with");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "other"));
  write("plain", "mine");
  expect_rejected("export r.h5 -o plain", "plain: found a file");
  expect_rejected("export r.h5 -o r.h5", "found the ending .h5, expected .pvd");
  expect_rejected("export r.h5 -o absent/run.pvd", "found no folder absent");
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    EXPECT_EQ(entry.path().string().find(".part-"), std::string::npos) << entry.path();
  }
}

TEST_F(ExportCommand, AFullDiskLeavesWhatWasThere) {
  const std::string limited = "trap '' XFSZ; ulimit -f 8; '" VSI_COMMAND "' export r.h5 -o run.pvd";
  const auto expect_failed = [&] {
    const Outcome outcome = run(limited);
    EXPECT_EQ(outcome.exit_code, 1) << outcome.output;
    EXPECT_NE(outcome.output.find("could not be written, the disk may be full"), std::string::npos) << outcome.output;
  };
  expect_failed();
  EXPECT_EQ(entries("."), (std::vector<std::string>{"r.h5", "s.toml"})) << "neither a part nor a collection";
  ASSERT_EQ(vsi("export r.h5 -o run.pvd --times 0 -q").exit_code, 0);
  const std::string before = text_of("run.pvd");
  expect_failed();
  EXPECT_EQ(text_of("run.pvd"), before);
  EXPECT_EQ(entries("run").size(), 12u) << "the earlier export is whole";
  EXPECT_EQ(entries(".").size(), 4u);
}

TEST_F(ExportCommand, WhatAKilledExportLeftBehindGoes) {
  std::filesystem::create_directory(folder_ / "run.part-0badcafe");
  write("run.part-0badcafe/lock", "");
  std::filesystem::create_directory(folder_ / "run");
  write("run/lock", "");
  write("run.part-0badcafe/nodes-00000.vtu", "half a file");
  std::filesystem::create_directory(folder_ / "run.part-mine");
  ASSERT_EQ(vsi("export r.h5 -o run.pvd --times 0 -q").exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "run.part-0badcafe"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "run.part-mine")) << "a folder without a lock is none of its own";
  EXPECT_FALSE(std::filesystem::exists(folder_ / "run/lock"));
}

TEST_F(ExportCommand, WrongInstantsAreNamed) {
  expect_rejected("export r.h5 -o out --times 0.01,7",
                  "--times: found '7', expected times within the records, 0 to 0.02");
  expect_rejected("export r.h5 -o out --times 0.01,", "--times: found ''");
  expect_rejected("export r.h5 -o out --every 0", "--every: found 0 s, expected a time above 0 s");
  expect_rejected("export r.h5 -o out --every 1e-3 --times 0", "--every: found --times too");
  expect_rejected("export r.h5 -o out --scale -1", "--scale: found -1");
  expect_rejected("export absent.h5 -o out", "absent.h5");
  expect_rejected("export s.toml -o out", "s.toml");
}

TEST_F(ExportCommand, WhatIsNotRecordedIsNamedWithItsKey) {
  write("few.toml", short_scene + "[output]\nwheels = false\nbodies = []\nnodes = []\n");
  ASSERT_EQ(vsi("run few.toml -o few.h5 -q").exit_code, 0);
  const Outcome outcome = vsi("export few.h5 -o few.pvd");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  for (const char* key : {"output.wheels = true", "output.bodies = [\"*\"]", "output.nodes = [\"*\"]"}) {
    EXPECT_NE(outcome.output.find(key), std::string::npos) << key << "\n" << outcome.output;
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "few/contact_forces.pvd"));
  EXPECT_EQ(vtu("few/bridge-00000.vtu").texts.at("not_recorded").size(), 3u);
  EXPECT_EQ(vtu("few/rails-00000.vtu").texts.at("scene").front(), "A <short> run");
}

TEST_F(ExportCommand, PositionsBesideTheBridgeAreRejected) {
  std::string scene = short_scene;
  scene.replace(scene.find("24.0"), 4, "33.0");
  write("s.toml", scene);
  expect_rejected("run s.toml -o out", "structure.report: found 33 m, expected 0 to 32 m, the bridge");
}

}  // namespace
}  // namespace railtab
