// The same scene with tabulated and with online contact: what the table changes in the contact forces of a run.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/runtime/vsi/simulation.hpp"
#include "railtab/tablegen/geometry_sweep.hpp"
#include "railtab/tables/geometry_table_file.hpp"

namespace railtab {
namespace {

std::filesystem::path made_table() {
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "railtab_table_run_test.h5";
  const ContactSearch search(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "S1002", 0.0)),
                                           ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)), {}));
  GeometrySweepOptions options;
  options.lateral = {-0.010, 0.010};
  options.yaw = {-0.010, 0.010};
  options.roll = {-0.004, 0.004};
  options.iterated_cell = 1e-3;  // coarse: for a test in seconds
  options.fallback_cell = 1e-4;
  write_geometry_table(file, generate_geometry_table(search, options));
  return file;
}

// A coach that runs over a rough track and a bridge with its wheelsets 4 mm beside the centre: the contact jumps along
// the treads and comes near the flange.
SceneParameters hunting_coach(const std::filesystem::path& table, ContactMode mode) {
  SceneParameters scene;
  scene.train.speed = 50.0;
  scene.train.start = 0.0;
  scene.train.initial_lateral_shift = 4e-3;
  scene.contact.mode = mode;
  scene.contact.table = table;
  scene.track.length_before = 30.0;
  scene.track.length_after = 30.0;
  scene.spans.resize(1);
  scene.spans[0].length = 20.0;
  scene.irregularity = std::filesystem::path(RAILTAB_SOURCE_DIR) / "docs/examples/demo_irregularity.csv";
  scene.integration.duration = 0.6;
  return scene;
}

struct Outcome {
  RunSummary summary;
  std::vector<StepRecord> steps;
};

Outcome run(const SceneParameters& scene) {
  Outcome result;
  RunObserver observer;
  observer.record = [&](const StepRecord& record) { result.steps.push_back(record); };
  result.summary = run_scene(scene, observer);
  return result;
}

TEST(TableRun, ContactForcesAreThoseOfTheOnlineSearch) {
  const std::filesystem::path table = made_table();
  const Outcome with_table = run(hunting_coach(table, ContactMode::table));
  const Outcome online = run(hunting_coach(table, ContactMode::online));
  ASSERT_TRUE(with_table.summary.complete) << with_table.summary.message;
  ASSERT_TRUE(online.summary.complete) << online.summary.message;
  ASSERT_EQ(with_table.steps.size(), online.steps.size());

  const double static_load = online.steps.front().wheels.front().Q;
  double sum = 0.0, largest_Y = 0.0;
  int two_patches = 0;
  std::size_t n = 0;
  for (std::size_t i = 0; i < online.steps.size(); ++i) {
    for (std::size_t wheel = 0; wheel < online.steps[i].wheels.size(); ++wheel) {
      const WheelRecord& a = with_table.steps[i].wheels[wheel];
      const WheelRecord& b = online.steps[i].wheels[wheel];
      sum += (a.Q - b.Q) * (a.Q - b.Q) + (a.Y - b.Y) * (a.Y - b.Y);
      largest_Y = std::max(largest_Y, std::abs(b.Y));
      two_patches += b.patches > 1;
      ++n;
    }
  }
  const double rms = std::sqrt(sum / static_cast<double>(n)) / static_load;
  std::printf(
      "contact forces, table against online: %.3g %% rms of the static wheel load (largest Y %.1f kN, two patches on "
      "%.1f %% of the wheels)\n",
      100 * rms, largest_Y / 1e3, 100.0 * two_patches / static_cast<double>(n));
  std::printf("served by the table alone: %.2f %% of %ld queries; contact time %.2f s with the table, %.2f s online\n",
              100.0 * static_cast<double>(with_table.summary.table_queries) /
                  static_cast<double>(with_table.summary.contact_queries),
              with_table.summary.contact_queries, with_table.summary.seconds_contact, online.summary.seconds_contact);
  EXPECT_GT(largest_Y, 2e3);  // the scene does have lateral forces to get wrong
  EXPECT_GT(with_table.summary.table_queries, with_table.summary.contact_queries / 2);
  EXPECT_EQ(online.summary.table_queries, 0);
  EXPECT_LT(rms, 1e-3);
  std::filesystem::remove(table);
}

}  // namespace
}  // namespace railtab
