#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <new>
#include <optional>
#include <random>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/contact/contact_geometry.hpp"
#include "railtab/runtime/contact/table_contact.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/tablegen/table_verification.hpp"

namespace {
thread_local long allocations = 0;
}

// Counts every allocation of this program, so that a look-up can be shown to make none.
void* operator new(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace railtab {
namespace {

ContactSearch s1002_on_60e1() {
  return ContactSearch(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "S1002", 1.0 / 40)),
                                     ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40)),
                                     PairDimensions{}));
}

GeometryVerification verify(const TableContact& contact, int samples) {
  VerificationOptions options = verification_options(contact.table().data());
  options.samples = samples;
  options.seed = 7;
  options.timing = false;
  return verify_geometry_table(contact, options);
}

/// Cells coarse enough for a table in seconds: more queries are searched, none is wrong.
GeometrySweepOptions coarse() {
  GeometrySweepOptions options;
  options.iterated_cell = 2e-4;
  options.fallback_cell = 1e-5;
  return options;
}

/// The table polishes its start on the same profiles as the search: what remains is rounding and, in the pair, the
/// second order of the last Newton step, at most 20 µm. The penetration is stationary there.
void expect_exact(const GeometryVerification& v) {
  EXPECT_EQ(v.finer_mismatch_share, 0.0);
  EXPECT_LE(v.patch_mismatch_share, 1e-4);
  EXPECT_GT(v.patches_compared, v.answered_by_table / 2);
  EXPECT_LT(v.penetration.max, 1e-10);
  EXPECT_LT(v.position_rail.max, 1e-6);
  EXPECT_LT(v.position_wheel.max, 1e-6);
  EXPECT_LT(v.contact_angle.max, 8e-5);  // 1e-6 m over the smallest radius in contact, 13 mm
  EXPECT_LT(v.normal_force_relative.max, 3e-3);
  EXPECT_LT(v.normal_force_relative.p999, 3e-4);
}

TEST(GeometryTableAccuracy, EqualsTheOnlineSearchWithoutRoll) {
  const TableContact contact{GeometryTable(sweep_geometry(s1002_on_60e1(), coarse()))};
  const GeometryVerification v = verify(contact, 20000);
  expect_exact(v);
  EXPECT_LT(v.fallback_share, 0.005);
  EXPECT_LT(v.searched_share, 0.01);
  EXPECT_EQ(v.never_touching, 0);
}

TEST(GeometryTableAccuracy, EqualsTheOnlineSearchWithRoll) {
  GeometrySweepOptions options = coarse();
  options.roll = {-2e-3, 2e-3};
  options.lateral = {3e-3, 5.5e-3};
  options.yaw = {-10e-3, 10e-3};
  options.fallback_cell = 2e-5;
  const TableContact contact{GeometryTable(sweep_geometry(s1002_on_60e1(), options))};
  const GeometryVerification v = verify(contact, 5000);
  expect_exact(v);
  EXPECT_LT(v.fallback_share, 0.06);  // much of this small range is the root of the flange, and the cells are coarse
  EXPECT_LT(v.searched_share, 0.10);
}

// Cells that see fewer queries may search more of them: those of a table over 7 to 10 mrad and over −10 to −7 mrad see
// as many, and more than those of a table over −10 to 10 mrad.
TEST(GeometryTableAccuracy, CellsOfAYawOfOneSignAreAsFineAsTheirMirrorImages) {
  GeometrySweepOptions options = coarse();
  options.lateral = {3e-3, 5.5e-3};
  options.yaw = {7e-3, 10e-3};
  const TableContact contact{GeometryTable(sweep_geometry(s1002_on_60e1(), options))};
  const GeometryVerification v = verify(contact, 3000);
  expect_exact(v);
  options.yaw = {-10e-3, -7e-3};
  const GeometryTableData mirrored = sweep_geometry(s1002_on_60e1(), options);
  EXPECT_EQ(mirrored.trusted_lowering, contact.table().data().trusted_lowering);
  options.yaw = {-10e-3, 10e-3};
  const GeometryVerification w = verify(TableContact{GeometryTable(sweep_geometry(s1002_on_60e1(), options))}, 3000);
  EXPECT_LT(v.fallback_share + v.searched_share, 2.0 * (w.fallback_share + w.searched_share) + 0.005);
}

// Finer cells leave less to be searched; that is all they do.
TEST(GeometryTableAccuracy, FinerCellsSearchLess) {
  GeometrySweepOptions options = coarse();
  options.lateral = {3e-3, 8e-3};
  options.iterated_cell = 1e-3;
  options.fallback_cell = 1e-3;
  const TableContact few{GeometryTable(sweep_geometry(s1002_on_60e1(), options))};
  options.fallback_cell = 3e-5;
  const TableContact many{GeometryTable(sweep_geometry(s1002_on_60e1(), options))};
  const GeometryVerification v = verify(few, 5000);
  const GeometryVerification w = verify(many, 5000);
  expect_exact(v);
  expect_exact(w);
  EXPECT_LT(w.searched_share + w.fallback_share, v.searched_share + v.fallback_share);
  EXPECT_GT(many.table().data().leaf_branch.size(), few.table().data().leaf_branch.size());
}

TEST(GeometryTableAccuracy, OutsideTheTableTheOnlineSearchAnswers) {
  GeometrySweepOptions options = coarse();
  options.lateral = {-1e-3, 1e-3};
  options.yaw = {0.0, 0.0};
  const TableContact contact{GeometryTable(sweep_geometry(s1002_on_60e1(), options))};
  for (const WheelsetPose& beside :
       {WheelsetPose{3e-3, 0, 0, 0}, WheelsetPose{0, 0, 0, 1e-3}, WheelsetPose{0, 0, 1e-3, 0}}) {
    WheelsetPose pose = beside;
    pose.z = contact.search().touch_height(pose.y, pose.roll, pose.yaw) + 1e-4;
    const ContactPatches table = contact.patches(pose);
    const ContactPatches online = contact.search().patches(pose);
    ASSERT_EQ(table.count, online.count);
    ASSERT_GT(table.count, 0);
    for (int n = 0; n < table.count; ++n) {
      EXPECT_NE(table.patch[n].source, PatchSource::table);
      EXPECT_EQ(table.patch[n].penetration, online.patch[n].penetration);
    }
  }
}

// A wheel lowered further than the table was made for is the online search's.
TEST(GeometryTableAccuracy, FarLoweredTheOnlineSearchAnswers) {
  GeometrySweepOptions options = coarse();
  options.lateral = {-1e-3, 1e-3};
  options.yaw = {0.0, 0.0};
  const TableContact contact{GeometryTable(sweep_geometry(s1002_on_60e1(), options))};
  WheelsetPose pose{0.3e-3, 0, 0, 0};
  const double touch = contact.search().touch_height(pose.y, 0, 0);
  for (const double lowering : {0.39e-3, 0.41e-3, 3e-3}) {
    pose.z = touch + lowering;
    EXPECT_EQ(contact.patches(pose).from_table, lowering < options.searched_lowering) << lowering;
    EXPECT_GT(contact.patches(pose).count, 0);
  }
}

// The parts of a sweep, merged in any order, are the sweep; what does not belong together is rejected.
TEST(GeometryTableAccuracy, PartsMakeTheWhole) {
  GeometrySweepOptions options = coarse();
  options.lateral = {4e-3, 6e-3};
  options.yaw = {0.0, 10e-3};
  options.fallback_cell = 1e-4;
  const ContactSearch search = s1002_on_60e1();
  const GeometryTableData whole = sweep_geometry(search, options);
  std::vector<GeometryTableData> parts;
  for (const int index : {2, 3, 1}) {
    options.shard = {index, 3};
    parts.push_back(sweep_geometry(search, options));
  }
  GeometryTableData merged = merge_geometry_tables(parts);
  EXPECT_TRUE(merged.shard.whole());
  EXPECT_EQ(merged.leaf_branch, whole.leaf_branch);
  EXPECT_EQ(merged.trusted_lowering, whole.trusted_lowering);
  EXPECT_EQ(merged.coefficient, whole.coefficient);
  const GeometryTable one{whole}, other{merged};
  for (double y = 4e-3; y <= 6e-3; y += 7e-6) {
    const auto p = one.lookup(y, 0.0, 6e-3, 0.0), q = other.lookup(y, 0.0, 6e-3, 0.0);
    ASSERT_EQ(p.count, q.count);
    for (int n = 0; n < p.count; ++n) EXPECT_EQ(p.branch[n].s_wheel, q.branch[n].s_wheel);
  }
  EXPECT_NO_THROW(certify_merged_geometry_table(merged));

  EXPECT_THROW(merge_geometry_tables({}), InputError);
  EXPECT_THROW(merge_geometry_tables({parts[0], parts[1]}), InputError) << "one is missing";
  EXPECT_THROW(merge_geometry_tables({parts[0], parts[1], parts[1]}), InputError) << "one is there twice";
  parts[2].statistics[0].second += 1e-3;
  EXPECT_THROW(merge_geometry_tables(parts), InputError) << "another range";
}

// Two stretches that meet and together hold the profile find what the whole search finds, each patch once.
TEST(GeometryTableAccuracy, StretchesOverTheWholeProfileAreTheWholeSearch) {
  const ContactSearch search = s1002_on_60e1();
  const ProfileCurve& wheel = search.pair().wheel();
  const double middle = 0.5 * (wheel.s_begin() + wheel.s_end());
  std::mt19937 random(3);
  std::uniform_real_distribution<double> y(-0.012, 0.012), yaw(-0.03, 0.03), dz(0, 3e-4);
  int patches = 0;
  for (int n = 0; n < 500; ++n) {
    WheelsetPose pose{y(random), 0, 0, yaw(random)};
    pose.z = search.touch_height(pose.y, pose.roll, pose.yaw) + dz(random);
    const ContactPatches whole = search.patches(pose);
    ContactPatches parts;
    search.add_patches_between(wheel.s_begin(), middle, pose, PoseTrigonometry(pose), 0.0, parts);
    search.add_patches_between(middle - 1e-3, wheel.s_end(), pose, PoseTrigonometry(pose), 0.0, parts);
    ASSERT_EQ(parts.count, whole.count);
    for (int p = 0; p < whole.count; ++p) EXPECT_NEAR(parts.patch[p].s_wheel, whole.patch[p].s_wheel, 1e-9);
    patches += whole.count;
  }
  EXPECT_GE(patches, 500);
}

// A near miss asked for must be reported whether or not anything is in contact.
TEST(GeometryTableAccuracy, NearMissesAreThoseOfTheOnlineSearch) {
  const TableContact contact{GeometryTable(sweep_geometry(s1002_on_60e1(), coarse()))};
  std::mt19937 random(5);
  std::uniform_real_distribution<double> y(-0.011, 0.011), yaw(-0.03, 0.03), dz(-3e-4, 3e-4);
  const double near_miss = 1e-4;
  int gaps = 0;
  for (int n = 0; n < 3000; ++n) {
    WheelsetPose pose{y(random), 0, 0, yaw(random)};
    pose.z = contact.search().touch_height(pose.y, pose.roll, pose.yaw) + dz(random);
    const ContactPatches table = contact.patches(pose, near_miss);
    const ContactPatches online = contact.search().patches(pose, near_miss);
    ASSERT_EQ(table.count, online.count) << pose.y << " " << pose.yaw << " " << pose.z;
    for (int p = 0; p < table.count; ++p) {
      EXPECT_NEAR(table.patch[p].penetration, online.patch[p].penetration, 1e-10);
      gaps += table.patch[p].penetration < 0;
    }
  }
  EXPECT_GT(gaps, 300);
}

TEST(GeometryTableAccuracy, EquivalentConicityIsThatOfTheOnlineSearch) {
  const ContactGeometry table{TableContact{GeometryTable(sweep_geometry(s1002_on_60e1(), coarse()))}};
  for (const double amplitude : {1e-3, 3e-3, 5e-3}) {
    const std::optional<double> looked_up = table.equivalent_conicity(amplitude),
                                searched = table.without_table().equivalent_conicity(amplitude);
    ASSERT_TRUE(looked_up && searched) << amplitude;
    EXPECT_NEAR(*looked_up, *searched, 1e-9) << amplitude;
    EXPECT_EQ(table.equivalent_conicity(amplitude), looked_up) << amplitude << ", which is kept";
  }
}

TEST(GeometryTableAccuracy, ALookUpDoesNotAllocate) {
  const TableContact contact{GeometryTable(sweep_geometry(s1002_on_60e1(), coarse()))};
  const double touch = contact.search().touch_height(0.002, 0, 0.01);
  const long before = allocations;
  int patches = 0;
  for (double y = -0.013; y < 0.013; y += 1e-5) patches += contact.patches({y, touch + 1e-4, 0, 0.01}).count;
  EXPECT_EQ(allocations, before);
  EXPECT_GT(patches, 0);
}

TEST(ErrorStatistics, QuantilesAreThoseOfTheSample) {
  std::vector<double> values;
  for (int n = 1000; n >= 1; --n) values.push_back(n);
  const ErrorStatistics s = error_statistics(values);
  EXPECT_EQ(s.mean, 500.5);
  EXPECT_EQ(s.p50, 500);
  EXPECT_EQ(s.p95, 950);
  EXPECT_EQ(s.p99, 990);
  EXPECT_EQ(s.p999, 999);
  EXPECT_EQ(s.max, 1000);
  EXPECT_EQ(error_statistics({}).max, 0);
}

}  // namespace
}  // namespace railtab
