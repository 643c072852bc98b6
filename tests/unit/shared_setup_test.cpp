// Runs that follow each other in one process take over tables and factors, and give the results of runs that do not.
#include "railtab/runtime/scene/shared_setup.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "../folder_fixture.hpp"
#include "railtab/runtime/base/file_checksum.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/scene/scene_model.hpp"
#include "railtab/runtime/scene/scene_run.hpp"
#include "railtab/runtime/scene/scene_structure.hpp"

namespace railtab {
namespace {

struct Variant {
  std::string speed = "40.0", seed = "1", time_step = "1e-3", rail_mass = "60.0", wheel = "S1002", window{};
};

class SharedSetUpOf : public testing::InFolder {
 protected:
  [[nodiscard]] SceneParameters scene(const Variant& run) const {
    return read_scene(write(
        "scene.toml", "[train]\nspeed = " + run.speed + "\nstart = -4.0\n[contact]\nmode = \"online\"\nwheel = \"" +
                          run.wheel + "\"\n[track]\nlength_before = 36.0\nlength_after = 12.0\nrail.mass = " +
                          run.rail_mass + "\n[[bridge]]\nlength = 12.0\n" + run.window +
                          "[irregularity]\nspectrum = \"german-low\"\nfade_in = 0\nseed = " + run.seed +
                          "\n[integration]\nduration = 0.02\ntime_step = " + run.time_step + "\n"));
  }
};

std::vector<double> numbers_of(const SceneParameters& scene, SharedSetUp* shared) {
  std::vector<double> numbers;
  RunObserver observer;
  observer.record = [&](const StepRecord& record) {
    for (const WheelRecord& wheel : record.wheels) numbers.insert(numbers.end(), {wheel.Q, wheel.Y, wheel.wear_number});
    for (const MotionRecord& node : record.nodes) numbers.push_back(node.acceleration[2]);
  };
  const RunSummary summary = run_scene(scene, build_model(scene, shared), observer);
  EXPECT_TRUE(summary.complete) << summary.message;
  return numbers;
}

TEST_F(SharedSetUpOf, RunsChangesNoBit) {
  const std::string window = "[structure]\nreduction = \"window\"\nwindow_ahead = 6.0\nwindow_behind = 6.0\n";
  const std::vector<Variant> runs{{},
                                  {.seed = "2"},
                                  {.speed = "55.0"},
                                  {.speed = "55.0", .time_step = "5e-4"},
                                  {.rail_mass = "50.0"},
                                  {.rail_mass = "50.0", .wheel = "cone-1:40"},
                                  {.window = window},
                                  {.seed = "3", .window = window},
                                  {}};
  SharedSetUp shared;
  std::vector<double> first, last;
  for (const Variant& run : runs) {
    const SceneParameters s = scene(run);
    const std::vector<double> alone = numbers_of(s, nullptr), after_others = numbers_of(s, &shared);
    ASSERT_GT(alone.size(), 100U);
    EXPECT_EQ(alone, after_others);
    if (first.empty()) first = after_others;
    last = after_others;
  }
  EXPECT_EQ(first, last);
}

TEST_F(SharedSetUpOf, RunsMakesFactorsAndProfilesOnce) {
  SharedSetUp shared;
  const VsiModel first = build_model(scene({}), &shared), second = build_model(scene({.speed = "50.0"}), &shared),
                 stiffer = build_model(scene({.rail_mass = "50.0"}), &shared),
                 cones = build_model(scene({.wheel = "cone-1:40"}), &shared);
  EXPECT_EQ(first.geometry, second.geometry);
  EXPECT_NE(first.geometry, cones.geometry);
  EXPECT_EQ(first.structure, second.structure);
  EXPECT_NE(first.structure, stiffer.structure);
  StructureStore& store = *shared.structures();
  const HhtScheme scheme{.alpha = -0.05, .time_step = 1e-3}, halved{.alpha = -0.05, .time_step = 5e-4};
  const DofRange all{0, first.structure->dofs()};
  const auto rest = store.at_rest(first.structure), steps = store.of_steps(first.structure, scheme, all);
  EXPECT_EQ(store.at_rest(second.structure), rest);
  EXPECT_EQ(store.of_steps(second.structure, scheme, all), steps);
  EXPECT_NE(store.of_steps(second.structure, halved, all), steps) << "divided steps have their own";
  EXPECT_EQ(store.of_steps(second.structure, scheme, all), steps) << "and leave those of whole steps";
  EXPECT_NE(store.at_rest(stiffer.structure), rest) << "another mass is another structure";
}

TEST_F(SharedSetUpOf, RunsTellsStructuresApart) {
  const SceneParameters built = scene({});
  EXPECT_EQ(StructureKey(built), StructureKey(scene({.speed = "50.0", .seed = "4"})));
  SceneParameters other = built;
  other.spans[0].E *= 1.01;
  EXPECT_NE(StructureKey(built), StructureKey(other));
  other = built;
  other.contact.normal = NormalContact::rigid;  // two elements per bay
  EXPECT_NE(StructureKey(built), StructureKey(other));
  other = built;
  other.structure.report = {3.0};
  EXPECT_NE(StructureKey(built), StructureKey(other));
  SceneParameters imported;
  imported.track_kind = TrackKind::imported;
  imported.structure.files.stiffness = write("bridge.mtx", "1 1 2.0\n");
  const StructureKey before(imported);
  EXPECT_EQ(before, StructureKey(imported));
  static_cast<void>(write("bridge.mtx", "1 1 3.0\n"));
  EXPECT_NE(before, StructureKey(imported)) << "contents have changed";
}

// The second sum is remembered, once the file's last change is old enough to be told from the next one.
TEST_F(SharedSetUpOf, FilesFollowsTheirChecksums) {
  const std::filesystem::path file = write("a.csv", "1,2\n");
  const std::string first = file_checksum(file);
  std::this_thread::sleep_for(std::chrono::milliseconds(3100));
  EXPECT_EQ(file_checksum(file), first);
  EXPECT_EQ(file_checksum(file), first);
  static_cast<void>(write("a.csv", "1,3\n"));
  const std::string second = file_checksum(file);
  EXPECT_NE(second, first);
  static_cast<void>(write("a.csv", "1,4\n"));
  EXPECT_NE(file_checksum(file), second) << "within a tick of the clock";
  EXPECT_THROW(static_cast<void>(file_checksum(folder_ / "none")), InputError);
  EXPECT_THROW(static_cast<void>(file_checksum("")), InputError);
}

}  // namespace
}  // namespace railtab
