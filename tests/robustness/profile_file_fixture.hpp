// What the tests of profile files share: a folder of their own, and small profiles.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/profile/profile_curve.hpp"
#include "railtab/runtime/profile/profile_file.hpp"

namespace railtab {

class ProfileFile : public ::testing::Test {
 protected:
  void SetUp() override {
    const ::testing::TestInfo* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(::testing::TempDir()) / (std::string("railtab_profile_file_") + info->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::filesystem::path write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return folder_ / name;
  }

  /// The message with which a file is rejected; empty where it is read.
  [[nodiscard]] std::string rejection(const std::string& name, const std::string& content, ProfileKind kind) const {
    try {
      static_cast<void>(read_profile_file(write(name, content), kind));
    } catch (const InputError& e) {
      return e.what();
    }
    return {};
  }

  void expect_rejected(const std::string& name, const std::string& content, ProfileKind kind,
                       const std::vector<std::string>& words) const {
    const std::string message = rejection(name, content, kind);
    for (const std::string& word : words) {
      EXPECT_NE(message.find(word), std::string::npos) << "\"" << word << "\" in \"" << message << "\"";
    }
  }

  std::filesystem::path folder_;
};

// A rail head of radius 100 mm, y from -30 to 30 mm, one point per mm, shifted by (2, -3) mm, lines 2 to 62.
inline std::string rail_points(const std::string& units_line = "# units: mm\n", double scale = 1.0) {
  std::string text = units_line;
  for (int y = -30; y <= 30; ++y) {
    text += fmt::format("{:.9f} {:.9f}\n", scale * (y + 2.0), scale * (100.0 - std::sqrt(100.0 * 100.0 - y * y) - 3.0));
  }
  return text;
}

inline constexpr const char* header = "header.begin\n version = 1\n type = {}\nheader.end\nspline.begin\n";

// The same head as a SIMPACK file; `options` are lines of the spline section.
inline std::string simpack(const std::string& options, int type = 0, const std::string& points = rail_points("")) {
  return fmt::format(fmt::runtime(header), type) + options + "point.begin\n" + points + "point.end\nspline.end\n";
}
inline const std::string in_mm = "units.len.f = 1.0E+03 ! per metre\n";

inline void expect_round_head(const ProfileKnots& knots) {
  const ProfileCurve curve(knots);
  ASSERT_EQ(knots.y.size(), 61u);
  EXPECT_NEAR(knots.y.front(), -0.030, 1e-9);
  EXPECT_NEAR(knots.y.back(), 0.030, 1e-9);
  for (double y = -0.02; y <= 0.02; y += 1e-3) {
    EXPECT_NEAR(curve.at(curve.s_at_y(y)).z, 0.1 - std::sqrt(0.01 - y * y), 2e-9);
  }
}

// A wheel of 30 mm flange height and tread 1:20, line 1 units, points on lines 2 to 14, y rising.
inline const std::string wheel_points =
    "# units: mm\n-60 20\n-55 28\n-50 26\n-45 18\n-40 8\n-30 3\n-20 1.2\n-10 0.5\n0 0\n10 -0.5\n20 -1\n30 -1.5\n40 "
    "-2\n";

inline std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

}  // namespace railtab
