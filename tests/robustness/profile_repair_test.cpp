// Faults of measured profiles: what is repaired and said, what is rejected; MiniProf files; smoothing.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "profile_file_fixture.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/profile/point_noise.hpp"
#include "railtab/runtime/profile/profile_curve.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/runtime/profile/wheel_rail_pair.hpp"

namespace railtab {
namespace {

constexpr double mm = 1e-3;

class ProfileRepair : public ProfileFile {
 protected:
  /// Exactly the notes expected, each with its words.
  static void expect_notes(const ProfileKnots& knots, const std::vector<std::string>& words) {
    ASSERT_EQ(knots.notes.size(), words.size()) << (knots.notes.empty() ? "" : knots.notes.front());
    for (std::size_t i = 0; i < words.size(); ++i) {
      EXPECT_NE(knots.notes[i].find(words[i]), std::string::npos) << words[i] << " in " << knots.notes[i];
    }
  }
  [[nodiscard]] ProfileKnots wheel(const std::string& text) const {
    return read_profile_file(write("w.txt", text), ProfileKind::wheel);
  }
};

void expect_same_points(const ProfileKnots& a, const ProfileKnots& b) {
  ASSERT_EQ(a.y.size(), b.y.size());
  for (std::size_t i = 0; i < a.y.size(); ++i) {
    EXPECT_NEAR(a.y[i], b.y[i], 1e-15);
    EXPECT_NEAR(a.z[i], b.z[i], 1e-15);
  }
}

std::string listed(const ProfileKnots& k, double y_scale, double z_scale, const std::string& units = "# units: mm\n") {
  std::string text = units;
  for (std::size_t i = 0; i < k.y.size(); ++i) text += fmt::format("{} {}\n", k.y[i] * y_scale, k.z[i] * z_scale);
  return text;
}

TEST_F(ProfileRepair, AGoodFileHasNoNotes) { expect_notes(wheel(wheel_points), {}); }

TEST_F(ProfileRepair, UnitsFollowFromTheWidthWhereNoneAreStated) {
  const ProfileKnots good = wheel(wheel_points);
  const ProfileKnots mm_file = wheel(listed(good, 1e3, 1e3, ""));
  expect_same_points(mm_file, good);
  expect_notes(mm_file, {"taken as mm from the width of 100"});
  const ProfileKnots m_file = wheel(listed(good, 1.0, 1.0, ""));
  expect_same_points(m_file, good);
  expect_notes(m_file, {"taken as m from the width of 0.1"});
}

TEST_F(ProfileRepair, RepeatedPointsAreLeftOut) {
  const ProfileKnots k = wheel(replaced(wheel_points, "\n-20 1.2\n", "\n-20 1.2\n-20 1.2\n-20 1.2000000001\n"));
  expect_same_points(k, wheel(wheel_points));
  expect_notes(k, {"w.txt:9: 2 repeated points"});
}

// A tread with points 0.5 mm apart, y from -20 to 20 mm, and a flange.
std::string dense_wheel(const std::string& inserted_after_zero) {
  std::string text = "# units: mm\n-60 20\n-55 28\n-50 26\n-45 18\n-40 8\n-30 3\n";
  for (int i = -40; i <= 40; ++i) {
    text += fmt::format("{} {}\n", 0.5 * i, -0.025 * i);
    if (i == 0) text += inserted_after_zero;
  }
  return text;
}

TEST_F(ProfileRepair, SmallStepsBackOfStitchedScansAreLeftOut) {
  // The second scan begins 1.2 mm before the end of the first, 0.02 mm below it. Lines 49 to 51.
  const ProfileKnots k = wheel(dense_wheel("-1.2 0.08\n-0.7 0.055\n-0.2 0.03\n"));
  expect_same_points(k, wheel(dense_wheel("")));
  expect_notes(k, {"w.txt:49: 3 points that step back"});
  // Further back, or off the outline: which of the scans is right cannot be told.
  expect_rejected("w.txt", dense_wheel("-2.2 0.11\n"), ProfileKind::wheel, {"w.txt:48:", "turns back"});
  expect_rejected("w.txt", dense_wheel("-0.7 0.15\n"), ProfileKind::wheel, {"w.txt:48:", "turns back"});
}

TEST_F(ProfileRepair, ManyStepsBackAreRejected) {
  std::string text = "# units: mm\n-60 20\n-55 28\n-50 26\n-45 18\n-40 8\n-30 3\n";
  for (int i = -20; i <= 20; ++i) text += fmt::format("{} {}\n{} {}\n", i, -0.05 * i, i - 0.3, -0.05 * (i - 0.3));
  expect_rejected("w.txt", text, ProfileKind::wheel, {"points that step back", "w.txt:9:"});
}

TEST_F(ProfileRepair, WheelAxesFollowFromTheFlange) {
  const ProfileKnots good = wheel(wheel_points);
  const ProfileKnots up = wheel(listed(good, 1e3, -1e3));
  expect_same_points(up, good);
  expect_notes(up, {"z mirrored"});
  const ProfileKnots inward = wheel(listed(good, -1e3, 1e3));
  expect_same_points(inward, good);
  expect_notes(inward, {"y mirrored"});
  const ProfileKnots both = wheel(listed(good, -1e3, -1e3));
  expect_same_points(both, good);
  expect_notes(both, {"z mirrored", "y mirrored"});
}

// The S1002 from y_begin on, with a vertical face of the rim behind the flange or at the field side up to these
// heights.
std::string s1002_with_faces(double y_begin, double back, double front, double y_sign = 1.0, double z_sign = 1.0) {
  const ProfileCurve exact(standard_profile(ProfileKind::wheel, "S1002", 0.0));
  std::string text = "# units: mm\n";
  const auto add = [&](double y, double z) { text += fmt::format("{:.6f} {:.6f}\n", y_sign * y, z_sign * z); };
  const CurvePoint first = exact.at(exact.s_begin()), last = exact.at(exact.s_end());
  for (double z = back; z < first.z / mm - 0.5; z += 0.5) add(first.y / mm, z);
  for (double s = exact.s_begin(); s < exact.s_end(); s += 0.4 * mm) {
    const CurvePoint p = exact.at(s);
    if (p.y >= y_begin) add(p.y / mm, p.z / mm);
  }
  for (double z = last.z / mm; z > front; z -= 0.5) add(last.y / mm, z);
  return text;
}

TEST_F(ProfileRepair, AFaceOfTheRimThatIsHigherThanTheFlangeIsNone) {
  constexpr double none_behind = 1e3, none_at_field = 1e3;
  for (const std::string& text : {s1002_with_faces(-58 * mm, none_behind, -40), s1002_with_faces(-1, none_behind, -40),
                                  s1002_with_faces(-1, -35, none_at_field), s1002_with_faces(-1, -35, -35)}) {
    const ProfileKnots k = wheel(text);
    expect_notes(k, {});
    EXPECT_GT(*std::max_element(k.z.begin(), k.z.end()), 27 * mm);
  }
  const ProfileKnots both = wheel(s1002_with_faces(-58 * mm, none_behind, -40, -1.0, -1.0));
  expect_notes(both, {"z mirrored", "y mirrored"});
  EXPECT_GT(*std::max_element(both.z.begin(), both.z.end()), 27 * mm);
}

TEST_F(ProfileRepair, AMissingFlangeIsSaid) {
  const ProfileKnots k = wheel("# units: mm\n-30 3\n-20 1.2\n-10 0.5\n0 0\n10 -0.5\n20 -1\n30 -1.5\n");
  expect_notes(k, {"no flange"});
}

// The built-in 60E1 1:40 as points, cut at `depth` below the top on the gauge side.
std::string rail_60e1_points(double depth, double y_sign = 1.0, double z_sign = 1.0) {
  const ProfileCurve rail(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0));
  std::string text = "# units: mm\n";
  for (double s = rail.s_begin(); s < rail.s_end(); s += 0.3 * mm) {
    const CurvePoint p = rail.at(s);
    if (p.y < 0.0 && p.z > depth) continue;
    text += fmt::format("{:.6f} {:.6f}\n", y_sign * p.y / mm, z_sign * p.z / mm);
  }
  return text;
}

TEST_F(ProfileRepair, RailThatPointsUpIsTurned) {
  const ProfileKnots good = read_profile_file(write("r.txt", rail_60e1_points(1.0)), ProfileKind::rail);
  expect_notes(good, {});
  const ProfileKnots up = read_profile_file(write("r.txt", rail_60e1_points(1.0, 1.0, -1.0)), ProfileKind::rail);
  expect_same_points(up, good);
  expect_notes(up, {"z mirrored"});
}

TEST_F(ProfileRepair, RailOfTheWrongSideOrUprightIsSaid) {
  const ProfileKnots other = read_profile_file(write("r.txt", rail_60e1_points(1.0, -1.0)), ProfileKind::rail);
  expect_notes(other, {"leans to the field side"});
  EXPECT_NE(other.notes[0].find("its middle 7."), std::string::npos) << other.notes[0];
  std::string upright = "# units: mm\n";
  for (const char* p : {"-36 30", "-35.5 16", "-33 8", "-25 3", "0 0", "25 3", "33 8", "35.5 16", "36 30"}) {
    upright += std::string(p) + "\n";
  }
  expect_notes(read_profile_file(write("r.txt", upright), ProfileKind::rail), {"stands upright"});
}

TEST_F(ProfileRepair, ARailHeadWithExchangedColumnsIsSaid) {
  std::string exchanged = "# units: mm\n";
  for (const char* p : {"30 -36", "16 -35.5", "8 -33", "3 -25", "0 0", "3 25", "8 33", "16 35.5", "30.1 36"}) {
    exchanged += std::string(p) + "\n";
  }
  expect_rejected("r.txt", exchanged, ProfileKind::rail, {"highest point", "are y and z exchanged?"});
}

TEST_F(ProfileRepair, AGaugeFaceNotMeasuredDeepEnoughIsContinued) {
  const ProfileKnots whole = read_profile_file(write("r.txt", rail_60e1_points(1.0)), ProfileKind::rail);
  const ProfileKnots cut = read_profile_file(write("r.txt", rail_60e1_points(13.0 * mm)), ProfileKind::rail);
  expect_notes(cut, {"the gauge face ends 12."});
  const auto offset = [](const ProfileKnots& rail) {
    return WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "S1002", 0.0)), ProfileCurve(rail), {})
        .rail_offset();
  };
  for (const double depth : {10.6, 12.0, 13.0}) {
    const ProfileKnots k = read_profile_file(write("r.txt", rail_60e1_points(depth * mm)), ProfileKind::rail);
    expect_notes(k, {"along the corner's radius of 13 mm, then vertically to 17 mm"});
    EXPECT_NEAR(offset(k), offset(whole), 0.01 * mm) << depth;
  }
  const ProfileKnots shallow = read_profile_file(write("r.txt", rail_60e1_points(8.0 * mm)), ProfileKind::rail);
  expect_notes(shallow, {});
  EXPECT_THROW(static_cast<void>(offset(shallow)), InputError);
}

// ---------------------------------------------------------------------------------------------------------- MiniProf

std::string miniprof(const std::string& header, const std::string& points) {
  return "Filename=x\nProgramName=MPWIN\nXYPoints=13\n" + header + "\n" + points;
}
const std::string mini_points =
    "60 -20 0.1 0\n55 -28 0.1 0\n50 -26 0.1 0\n45 -18 0.1 0\n40 -8 0.1 0\n30 -3 0.1 0\n20 -1.2 0.1 0\n10 -0.5 0.1 0\n0 "
    "0 "
    "0.1 0\n-10 0.5 0.1 0\n-20 1 0.1 0\n-30 1.5 0.1 0\n-40 2 0.1 0\n";

TEST_F(ProfileRepair, ReadsMiniprofWheelsInAnySign) {
  const std::string text = miniprof("ColumnDef=X,Y,A,C\nXOffset=\nTilt=\n", mini_points);
  const ProfileKnots k = read_profile_file(write("w.whl", text), ProfileKind::wheel);
  expect_same_points(k, wheel(wheel_points));
  expect_notes(k, {"z mirrored", "y mirrored"});
  // Columns in another order, offsets, comments, a count that is wrong.
  std::string swapped = "Date=1\nXYPoints=14\nColumnDef=Y,X\nXOffset=1.5\nYOffset=-0.5\n\n\" 1 2 3\n# 4\n";
  const ProfileKnots good = wheel(wheel_points);
  for (std::size_t i = 0; i < good.y.size(); ++i) {
    swapped += fmt::format("{:.12f}\t{:.12f}\n", good.z[i] / mm + 0.5, good.y[i] / mm - 1.5);
  }
  const ProfileKnots o = read_profile_file(write("w.whl", swapped), ProfileKind::wheel);
  expect_same_points(o, good);
  expect_notes(o, {"13 points, where XYPoints says 14"});
}

TEST_F(ProfileRepair, ReadsMiniprofRailsWithTheirGaugeSideAtPositiveX) {
  std::string text = "XYPoints=61\n\n" + rail_points("");
  const ProfileKnots k = read_profile_file(write("r.ban", text), ProfileKind::rail);
  expect_notes(k, {"y = -X", "field side ends 4.6"});
  ASSERT_EQ(k.y.size(), 61u);
  EXPECT_NEAR(k.y.front(), -0.030, 1e-9);
}

TEST_F(ProfileRepair, KeysThatDifferInCaseAloneAreSaid) {
  const ProfileKnots mini =
      read_profile_file(write("w.whl", miniprof("YOFFSET=2\nNote=3\n", mini_points)), ProfileKind::wheel);
  expect_notes(mini, {"w.whl:4: the key YOFFSET is ignored; the known key is YOffset", "z mirrored", "y mirrored"});
  const std::string points = "-60 20\n-50 28\n-40 8\n-20 0\n10 0\n30 5\n40 5\n";
  const std::string options = "Shift.Y = 2\ncomment = a\n" + in_mm;
  const ProfileKnots k = read_profile_file(write("w.prw", simpack(options, 1, points)), ProfileKind::wheel);
  expect_notes(k, {"w.prw:6: the key Shift.Y is ignored; the known key is shift.y"});
}

TEST_F(ProfileRepair, RejectsBrokenMiniprofFilesWithTheLine) {
  const auto rejected = [&](const std::string& text, const std::vector<std::string>& words) {
    expect_rejected("w.whl", text, ProfileKind::wheel, words);
  };
  rejected(miniprof("ColumnDef=X,A\n", mini_points), {"w.whl:4:", "X and Y"});
  rejected(miniprof("ColumnDef=X,Y\n", mini_points), {"w.whl:6:", "2 numbers"});
  rejected(miniprof("XOffset=a\n", mini_points), {"w.whl:4:", "XOffset"});
  rejected(miniprof("", mini_points + "Tilt=3\n"), {"w.whl:18:", "after the first point"});
  rejected(miniprof("", mini_points + "50\n"), {"w.whl:18:", "at least two"});
  rejected(miniprof("", replaced(mini_points, "45 ", "x ")), {"w.whl:8:", "\"x\""});
  rejected(miniprof("", ""), {"0 points"});
}

TEST_F(ProfileRepair, ReadsThePublishedMiniprofRail) {
  const char* const folder = std::getenv("RAILTAB_EXTERNAL_DATA");
  if (folder == nullptr) GTEST_SKIP() << "RAILTAB_EXTERNAL_DATA is not set";
  const std::filesystem::path profiles = std::filesystem::path(folder) / "profiles";
  if (!std::filesystem::exists(profiles / "MBench_UIC60_v3.ban")) GTEST_SKIP() << "no MBench files in " << profiles;
  const ProfileKnots ban = read_profile_file(profiles / "MBench_UIC60_v3.ban", ProfileKind::rail);
  const ProfileKnots prr = read_profile_file(profiles / "MBench_UIC60_v3.prr", ProfileKind::rail);
  expect_notes(ban, {"476 points, where XYPoints says 495", "y = -X"});
  const ProfileCurve curve(ban);
  const ProfileCurve same(prr);
  for (double y = -40 * mm; y < 28 * mm; y += 0.7 * mm) {
    EXPECT_NEAR(curve.at(curve.s_at_y(y)).z, same.at(same.s_at_y(y)).z, 1e-7) << y;
  }
}

// --------------------------------------------------------------------------------------------------------- smoothing

struct Noisy {
  std::vector<double> y, z;
};

// The S1002 at points `spacing` apart with Gaussian noise normal to it.
Noisy noisy_s1002(const ProfileCurve& exact, double spacing, double noise) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;  // of deviation 1: 0 is none that the library takes
  Noisy points;
  for (double s = exact.s_begin(); s <= exact.s_end(); s += spacing) {
    const CurvePoint p = exact.at(s);
    const double n = noise * normal(random);
    points.y.push_back(p.y - n * p.dz);
    points.z.push_back(p.z + n * p.dy);
  }
  return points;
}

struct CurveError {
  double position = 0.0;   // rms, vertical [m]
  double curvature = 0.0;  // rms [1/m]
};

// On the tread, where contact runs.
CurveError tread_error(const ProfileKnots& knots, const ProfileCurve& exact) {
  const ProfileCurve curve(knots);
  CurveError e;
  int n = 0;
  for (double y = -25 * mm; y <= 28 * mm; y += 0.05 * mm, ++n) {
    const CurvePoint a = curve.at(curve.s_at_y(y));
    const CurvePoint b = exact.at(exact.s_at_y(y));
    e.position += (a.z - b.z) * (a.z - b.z);
    const double kappa = a.curvature() - b.curvature();
    e.curvature += kappa * kappa;
  }
  return {std::sqrt(e.position / n), std::sqrt(e.curvature / n)};
}

TEST(SmoothingSpline, OfANoisyS1002KeepsThePositionAndRestoresTheCurvature) {
  const ProfileCurve exact(standard_profile(ProfileKind::wheel, "S1002", 0.0));
  for (const double noise : {2e-6, 10e-6}) {
    const Noisy p = noisy_s1002(exact, 0.2 * mm, noise);
    const CurveError raw = tread_error(spline_through_points(ProfileKind::wheel, "raw", p.y, p.z), exact);
    const SmoothedProfile smoothed = smoothing_spline(ProfileKind::wheel, "smoothed", p.y, p.z, noise);
    const CurveError error = tread_error(smoothed.knots, exact);
    std::printf(
        "noise %.0f um: curvature error %.1f -> %.3f 1/m (factor %.0f), position %.2f -> %.2f um; largest distance "
        "%.1f\n",
        1e6 * noise, raw.curvature, error.curvature, raw.curvature / error.curvature, 1e6 * raw.position,
        1e6 * error.position, smoothed.largest_distance / noise);
    EXPECT_NEAR(smoothed.rms_distance, noise, 1e-6 * noise);
    // The flange's arcs of 12 to 20 mm join with jumps of curvature, which are rounded.
    EXPECT_LT(smoothed.largest_distance, 8.0 * noise);
    EXPECT_GT(raw.curvature / error.curvature, 100.0);
    EXPECT_LT(error.position, 0.6 * noise);
    EXPECT_LT(error.position, raw.position);
  }
}

TEST(SmoothingSpline, OfExactPointsIsNearlyTheSplineThroughThem) {
  const ProfileCurve exact(standard_profile(ProfileKind::wheel, "S1002", 0.0));
  const Noisy p = noisy_s1002(exact, 0.2 * mm, 0.0);
  const SmoothedProfile smoothed = smoothing_spline(ProfileKind::wheel, "smoothed", p.y, p.z, 1e-9);
  EXPECT_LT(tread_error(smoothed.knots, exact).position, 1e-9);
}

TEST(PointNoise, IsTheScatterOfThePointsAndNoneOfExactOnes) {
  const ProfileCurve exact(standard_profile(ProfileKind::wheel, "S1002", 0.0));
  for (const double noise : {0.0, 1e-7, 1e-6, 1e-5}) {
    for (const double spacing : {0.1 * mm, 0.2 * mm, 0.5 * mm}) {
      const Noisy p = noisy_s1002(exact, spacing, noise);
      const PointNoise found = point_noise(spline_through_points(ProfileKind::wheel, "raw", p.y, p.z));
      const double curvature = std::sqrt(6.0) * noise / (spacing * spacing);
      EXPECT_NEAR(found.deviation, noise, 0.15 * noise + 2e-9) << noise << ' ' << spacing;
      EXPECT_NEAR(found.curvature, curvature, 0.15 * curvature + 0.5) << noise << ' ' << spacing;
    }
  }
  EXPECT_EQ(point_noise(spline_through_points(ProfileKind::wheel, "few", {0.0, 0.1, 0.2}, {0.0, 0.1, 0.0})).deviation,
            0.0);
  for (const ProfileKind kind : {ProfileKind::wheel, ProfileKind::rail}) {
    for (const std::string& name : standard_profile_names(kind)) {
      EXPECT_LT(point_noise(standard_profile(kind, name, 0.025)).curvature, 1.0) << name;
    }
  }
}

TEST(PointNoise, ScatterOfTheRunningBandAloneIsFound) {
  const ProfileCurve exact(standard_profile(ProfileKind::wheel, "S1002", 0.0));
  for (const double spacing : {0.1 * mm, 0.2 * mm, 0.5 * mm}) {
    Noisy p = noisy_s1002(exact, spacing, 10e-6);
    const Noisy clean = noisy_s1002(exact, spacing, 0.0);
    for (std::size_t i = 0; i < p.y.size(); ++i) {
      if (std::abs(clean.y[i]) < 10 * mm) continue;
      p.y[i] = clean.y[i];
      p.z[i] = clean.z[i];
    }
    const PointNoise found = point_noise(spline_through_points(ProfileKind::wheel, "band", p.y, p.z));
    EXPECT_GT(found.deviation, 7e-6) << spacing;
    EXPECT_LT(found.deviation, 18e-6) << spacing;
    EXPECT_LT(found.smoothing, 6e-6) << spacing;  // of all points
    EXPECT_GT(found.y_begin, -15 * mm) << spacing;
    EXPECT_LT(found.y_end, 15 * mm) << spacing;
    EXPECT_NE(noise_warning("band", found).find("of band from y = "), std::string::npos);
  }
  // Arcs of the flange in coarse points are no noise.
  const Noisy coarse = noisy_s1002(exact, 2 * mm, 0.0);
  EXPECT_EQ(
      noise_warning("coarse", point_noise(spline_through_points(ProfileKind::wheel, "coarse", coarse.y, coarse.z))),
      "");
}

TEST(SmoothingSpline, RejectsNoiseOutOfRange) {
  const std::vector<double> y{0.0, 0.01, 0.02, 0.03, 0.04};
  const std::vector<double> z{0.0, 1e-6, 0.0, 1e-6, 0.0};
  for (const double noise : {0.0, -1e-6, 2e-3, std::nan("")}) {
    EXPECT_THROW(static_cast<void>(smoothing_spline(ProfileKind::rail, "r", y, z, noise)), InputError) << noise;
  }
  EXPECT_THROW(static_cast<void>(smoothing_spline(ProfileKind::rail, "line", y, z, 1e-5)), InputError);
}

TEST_F(ProfileRepair, WheelAndRailExchangedAreRejected) {
  const std::string wheel_file = listed(standard_profile(ProfileKind::wheel, "S1002", 0.0), 1e3, 1e3);
  const std::string rail_file = listed(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0), 1e3, 1e3);
  EXPECT_EQ(rejection("w.txt", wheel_file, ProfileKind::wheel), "");
  EXPECT_EQ(rejection("r.txt", rail_file, ProfileKind::rail), "");
  expect_rejected("r.txt", rail_file, ProfileKind::wheel, {"r.txt: ", "are wheel and rail exchanged?"});
  expect_rejected("w.txt", wheel_file, ProfileKind::rail, {"w.txt: ", "are wheel and rail exchanged?"});
}

TEST_F(ProfileRepair, AByteOrderMarkIsNoPartOfTheFirstLine) {
  expect_same_points(wheel("\xEF\xBB\xBF" + std::string(wheel_points)), wheel(wheel_points));
}

TEST_F(ProfileRepair, SmoothingIsSaid) {
  const ProfileCurve exact(standard_profile(ProfileKind::wheel, "S1002", 0.0));
  const Noisy p = noisy_s1002(exact, 0.2 * mm, 5e-6);
  std::string text = "# units: m\n";
  for (std::size_t i = 0; i < p.y.size(); ++i) text += fmt::format("{} {}\n", p.y[i], p.z[i]);
  const ProfileKnots k = read_profile_file(write("w.txt", text), ProfileKind::wheel, 5e-6);
  expect_notes(k, {"smoothed: points moved by 5 um rms"});
}

}  // namespace
}  // namespace railtab
