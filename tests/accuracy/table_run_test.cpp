// The same scene with tabulated, online and the published method's contact: what each changes in the contact forces of
// a run.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include "../measured.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/runtime/scene/scene_parameters.hpp"
#include "railtab/runtime/scene/scene_run.hpp"
#include "railtab/runtime/vsi/simulation.hpp"
#include "railtab/runtime/vsi/step_record.hpp"
#include "railtab/tablegen/geometry_sweep.hpp"
#include "railtab/tables/files/geometry_table_file.hpp"

namespace railtab {
namespace {

std::filesystem::path made_table() {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / fmt::format("railtab_table_run_test_{}.h5", getpid());
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

constexpr double flange_angle = 0.2;  // rad: steeper than any tread
constexpr const char* rough_track = RAILTAB_SOURCE_DIR "/docs/examples/demo_irregularity.csv";

// The rough track with two waves of alignment, 20 m long and 16 mm high, added from x = 10 m on: the wheelsets of a
// coach at 50 m/s are led through them by their flanges.
std::filesystem::path wavy_track() {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / fmt::format("railtab_table_run_test_{}.csv", getpid());
  std::ifstream rough(rough_track);
  std::ofstream wavy(file);
  for (std::string line; std::getline(rough, line);) {
    double x, y_left, z_left, y_right, z_right;
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf", &x, &y_left, &z_left, &y_right, &z_right) != 5) {
      wavy << line << '\n';
      continue;
    }
    const double phase = x > 10.0 && x < 50.0 ? 2.0 * std::numbers::pi * (x - 10.0) / 20.0 : 0.0;
    const double wave = 8.0 * (1.0 - std::cos(phase));  // mm, as the file
    wavy << fmt::format("{},{},{},{},{}\n", x, y_left + wave, z_left, y_right + wave, z_right);
  }
  return file;
}

// A coach over the wavy track and a bridge: the contact jumps along the treads and up to the flanges.
SceneParameters led_by_flanges(const std::filesystem::path& irregularity, ContactMode mode) {
  SceneParameters scene;
  scene.train.speed = 50.0;
  scene.train.start = 0.0;
  scene.contact.mode = mode;
  scene.contact.creep_law = "polach";  // of the numbers that docs/validation quotes
  scene.track.length_before = 30.0;
  scene.track.length_after = 30.0;
  scene.spans.resize(1);
  scene.spans[0].length = 20.0;
  scene.irregularity = irregularity;
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

// Differences of the contact forces of two runs of the same scene.
struct Difference {
  double rms_Q = 0.0, rms_Y = 0.0;  ///< over the rms of the first run's own: of Q without the static load, of Y
  double static_load = 0.0, largest_Y = 0.0;
  double on_flange = 0.0;  ///< share of the first run's wheels that touch with the flange
};

Difference difference(const std::vector<StepRecord>& reference, const std::vector<StepRecord>& steps) {
  Difference d;
  d.static_load = reference.front().wheels.front().Q;
  double dQ = 0.0, dY = 0.0, Q = 0.0, Y = 0.0, n = 0.0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    for (std::size_t wheel = 0; wheel < reference[i].wheels.size(); ++wheel) {
      const WheelRecord& a = reference[i].wheels[wheel];
      const WheelRecord& b = steps[i].wheels[wheel];
      dQ += (b.Q - a.Q) * (b.Q - a.Q);
      dY += (b.Y - a.Y) * (b.Y - a.Y);
      Q += (a.Q - d.static_load) * (a.Q - d.static_load);
      Y += a.Y * a.Y;
      d.largest_Y = std::max(d.largest_Y, std::abs(a.Y));
      d.on_flange += std::abs(a.angle) > flange_angle || a.patches > 1;
      n += 1.0;
    }
  }
  d.rms_Q = std::sqrt(dQ / Q);
  d.rms_Y = std::sqrt(dY / Y);
  d.on_flange /= n;
  return d;
}

TEST(TableRun, ContactForcesAreThoseOfTheOnlineSearchWithFlangeContact) {
  const std::filesystem::path table = made_table();
  const std::filesystem::path track = wavy_track();
  SceneParameters scene = led_by_flanges(track, ContactMode::table);
  scene.contact.table = table;
  const Outcome with_table = run(scene);
  scene.contact.mode = ContactMode::online;
  const Outcome online = run(scene);
  ASSERT_TRUE(with_table.summary.complete) << with_table.summary.message;
  ASSERT_TRUE(online.summary.complete) << online.summary.message;
  ASSERT_EQ(with_table.steps.size(), online.steps.size());

  const Difference d = difference(online.steps, with_table.steps);
  testing::measured("table_run.Y_kN", d.largest_Y / 1e3);
  testing::measured("table_run.flange_percent", 100 * d.on_flange);
  testing::measured("table_run.parts_of_hundred_thousand", 1e5 * std::max(d.rms_Q, d.rms_Y));
  EXPECT_GT(d.largest_Y, 2e4);  // the flanges do lead
  EXPECT_GT(d.on_flange, 0.02);
  EXPECT_GT(with_table.summary.table_queries, with_table.summary.contact_queries / 2);
  EXPECT_EQ(online.summary.table_queries, 0);
  EXPECT_LT(d.rms_Q, 5e-3);
  EXPECT_LT(d.rms_Y, 5e-3);
  std::filesystem::remove(table);
  std::filesystem::remove(track);
}

// The published method knows one pair per tread, whose jumps are jumps of the force
// (docs/validation/contact_in_runs.md): it runs, carries the train, and its wheelsets are led along the same path.
TEST(PaperRun, FollowsTheOnlineSearchFromTreadToFlange) {
  const std::filesystem::path track = wavy_track();
  const Outcome paper = run(led_by_flanges(track, ContactMode::paper));
  const Outcome online = run(led_by_flanges(track, ContactMode::online));
  ASSERT_TRUE(paper.summary.complete) << paper.summary.message;
  ASSERT_TRUE(online.summary.complete) << online.summary.message;
  ASSERT_EQ(paper.steps.size(), online.steps.size());
  const Difference d = difference(online.steps, paper.steps);
  double paper_load = 0.0, online_load = 0.0, path = 0.0, path_difference = 0.0;
  for (std::size_t i = 0; i < paper.steps.size(); ++i) {
    for (const WheelRecord& wheel : paper.steps[i].wheels) paper_load += wheel.Q;
    for (const WheelRecord& wheel : online.steps[i].wheels) online_load += wheel.Q;
    for (std::size_t body = 0; body < paper.steps[i].bodies.size(); ++body) {
      const double y = online.steps[i].bodies[body].displacement[1];
      path += y * y;
      path_difference += std::pow(paper.steps[i].bodies[body].displacement[1] - y, 2);
    }
  }
  const double path_error = std::sqrt(path_difference / path);
  testing::measured("paper_run.Q_percent", 100 * d.rms_Q);
  testing::measured("paper_run.Y_percent", 100 * d.rms_Y);
  testing::measured("paper_run.path_percent", 100 * path_error);
  EXPECT_NEAR(paper_load / online_load, 1.0, 5e-3);
  EXPECT_LT(path_error, 0.15);
  EXPECT_LT(d.rms_Y, 1.0);
  EXPECT_EQ(paper.summary.table_queries, 0);
  std::filesystem::remove(track);
}

// Where treads are straight, pairs are unique and convex, and the published method is the online search but for the
// ellipse's curvature, that of the point instead of the overlap's: the same over constant curvatures.
TEST(PaperRun, IsTheOnlineSearchOnStraightTreadsAndArcs) {
  const std::filesystem::path track = wavy_track();
  SceneParameters scene = led_by_flanges(track, ContactMode::paper);
  scene.contact.wheel = "conic-arc-stand-in";
  scene.integration.contact_force = ContactForceRule::endpoint;  // as the published method has it
  scene.integration.tolerance = 1e-5;                            // the methods differ by no more than Newton's residual
  const Outcome paper = run(scene);
  scene.contact.mode = ContactMode::online;
  const Outcome online = run(scene);
  ASSERT_TRUE(paper.summary.complete) << paper.summary.message;
  ASSERT_EQ(paper.steps.size(), online.steps.size());
  const Difference d = difference(online.steps, paper.steps);
  testing::measured("paper_run.straight.percent", 100 * std::max(d.rms_Q, d.rms_Y));
  testing::measured("paper_run.straight.Y_kN", d.largest_Y / 1e3);
  EXPECT_GT(d.largest_Y, 2e4);
  EXPECT_LT(d.rms_Q, 1e-3);
  EXPECT_LT(d.rms_Y, 1e-3);
  std::filesystem::remove(track);
}

}  // namespace
}  // namespace railtab
