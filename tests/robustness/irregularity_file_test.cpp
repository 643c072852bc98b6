#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/line/irregularity.hpp"

namespace railtab {
namespace {

const std::string header = "x[m],y_left[mm],z_left[mm],y_right[mm],z_right[mm]\n";

class IrregularityFile : public testing::Test {
 protected:
  void SetUp() override {
    const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    folder_ = std::filesystem::temp_directory_path() / ("railtab-irregularity-" + name);
    std::filesystem::create_directories(folder_);
    file_ = folder_ / "track.csv";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  Irregularity read(const std::string& text) {
    std::ofstream(file_, std::ios::binary) << text;
    return read_irregularity(file_);
  }

  /// Message without the folder, "no InputError" where the text was accepted.
  std::string message_of(const std::string& text) {
    try {
      (void)read(text);
    } catch (const InputError& error) {
      const std::string message = error.what();
      const size_t folder = message.find(folder_.string() + "/");
      EXPECT_EQ(folder, 0u) << message;
      return message.substr(folder_.string().size() + 1);
    }
    return "no InputError";
  }

  std::filesystem::path folder_, file_;
};

TEST_F(IrregularityFile, ReadsEachColumnInItsUnit) {
  const Irregularity irregularity = read(
      "# measured with a chord of 10 m\r\n"
      "\n"
      " x [m] , y_left[m],z_left[mm],y_right[mm], z_right[m]\r\n"
      "-1.5, 0, 0, 0, 0\r\n"
      "# a remark\n"
      "0.5, 1e-3, 2, -3.5, 4.0e-3\n"
      "2, 0, 0, 0, 0");
  const RailDeviation left = irregularity.at(RailSide::left, 0.5), right = irregularity.at(RailSide::right, 0.5);
  EXPECT_DOUBLE_EQ(left.y, 1e-3);
  EXPECT_DOUBLE_EQ(left.z, 2e-3);
  EXPECT_DOUBLE_EQ(right.y, -3.5e-3);
  EXPECT_DOUBLE_EQ(right.z, 4e-3);
  EXPECT_EQ(irregularity.at(RailSide::left, -1.51).y, 0.0);
}

TEST_F(IrregularityFile, ReadsPositionsInMillimetres) {
  const Irregularity irregularity =
      read("x[mm],y_left[mm],z_left[mm],y_right[mm],z_right[mm]\n0,0,0,0,0\n250,1,0,0,0\n500,0,0,0,0\n");
  EXPECT_DOUBLE_EQ(irregularity.at(RailSide::left, 0.25).y, 1e-3);
}

// A step of 5 mm within 1 mm, its neighbours 10 m away: the natural spline swings by metres beside it.
TEST_F(IrregularityFile, RejectsASplineThatSwings) {
  const std::string step = header + "0,0,0,0,0\n10,0,0,0,0\n10.001,0,0,0,5\n20,0,0,0,5\n40,0,0,0,0\n";
  const std::string message = message_of(step);
  EXPECT_TRUE(message.starts_with("track.csv:2: column z_right: found a spline through the points that swings to"))
      << message;
  // points of a step evenly spaced, as those of any measured record, are its spline's own affair
  std::string even = header, noise = header;
  for (int i = 0; i < 40; ++i) {
    even += std::to_string(i) + ",0,0,0," + (i < 20 ? "0\n" : "5\n");
    noise += std::to_string(0.25 * i) + ",0,0,0," + (i * i % 7 < 3 ? "-3\n" : "3\n");
  }
  EXPECT_EQ(message_of(even), "no InputError");
  EXPECT_EQ(message_of(noise), "no InputError");
  const Irregularity::Extreme overshoot = read(even).farthest_out();
  EXPECT_GT(overshoot.beyond, 0.05);
  EXPECT_LT(overshoot.beyond, 0.5);
  EXPECT_EQ(overshoot.column, 3U);
  // the extreme is where the spline is level, and is its value
  const RailDeviation there = read(even).at(RailSide::right, overshoot.x);
  EXPECT_NEAR(there.z, overshoot.value, 1e-15);
  EXPECT_NEAR(there.dz_dx, 0.0, 1e-12);
}

TEST_F(IrregularityFile, ReadsAFileWithAByteOrderMark) {
  const Irregularity irregularity =
      read("\xEF\xBB\xBFx[m],y_left[mm],z_left[mm],y_right[mm],z_right[mm]\n0,0,0,0,0\n1,1,0,0,0\n2,0,0,0,0\n");
  EXPECT_DOUBLE_EQ(irregularity.at(RailSide::left, 1.0).y, 1e-3);
}

TEST_F(IrregularityFile, RejectsAHeaderWithoutUnits) {
  EXPECT_EQ(message_of("x[m],y_left,z_left[mm],y_right[mm],z_right[mm]\n0,0,0,0,0\n1,0,0,0,0\n"),
            "track.csv:1: found header 'y_left', expected name[unit]");
  EXPECT_EQ(message_of("# comment\nx[km],y_left[mm],z_left[mm],y_right[mm],z_right[mm]\n0,0,0,0,0\n1,0,0,0,0\n"),
            "track.csv:2: column x: found unit [km], expected x[m], x[mm]");
  EXPECT_EQ(message_of("0,0,0,0,0\n1,0,0,0,0\n"), "track.csv:1: found header '0', expected name[unit]");
  EXPECT_EQ(message_of("x[m],z_left[mm],y_left[mm],y_right[mm],z_right[mm]\n0,0,0,0,0\n1,0,0,0,0\n"),
            "track.csv:1: column z_left: found column 'z_left', expected 'y_left'; 5 columns: x, y_left, z_left, "
            "y_right, z_right");
}

// Another file's bytes are neither sent to a terminal nor shown at length.
TEST_F(IrregularityFile, AMessageShowsPrintableText) {
  constexpr std::string_view executable(
      "\x7F"
      "ELF\x02\x01\x00\x1B[2J\nmore",
      16);
  EXPECT_EQ(message_of(std::string(executable)),
            "track.csv:1: found header '\\x7FELF\\x02\\x01\\x00\\x1B[2J', expected name[unit]");
  EXPECT_EQ(message_of(std::string(3000, '\xFF')),
            "track.csv:1: found header '\\xFF\\xFF\\xFF\\xFF\\xFF\\xFF\\xFF\\xFF…', expected name[unit]");
  EXPECT_EQ(message_of(std::string(3000, 'a')),
            "track.csv:1: found header '" + std::string(40, 'a') + "…', expected name[unit]");
  EXPECT_EQ(message_of("ä\xC2\x9B"
                       "m\n"),
            "track.csv:1: found header 'ä\\xC2\\x9Bm', expected name[unit]");
  EXPECT_EQ(message_of(header + "0,0,0,0,0\n1,\x07,0,0,0\n"),
            "track.csv:3: column y_left: found '\\x07', expected a finite number");
  EXPECT_EQ(message_of("x[m],h\x1B[mm],z_left[mm],y_right[mm],z_right[mm]\n0,0,0,0,0\n1,0,0,0,0\n").find('\x1B'),
            std::string::npos);
}

TEST_F(IrregularityFile, RejectsAWrongNumberOfColumns) {
  const std::string expected = "expected 5, as in the header";
  EXPECT_EQ(message_of("x[m],z[mm]\n0,0\n1,0\n"),
            "track.csv:1: column x: found 2 columns, expected 5 columns: x, y_left, z_left, y_right, z_right");
  EXPECT_EQ(message_of(header + "0,0,0,0,0\n1,0,0,0\n"), "track.csv:3: found 4 columns, " + expected);
  EXPECT_EQ(message_of(header + "0,0,0,0,0,\n"), "track.csv:2: found 6 columns, " + expected);
  EXPECT_EQ(message_of(header + "0;0;0;0;0\n"), "track.csv:2: found 1 columns, " + expected);
}

TEST_F(IrregularityFile, RejectsWhatIsNoFiniteNumber) {
  for (const std::string cell : {"nan", "inf", "-inf", "1.0.0", "", "1e", "one", "1e999"}) {
    EXPECT_EQ(message_of(header + "0,0,0,0,0\n1,0," + cell + ",0,0\n"),
              "track.csv:3: column z_left: found '" + cell + "', expected a finite number");
  }
}

TEST_F(IrregularityFile, RejectsPositionsThatDoNotIncrease) {
  EXPECT_EQ(message_of(header + "0,0,0,0,0\n1,0,0,0,0\n1,0,0,0,0\n"),
            "track.csv:4: column x: found 1, expected more than 1 of the row before");
  EXPECT_EQ(message_of(header + "0,0,0,0,0\n2,0,0,0,0\n1.5,0,0,0,0\n"),
            "track.csv:4: column x: found 1.5, expected more than 2 of the row before");
}

TEST_F(IrregularityFile, RejectsAFileWithoutPoints) {
  const std::string expected = "expected a header row and at least 2 rows";
  EXPECT_EQ(message_of(""), "track.csv: found 0 rows, " + expected);
  EXPECT_EQ(message_of(header), "track.csv: found 0 rows, " + expected);
  EXPECT_EQ(message_of(header + "0,0,0,0,0\n"), "track.csv: found 1 rows, " + expected);
}

TEST_F(IrregularityFile, RejectsBinaryAndMissingFiles) {
  EXPECT_NE(message_of(std::string("\x89HDF\r\n\x1a\n\0\0\0", 11)).find("track.csv:1: found"), std::string::npos);
  for (const std::filesystem::path& place : {folder_ / "absent.csv", folder_}) {
    try {
      (void)read_irregularity(place);
      FAIL() << place << " was accepted";
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find(place.string() + ": found "), 0u) << error.what();
    }
  }
}

}  // namespace
}  // namespace railtab
