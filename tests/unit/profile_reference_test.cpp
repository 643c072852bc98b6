// Built-in profiles against the published point files of the Manchester contact benchmark, where they are at hand:
// RAILTAB_EXTERNAL_DATA names a folder with profiles/MBench_S1002_v3.prw and profiles/MBench_UIC60_v3.prr.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "railtab/runtime/profile/profile_curve.hpp"
#include "railtab/runtime/profile/profile_file.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/runtime/profile/wheel_rail_pair.hpp"
#include "s1002_definition.hpp"

namespace railtab {
namespace {

constexpr double mm = 1e-3;

class ManchesterProfiles : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* const folder = std::getenv("RAILTAB_EXTERNAL_DATA");
    if (folder == nullptr) GTEST_SKIP() << "RAILTAB_EXTERNAL_DATA is not set";
    folder_ = std::filesystem::path(folder) / "profiles";
    if (!std::filesystem::exists(folder_ / "MBench_S1002_v3.prw")) GTEST_SKIP() << "no MBench files in " << folder_;
  }
  [[nodiscard]] ProfileKnots points(const char* file, ProfileKind kind) const {
    return read_profile_file(folder_ / file, kind);
  }

 private:
  std::filesystem::path folder_;
};

// Normal distance [m] of a point from a curve that passes within some micrometres of it.
double normal_distance(const ProfileCurve& curve, double y, double z) {
  const ProfileKnots& k = curve.knots();
  std::size_t nearest = 0;
  double least = 1.0;
  for (std::size_t i = 0; i < k.s.size(); ++i) {
    const double d = std::hypot(k.y[i] - y, k.z[i] - z);
    if (d < least) nearest = i;
    least = std::min(least, d);
  }
  double s = k.s[nearest];
  for (int i = 0; i < 30; ++i) {
    const CurvePoint p = curve.at(s);
    s -= (p.y - y) * p.dy + (p.z - z) * p.dz;
  }
  const CurvePoint p = curve.at(s);
  return std::hypot(p.y - y, p.z - z);
}

TEST_F(ManchesterProfiles, WheelPointsLieOnTheBuiltInS1002) {
  const ProfileKnots file = points("MBench_S1002_v3.prw", ProfileKind::wheel);
  ASSERT_EQ(file.y.size(), 399u);
  const ProfileCurve built_in(standard_profile(ProfileKind::wheel, "S1002", 0.0));
  double worst = 0.0;
  double worst_c = 0.0;
  double worst_published = 0.0;
  for (std::size_t i = 0; i < file.y.size(); ++i) {
    const bool zone_c = file.y[i] > -35 * mm && file.y[i] < -26 * mm;
    double& w = zone_c ? worst_c : worst;
    w = std::max(w, normal_distance(built_in, file.y[i], file.z[i]));
    worst_published = std::max(worst_published, std::abs(testing::s1002_published(file.y[i] / mm) - file.z[i] / mm));
  }
  std::printf("S1002: %.2e mm outside zone C, %.2e mm in it; published zones in z: %.2e mm\n", worst / mm, worst_c / mm,
              worst_published);
  EXPECT_LT(worst, 2e-6 * mm);
  EXPECT_LT(worst_published, 2e-6);
  // The file has zone C as published, its steps open; the built-in profile closes them within the zone.
  EXPECT_LT(worst_c, 1e-4 * mm);
}

TEST_F(ManchesterProfiles, RailPointsLieOnTheBuiltIn60E1) {
  const ProfileKnots file = points("MBench_UIC60_v3.prr", ProfileKind::rail);
  ASSERT_EQ(file.y.size(), 495u);
  const ProfileCurve built_in(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0));
  double worst = 0.0;
  for (std::size_t i = 0; i < file.y.size(); ++i) {
    worst = std::max(worst, normal_distance(built_in, file.y[i], file.z[i]));
  }
  std::printf("60E1: %.2e mm\n", worst / mm);
  // The file's own joints are (10.4999, 25.9879) mm, the built-in ones the rounded (10.500, 25.988) mm: 4.4e-5 mm.
  EXPECT_LT(worst, 5e-5 * mm);
}

TEST_F(ManchesterProfiles, SplinedFilesGiveTheSamePair) {
  const WheelRailPair from_files(ProfileCurve(points("MBench_S1002_v3.prw", ProfileKind::wheel)),
                                 ProfileCurve(points("MBench_UIC60_v3.prr", ProfileKind::rail)), {});
  EXPECT_NEAR(from_files.rail_offset(), 0.7605385, 1e-7);
  // Between points 0.39 mm apart a cubic spline leaves h^4/(384 R^3) = 4e-5 mm on the tread's R > 100 mm.
  const ProfileCurve built_in(standard_profile(ProfileKind::wheel, "S1002", 0.0));
  for (double y = -15 * mm; y <= 30 * mm; y += 0.05 * mm) {
    EXPECT_NEAR(from_files.wheel().at(from_files.wheel().s_at_y(y)).z, built_in.at(built_in.s_at_y(y)).z, 4e-5 * mm);
  }
}

}  // namespace
}  // namespace railtab
