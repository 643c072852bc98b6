// Profile files: what is read, and what is rejected with its file and line.

#include "railtab/runtime/profile/profile_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "profile_file_fixture.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/profile/profile_curve.hpp"

namespace railtab {
namespace {

// ------------------------------------------------------------------------------------------------------ two columns

TEST_F(ProfileFile, ReadsTwoColumnsInMillimetresOrMetresAndCentresTheRail) {
  expect_round_head(read_profile_file(write("head.txt", rail_points()), ProfileKind::rail));
  expect_round_head(read_profile_file(write("head_m.dat", rail_points("! Units:  m \n", 1e-3)), ProfileKind::rail));
  EXPECT_EQ(read_profile_file(folder_ / "head.txt", ProfileKind::rail).name, "head.txt");
}

TEST_F(ProfileFile, ReadsCommentsSeparatorsAndForeignLineEnds) {
  std::string text = rail_points("# a head\r\n#units:mm\r\n\r\n");
  text = replaced(text, "-28.000000000 ", "-28.000000000,\t");
  text = replaced(text, "-27.000000000 ", "+-27.000000000 ");
  EXPECT_NE(rejection("sign.txt", text, ProfileKind::rail), "");
  text = replaced(text, "+-27.000000000 ", "  -27.0E+0 ; ");
  text = replaced(text, "\n3.000000000 ", " ! the top is near\n+3.000000000 ");
  expect_round_head(read_profile_file(write("head.txt", text), ProfileKind::rail));
}

TEST_F(ProfileFile, TakesPointsInEitherDirection) {
  const ProfileKnots forward = read_profile_file(write("a.txt", wheel_points), ProfileKind::wheel);
  std::string reversed = "# units: mm\n";
  for (std::size_t i = forward.y.size(); i-- > 0;) {
    reversed += fmt::format("{} {}\n", forward.y[i] * 1e3, forward.z[i] * 1e3);
  }
  const ProfileKnots backward = read_profile_file(write("b.txt", reversed), ProfileKind::wheel);
  ASSERT_EQ(backward.y.size(), forward.y.size());
  for (std::size_t i = 0; i < forward.y.size(); ++i) {
    EXPECT_NEAR(backward.y[i], forward.y[i], 1e-15);
    EXPECT_NEAR(backward.dz[i], forward.dz[i], 1e-12);
  }
  EXPECT_EQ(forward.y[8], 0.0) << "a wheel keeps its origin";
}

TEST_F(ProfileFile, RejectsWrongUnits) {
  expect_rejected("head.txt", rail_points("", 0.02), ProfileKind::rail, {"head.txt", "width of 1.2", "5 to 500 (mm)"});
  expect_rejected("head.txt", rail_points("") + "# units: mm\n", ProfileKind::rail, {"head.txt:62:", "before all"});
  expect_rejected("head.txt", rail_points("# units: inch\n"), ProfileKind::rail, {"head.txt:1:", "inch", "mm"});
  expect_rejected("head.txt", rail_points("# units: m\n"), ProfileKind::rail, {"60 m wide", "check the units"});
  expect_rejected("head.txt", rail_points("# units: mm\n", 1e-3), ProfileKind::rail,
                  {"60 mm wide if the file is in m"});
}

// 100 mm wide in cm and in inches; the same with y and z exchanged.
TEST_F(ProfileFile, RejectsProfilesTooNarrowForTheirKind) {
  const ProfileKnots k = read_profile_file(write("wheel.txt", wheel_points), ProfileKind::wheel);
  const auto listed = [&](double per_metre, bool exchanged) {
    std::string text;
    for (std::size_t i = 0; i < k.y.size(); ++i) {
      const double y = per_metre * k.y[i], z = per_metre * k.z[i];
      text += fmt::format("{} {}\n", exchanged ? z : y, exchanged ? y : z);
    }
    return text;
  };
  expect_rejected(
      "cm.txt", listed(100.0, false), ProfileKind::wheel,
      {"cm.txt: found a profile 0.01 m wide", "a wheel at least 0.06 m wide", "100 mm wide if the file is in cm"});
  expect_rejected("wide.txt", listed(1e3 / 16.0, false), ProfileKind::wheel, {"159 mm wide if the file is in inches"});
  expect_rejected("swapped.txt", listed(1e3, true), ProfileKind::wheel, {"0.1 m high", "are y and z exchanged?"});
  expect_rejected("cm.txt", rail_points("", 0.1), ProfileKind::rail,
                  {"a rail head at least 0.02 m wide", "60 mm wide if the file is in cm"});
}

TEST_F(ProfileFile, RejectsFieldsThatAreNoNumbers) {
  for (const char* bad : {"x", "1,5", "nan", "inf", "1e999", "0x10", "1.0.0", "--1", "1D+00"}) {
    const std::string text = replaced(rail_points(), "-18.000000000 ", std::string(bad) + " ");
    expect_rejected("head.txt", text, ProfileKind::rail, {"head.txt:12:", "expected"});
  }
  expect_rejected("head.txt", replaced(rail_points(), "-18.000000000 ", "-18.0 1 2 3 "), ProfileKind::rail,
                  {"head.txt:12:", "two numbers"});
  expect_rejected("head.txt", replaced(rail_points(), "-18.000000000 ", ""), ProfileKind::rail, {"head.txt:12:"});
}

TEST_F(ProfileFile, NamesDecimalCommas) {
  for (const char* line : {"-69,9 11,5", "-69,9  11,5", "-69,9;11,5"}) {
    expect_rejected(
        "wheel.txt", std::string(line) + "\n", ProfileKind::wheel,
        {"wheel.txt:1:", std::string("\"") + line + "\"", "expected two numbers y z, with decimal points: -69.9 11.5"});
  }
  expect_rejected("wheel.txt", "-69,9 11\n", ProfileKind::wheel, {"with decimal points: -69.9 11"});
  EXPECT_EQ(rejection("wheel.txt", "1, 2, 3\n", ProfileKind::wheel).find("decimal points"), std::string::npos);
  const std::string comma = replaced(simpack(in_mm), "-18.000000000 ", "-18,5 1,5 ");
  expect_rejected("head.prr", comma, ProfileKind::rail, {"head.prr:18:", "two numbers y z, and a weight if any"});
}

TEST_F(ProfileFile, RejectsTooFewPoints) {
  expect_rejected("few.txt", "# units: mm\n-10 1\n0 0\n10 1\n", ProfileKind::rail,
                  {"few.txt", "3 points", "at least 4"});
  expect_rejected("empty.txt", "", ProfileKind::rail, {"0 points"});
  expect_rejected("comment.txt", "# units: mm\n", ProfileKind::rail, {"0 points"});
}

// ----------------------------------------------------------------------------------------------- outlines of no body

TEST_F(ProfileFile, RejectsPointsInWrongOrder) {
  expect_rejected("wheel.txt", replaced(wheel_points, "-20 1.2\n-10 0.5\n", "-10 0.5\n-20 1.2\n"), ProfileKind::wheel,
                  {"wheel.txt:8:", "turns back"});
  // Two overlapping scans stitched together: a zig-zag on the tread.
  expect_rejected("wheel.txt", replaced(wheel_points, "10 -0.5\n", "10 -0.5\n4 -0.19\n12 -0.6\n"), ProfileKind::wheel,
                  {"wheel.txt:11:", "turns back"});
}

TEST_F(ProfileFile, RejectsAnOutlineThatCrossesItself) {
  // A loop of four right-angled turns, none of which turns back.
  expect_rejected("wheel.txt", replaced(wheel_points, "0 0\n10 -0.5\n", "0 0\n4 4\n8 0\n4 -4\n0 2\n10 5\n"),
                  ProfileKind::wheel, {"wheel.txt:14:", "crosses", "lines 10 to 11"});
}

TEST_F(ProfileFile, RejectsAnOutlineThatTouchesItself) {
  // Back exactly onto the segment from (0, 0) to (10, 10), at (5, 5), and away on the same side.
  expect_rejected("wheel.txt", replaced(wheel_points, "0 0\n10 -0.5\n", "0 0\n10 10\n14 10\n14 2\n5 5\n5 -1\n16 -3\n"),
                  ProfileKind::wheel, {"crosses", "lines 10 to 11"});
}

// A hook that comes back to within `gap` of the segment from (0, 0) to (10, 10), or passes it by as little.
TEST_F(ProfileFile, DecidesCrossingTheSameWhereverTheOutlineLies) {
  for (const double shift : {0.0, 0.1, 1.0 / 3.0, 17.7}) {
    for (const double gap : {1e-3, 1e-9, -1e-9, -1e-3}) {  // mm
      std::string text = "# units: mm\n";
      for (const auto& [y, z] : {std::pair{-60.0, 20.0},
                                 {-55.0, 28.0},
                                 {-45.0, 18.0},
                                 {-30.0, 3.0},
                                 {0.0, 0.0},
                                 {10.0, 10.0},
                                 {14.0, 10.0},
                                 {14.0, 2.0},
                                 {5.0 + gap, 5.0 - gap},
                                 {5.0, -1.0},
                                 {16.0, -3.0},
                                 {40.0, -4.0}}) {
        text += fmt::format("{:.12f} {:.12f}\n", y + shift, z + shift);
      }
      const std::string message = rejection("hook.txt", text, ProfileKind::wheel);
      EXPECT_EQ(message.empty(), gap > 0) << "shift " << shift << ", gap " << gap << ": " << message;
      EXPECT_EQ(message.find("crosses") != std::string::npos, gap < 0) << message;
    }
  }
}

TEST_F(ProfileFile, RejectsWhatIsNeitherWheelNorRail) {
  std::string shifted = "# units: mm\n";
  const ProfileKnots k = read_profile_file(write("wheel.txt", wheel_points), ProfileKind::wheel);
  for (std::size_t i = 0; i < k.y.size(); ++i) shifted += fmt::format("{} {}\n", k.y[i] * 1e3 + 70, k.z[i] * 1e3);
  expect_rejected("wheel.txt", shifted, ProfileKind::wheel, {"tape circle"});
  // A piece of a crown could be either way up; a slope is no head either way.
  std::string crown = "# units: mm\n";
  for (int y = -15; y <= 15; y += 5) crown += fmt::format("{} {}\n", y, -0.005 * y * y);
  expect_rejected("rail.txt", crown, ProfileKind::rail, {"highest point", "z positive downwards"});
  expect_rejected("rail.txt", "# units: mm\n-30 4\n-10 3\n10 1\n30 0\n", ProfileKind::rail, {"highest point"});
}

TEST_F(ProfileFile, RejectsWhatIsNoFile) {
  EXPECT_THROW(static_cast<void>(read_profile_file(folder_ / "absent.prw", ProfileKind::wheel)), InputError);
  EXPECT_THROW(static_cast<void>(read_profile_file(folder_, ProfileKind::wheel)), InputError);
}

// ----------------------------------------------------------------------------------------------------------- SIMPACK

TEST_F(ProfileFile, ReadsSimpackUnitsCommentsAndWeights) {
  expect_round_head(read_profile_file(write("head.prr", simpack(in_mm)), ProfileKind::rail));
  const std::string options = "! comment\n file = 'a!b.txt' ! quoted mark\n units.len = 'mm'\n" + in_mm;
  std::string weighted = rail_points("");
  weighted = replaced(weighted, "\n", " 1.0 ! weight\n");
  expect_round_head(read_profile_file(write("HEAD.PRR", simpack(options, 0, weighted)), ProfileKind::rail));
}

// Options, and where they take the point (30, 5) mm.
struct SimpackCase {
  std::string options;
  double y, z;  // mm
};

TEST_F(ProfileFile, ObeysSimpackOptionsInTheirOrder) {
  const std::string points = "-60 20\n-50 28\n-40 8\n-20 0\n10 0\n30 5\n40 5\n";
  const double quarter = std::cos(0.1);
  const double sine = std::sin(0.1);
  for (const SimpackCase& c : {
           SimpackCase{"shift.y = 1\nshift.z = -2\n", 31, 3},
           SimpackCase{"rotate = 0.1\n", 30 * quarter - 5 * sine, 30 * sine + 5 * quarter},
           SimpackCase{"rotate = 5.729577951308232\nunits.ang.f = 57.29577951308232\n", 30 * quarter - 5 * sine,
                       30 * sine + 5 * quarter},
           // shift before rotation
           SimpackCase{"rotate = 0.1\nshift.y = 10\n", 40 * quarter - 5 * sine, 40 * sine + 5 * quarter},
           // bounds after the shift: only the shifted y of 41 is outside
           SimpackCase{"shift.y = 1\nbound.y.min = -100\nbound.y.max = 40.5\n", 31, 5},
           SimpackCase{"bound.y.min = 1\nbound.y.max = 0\n", 30, 5},  // inactive
       }) {
    const ProfileKnots k = read_profile_file(write("w.prw", simpack(c.options + in_mm, 1, points)), ProfileKind::wheel);
    ASSERT_GE(k.y.size(), 6u) << c.options;
    EXPECT_NEAR(k.y[5], c.y * 1e-3, 1e-15) << c.options;
    EXPECT_NEAR(k.z[5], c.z * 1e-3, 1e-15) << c.options;
    EXPECT_EQ(k.y.size(), c.options.find("40.5") == std::string::npos ? 7u : 6u) << c.options;
  }
}

TEST_F(ProfileFile, ObeysSimpackMirrorsInversionAndPointDistance) {
  const std::string mirrored = "60 -20\n50 -28\n40 -8\n20 0\n-10 0\n-10.001 0\n-30 -5\n-40 -5\n";
  for (const int inversion : {0, 1}) {
    const std::string options =
        fmt::format("mirror.y = 1\nmirror.z = 1\ninversion = {}\npoint.dist.min = 0.01\n", inversion);
    const ProfileKnots k = read_profile_file(write("w.prw", simpack(options + in_mm, 1, mirrored)), ProfileKind::wheel);
    ASSERT_EQ(k.y.size(), 7u);
    EXPECT_NEAR(k.y[0], -0.060, 1e-16);
    EXPECT_NEAR(k.z[0], 0.020, 1e-16);
    EXPECT_NEAR(k.y[4], 0.010, 1e-16);
    EXPECT_NEAR(k.z[6], 0.005, 1e-16);
  }
}

TEST_F(ProfileFile, KeepsSimpackPointsWithinHeightBounds) {
  const std::string points = "-60 20\n-50 28\n-40 8\n-20 0\n10 0\n30 5\n40 5\n";
  const std::string options = "bound.z.min = -1\nbound.z.max = 27\n" + in_mm;
  const ProfileKnots k = read_profile_file(write("w.prw", simpack(options, 1, points)), ProfileKind::wheel);
  ASSERT_EQ(k.y.size(), 6u);
  EXPECT_NEAR(k.y[1], -0.040, 1e-16);
}

TEST_F(ProfileFile, RejectsSimpackFilesOfTheOtherKind) {
  expect_rejected("head.prr", simpack(in_mm, 1), ProfileKind::rail, {"head.prr:3:", "type = 1", "0 (rail profile)"});
  expect_rejected("wheel.prw", simpack(in_mm, 0), ProfileKind::wheel, {"wheel.prw:3:", "type = 0"});
  expect_rejected("head.prr", simpack(in_mm), ProfileKind::wheel, {"extension .prr", ".prw"});
  expect_rejected("head.ban", "", ProfileKind::wheel, {"extension .ban", ".whl"});
  expect_rejected("head.prr", replaced(simpack(in_mm), " type = 0\n", ""), ProfileKind::rail, {"no type"});
}

TEST_F(ProfileFile, RejectsBrokenSimpackFiles) {
  expect_rejected("head.prr", simpack(""), ProfileKind::rail, {"units.len.f"});
  expect_rejected("head.prr", simpack("units.len.f = 0\n"), ProfileKind::rail, {"head.prr:6:", "above 0"});
  expect_rejected("head.prr", simpack("units.len.f = mm\n"), ProfileKind::rail, {"head.prr:6:", "\"mm\""});
  expect_rejected("head.prr", simpack("mirror.y = 2\n" + in_mm), ProfileKind::rail, {"head.prr:6:", "0 or 1"});
  expect_rejected("head.prr", simpack("shift.y\n" + in_mm), ProfileKind::rail, {"head.prr:6:", "key = value"});
  expect_rejected("head.prr", replaced(simpack(in_mm), "point.end\n", ""), ProfileKind::rail,
                  {"head.prr:69:", "spline.end"});
  expect_rejected("head.prr", replaced(simpack(in_mm), "point.end\nspline.end\n", ""), ProfileKind::rail,
                  {"end of the file"});
  expect_rejected("head.prr", replaced(simpack(in_mm), "-18.000000000 ", "abc "), ProfileKind::rail, {"head.prr:18:"});
  expect_rejected("head.prr", rail_points(), ProfileKind::rail, {"head.prr:1:", "header.begin"});
}

// ------------------------------------------------------------------------------------------------------ load_profile

TEST_F(ProfileFile, LoadsBuiltInNamesBeforeFiles) {
  EXPECT_EQ(load_profile("s1002", ProfileKind::wheel, 0.0).name, "S1002");
  EXPECT_EQ(load_profile("UIC60", ProfileKind::rail, 0.025).name, "60E1");
  expect_round_head(load_profile(write("head.txt", rail_points()).string(), ProfileKind::rail, 0.025));
  try {
    static_cast<void>(load_profile((folder_ / "absent.txt").string(), ProfileKind::rail, 0.025));
    FAIL() << "there is no such file";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("60E1"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("absent.txt"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace railtab
