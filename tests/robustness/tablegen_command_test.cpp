#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <random>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "railtab/runtime/contact/contact_search.hpp"
#include "railtab/runtime/contact/equivalent_conicity.hpp"
#include "railtab/runtime/profile/standard_profiles.hpp"
#include "railtab/tables/files/geometry_table_file.hpp"
#include "tablegen_fixture.hpp"

namespace railtab {
namespace {

class TablegenCommand : public TablegenFixture {
 protected:
  /// Exit code 2, nothing on stdout, one message on stderr with this text in it, and no file out.h5.
  void expect_rejected(const std::string& arguments, const std::string& text) const {
    expect_rejected_with_table(arguments, text);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out.h5"));
  }

  /// As expect_rejected(), where a table has been made before.
  void expect_rejected_with_table(const std::string& arguments, const std::string& text) const {
    const Outcome outcome = tablegen(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments << "\n" << outcome.err;
    EXPECT_EQ(outcome.out, "") << arguments;
    EXPECT_TRUE(outcome.err.starts_with("tablegen: ")) << outcome.err;
    EXPECT_NE(outcome.err.find(text), std::string::npos) << arguments << "\n" << outcome.err;
  }
};

/// By the online search, to 6 mm.
RadiusDifferenceCurve radius_difference_of(const WheelRailPair& pair) {
  return RadiusDifferenceCurve(wheelset_contacts(ContactSearch(pair), {.y_low = -6e-3, .y_high = 6e-3}));
}

constexpr const char* small = "geometry --wheel S1002 --rail 60E1 --lateral -0.001:0.001 --yaw 0:0.01 -o out.h5 ";
// where any table will do, one that takes no time
constexpr const char* quick = "geometry --wheel cone-1:20 --rail 60E1 --lateral -0.001:0.001 --yaw 0:0.01 -o out.h5 ";

TEST_F(TablegenCommand, HelpAndVersionOfEveryCommand) {
  for (const std::string command : {"", "conicity ", "geometry ", "info ", "verify "}) {
    const Outcome help = tablegen(command + "--help");
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_NE(help.out.find("Usage: tablegen " + command), std::string::npos) << help.out;
    const Outcome version = tablegen(command + "--version");
    EXPECT_EQ(version.exit_code, 0);
    EXPECT_TRUE(version.out.starts_with("railtab ")) << version.out;
  }
}

TEST_F(TablegenCommand, WrongCommandLines) {
  expect_rejected("", "no command");
  expect_rejected("geomtry", "unknown command 'geomtry'; did you mean 'geometry'?\ntablegen --help lists the commands");
  expect_rejected("geometry --wheel S1002 --rail 60E1", "found no -o FILE.h5\nusage: tablegen geometry");
  expect_rejected("geometry --rail 60E1 -o out.h5", "found no --wheel ");
  expect_rejected(std::string(small) + "--tollerance 1e-8", "--tollerance");
  expect_rejected(std::string(small) + "--tol 1e-8", "--tol");
  expect_rejected(std::string(small) + "--roll 0.01", "LO:HI");
  expect_rejected(std::string(small) + "--roll 0.01:-0.01", "LO:HI");
  expect_rejected(std::string(small) + "--tolerance 0", "tolerance");
  expect_rejected(std::string(small) + "--tolerance nan", "--tolerance");
  expect_rejected(std::string(small) + "--gauge 1435", "--gauge: found 1435");
  expect_rejected(std::string(small) + "--wheel-radius 460", "--wheel-radius: found 460");
  expect_rejected(std::string(small) + "--rail-inclination 40", "--rail-inclination: found 40");
  expect_rejected(std::string(small) + "--roll=-5:5", "--roll [rad]: found -5");
  expect_rejected("loaded out.h5 --largest-load 1", "--largest-load: found 1");
  expect_rejected(std::string(small) + "--rail-inclination 1:zero", "--rail-inclination");
  expect_rejected(std::string(small) + "--threads 1.5", "--threads");
  expect_rejected("geometry --wheel S1003 --rail 60E1 -o out.h5", "S1003");
  expect_rejected("geometry --wheel missing.prw --rail 60E1 -o out.h5", "missing.prw");
  expect_rejected("geometry --wheel S1002 --rail 60E1 --lateral 0.002:0.002 -o out.h5", "lateral");
  expect_rejected("geometry --wheel S1002 --rail 60E1 -o none/out.h5", "none");
  expect_rejected("info", "found no FILE.h5\nusage: tablegen info FILE.h5");
  expect_rejected("info none.h5", "none.h5");
  expect_rejected("verify none.h5", "none.h5");
  expect_rejected("conicity none.h5", "none.h5");
  expect_rejected("conicity none.h5 --amplitude 0", "--amplitude");
  expect_rejected("conicity none.h5 --roll free", "--roll");
}

TEST_F(TablegenCommand, OptionsThatCannotActOrFitAreRejected) {
  expect_rejected(std::string(small) + "--smoothing 3e-6",
                  "--smoothing: found 3e-6 with the built-in profiles S1002 and 60E1");
  expect_rejected(std::string(small) + "--smoothing 3", "--smoothing: found 3, expected 0 to 0.001 m");
  expect_rejected(std::string(small) + "--flange-back 1.5",
                  "--flange-back: found 1.5 m, with which the flanges are 1.5");
  expect_rejected(std::string(small) + "--gauge 1.0", "narrower than the track gauge of 1 m (--gauge)");
  expect_rejected(std::string(quick) + "--gauge 2.0", "the wheel does not meet the rail anywhere in the range");
}

TEST_F(TablegenCommand, AFileThatIsNoTableIsRejected) {
  std::ofstream(folder_ / "text.h5") << "not a table";
  expect_rejected("info text.h5", "text.h5");
  expect_rejected("verify text.h5 --json", "text.h5");
}

TEST_F(TablegenCommand, APartSaysSoAndIsNoTable) {
  for (const char* shard : {"2", "0/2", "3/2", "1/x", "1/2/3", "/2"}) {
    expect_rejected(std::string(quick) + "--shard '" + shard + "'", "shard");
  }
  const Outcome made = tablegen(std::string(quick) + "--shard 2/8 --json");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(nlohmann::json::parse(made.out)["shard"]["index"], 2);
  EXPECT_EQ(nlohmann::json::parse(made.out)["shard"]["count"], 8);
  expect_rejected_with_table("verify out.h5", "part 2 of 8");
  EXPECT_EQ(tablegen("info out.h5").exit_code, 0);
  const Outcome merged = tablegen("merge out.h5 -o whole.h5");
  EXPECT_EQ(merged.exit_code, 2);
  EXPECT_NE(merged.err.find("part"), std::string::npos) << merged.err;
}

TEST_F(TablegenCommand, GeometryInfoVerify) {
  const Outcome made = tablegen(
      "geometry --wheel LMA-type --rail CHN60 --flange-back 1.353 --lateral -0.001:0.001 --yaw 0:0.01 -o out.h5 "
      "--json");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const Outcome info = tablegen("info out.h5 --json");
  ASSERT_EQ(info.exit_code, 0) << info.err;
  nlohmann::json table = nlohmann::json::parse(info.out);
  const nlohmann::json wheelset = table["wheelset"];
  EXPECT_EQ(wheelset["radius_difference"]["y"].size(), 21U);
  // a cone 1:40 on the tread
  EXPECT_NEAR(wheelset["radius_difference"]["value"][20], 2.0 * 1e-3 / 40.0, 1e-9);  // at y = 1 mm
  table.erase("wheelset");
  EXPECT_EQ(nlohmann::json::parse(made.out), table);
  ASSERT_EQ(tablegen("info out.h5 --html page.html").exit_code, 0);
  const std::string page = contents(folder_ / "page.html");
  for (const char* words : {"Contact points", "Rolling radius difference", "Contact angle", "Equivalent conicity"}) {
    EXPECT_NE(page.find(words), std::string::npos) << words;
  }
  EXPECT_EQ(page.find("nan"), std::string::npos);
  expect_rejected_with_table("info out.h5 --html out.h5", "out.h5");
  EXPECT_EQ(table["kind"], "geometry");
  EXPECT_EQ(table["wheel"], "LMA-type");
  EXPECT_EQ(table["axes"]["roll"]["root_cells"], 1);
  EXPECT_GT(table["branches"], 0);
  EXPECT_EQ(table["statistics"]["certified.patch_mismatch_share"], 0.0);

  const Outcome verified = tablegen("verify out.h5 --samples 3000 --seed 5 --json");
  ASSERT_EQ(verified.exit_code, 0) << verified.err;
  const nlohmann::json v = nlohmann::json::parse(verified.out);
  EXPECT_EQ(v["kind"], "geometry");
  EXPECT_EQ(v["samples"], 3000);
  EXPECT_GE(v["fallback_share"], 0.0);
  EXPECT_EQ(v["patch_mismatch_share"], 0.0);
  for (const char* quantity :
       {"penetration", "position_rail", "position_wheel", "contact_angle", "rolling_radius", "normal_force_relative"}) {
    for (const char* statistic : {"mean", "p50", "p95", "p99", "p999", "max"}) {
      EXPECT_TRUE(v["error"][quantity][statistic].is_number()) << quantity << "." << statistic;
    }
  }
  EXPECT_GT(v["time_ns"]["table"], 0.0);
  EXPECT_GT(v["time_ns"]["online"], 0.0);
  EXPECT_GT(v["bytes"], 0);

  // Another seed draws other queries, the same seed the same ones.
  const auto penetration = [&](const std::string& seed) {
    return nlohmann::json::parse(
        tablegen("verify out.h5 --samples 500 --threads 1 --seed " + seed + " --json").out)["error"]["penetration"];
  };
  EXPECT_EQ(penetration("3"), penetration("3"));
  EXPECT_NE(penetration("3"), penetration("4"));

  expect_rejected_with_table("verify out.h5 --samples 0", "--samples");
  expect_rejected_with_table("verify out.h5 --samples 1.5", "--samples");
  expect_rejected_with_table("verify out.h5 --dz -1e-4:1e-4", "dz");
}

TEST_F(TablegenCommand, ConicityOfAConeAndOfS1002) {
  const std::string ranges = " --lateral -0.006:0.006 --yaw 0:0 --quiet -o ";
  ASSERT_EQ(tablegen("geometry --wheel cone-1:40 --rail 60E1 --rail-inclination 0" + ranges + "cone.h5").exit_code, 0);
  const auto conicity = [&](const std::string& arguments) {
    const Outcome outcome = tablegen("conicity " + arguments + " --json");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out);
  };
  const nlohmann::json cone = conicity("cone.h5");
  EXPECT_EQ(cone["kind"], "conicity");
  EXPECT_EQ(cone["amplitude"], 3e-3);
  EXPECT_NEAR(cone["wave"]["conicity"], 0.025, 1e-6);
  EXPECT_NEAR(cone["regression"]["conicity"], 0.025, 1e-6);
  EXPECT_GT(conicity("cone.h5 --roll on")["wave"]["conicity"], 0.0252);
  const nlohmann::json unequal = conicity("cone.h5 --diameter-difference 1e-4 --amplitude 4e-3");
  EXPECT_NEAR(unequal["wave"]["conicity"], 0.025, 1e-6);
  EXPECT_NEAR(unequal["wave"]["y_low"], -5e-3, 1e-7);  // the wave runs about −50 µm/(2·0.025)

  // The table's answer is the online search's.
  ASSERT_EQ(tablegen("geometry --wheel S1002 --rail 60E1" + ranges + "s1002.h5").exit_code, 0);
  const RadiusDifferenceCurve curve =
      radius_difference_of(WheelRailPair(ProfileCurve(standard_profile(ProfileKind::wheel, "S1002", 0.0)),
                                         ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)), {}));
  EXPECT_NEAR(conicity("s1002.h5")["wave"]["conicity"], conicity_of_wave(curve, 3e-3).tan_gamma, 1e-6);

  EXPECT_EQ(tablegen("conicity s1002.h5 --amplitude 8e-3").exit_code, 1);
  expect_rejected_with_table("conicity s1002.h5 --diameter-difference 1", "diameter difference");
}

TEST_F(TablegenCommand, RailFilesAreNotInclined) {
  std::ofstream(folder_ / "rail.txt") << "points\n";
  const std::string message = "--rail-inclination: found 1:20 with the rail file rail.txt, expected a built-in rail";
  const std::string pair = "--wheel S1002 --rail rail.txt --rail-inclination 1:20 ";
  expect_rejected("geometry " + pair + "-o out.h5", message);
  expect_rejected("conicity " + pair, message);
  expect_rejected("conicity " + pair + "--left-rail rail.txt", message);
  // the left rail is inclined: only the points are wrong
  expect_rejected("conicity " + pair + "--left-rail 60E1", "rail.txt:1: ");
  expect_rejected("geometry --wheel S1002 --rail rail.txt -o out.h5", "rail.txt:1: ");
}

TEST_F(TablegenCommand, RepairsOfProfileFilesAreSaidAndStored) {
  std::ofstream wheel(folder_ / "wheel.txt");
  for (int y = -30; y <= 30; ++y) wheel << y << ' ' << 1e-4 * y * y - 0.05 * y << '\n' << (y == 7 ? "7 -0.3451\n" : "");
  wheel.close();
  const std::string rest = " --rail 60E1 --lateral -0.001:0.001 --yaw 0:0 -o out.h5";
  const Outcome made = tablegen("geometry --wheel wheel.txt --smoothing 1e-8" + rest);
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const nlohmann::json info = nlohmann::json::parse(tablegen("info out.h5 --json").out);
  const nlohmann::json notes = info["provenance"]["profile_notes"];
  ASSERT_EQ(notes.size(), 4U) << notes;
  const char* words[] = {"taken as mm", "wheel.txt:39: 1 repeated", "no flange", "smoothed"};
  for (std::size_t i = 0; i < 4; ++i) {
    const std::string note = notes[i];
    EXPECT_NE(note.find(words[i]), std::string::npos) << note;
    EXPECT_NE(made.err.find(note), std::string::npos) << made.err;
    EXPECT_NE(made.out.find(note), std::string::npos) << made.out;
  }
  expect_rejected_with_table("geometry --wheel wheel.txt --smoothing -1" + rest, "--smoothing");
}

TEST_F(TablegenCommand, PointsThatScatterAreWarnedOfBeforeTheTableIsMade) {
  const auto made_with = [&](double noise) {
    std::ofstream wheel(folder_ / "wheel.txt");
    for (int y = -30; y <= 30; ++y) {
      const int error = (y + 30) * (y + 30) % 7 - 2;  // 0, 1, 4, 2, 2, 4, 1 less 2
      wheel << y << ' ' << 1e-4 * y * y - 0.05 * y + noise * error << '\n';
    }
    wheel.close();
    return tablegen("geometry --wheel wheel.txt --rail 60E1 --lateral 0:0.0001 --yaw 0:0 -o out.h5").err;
  };
  const std::string noisy = made_with(3e-3);
  EXPECT_NE(noisy.find("warning: the points of wheel.txt scatter by about "), std::string::npos) << noisy;
  EXPECT_NE(noisy.find("; smooth them by --smoothing "), std::string::npos) << noisy;
  EXPECT_EQ(made_with(0.0).find("scatter"), std::string::npos);
}

TEST_F(TablegenCommand, TheProposedSmoothingGivesTheConicityOfTheProfileWithoutNoise) {
  const ProfileCurve exact(standard_profile(ProfileKind::wheel, "S1002", 0.0));
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise(0.0, 3e-3);  // [mm]
  std::ofstream wheel(folder_ / "wheel.txt");
  for (double s = exact.s_begin(); s <= exact.s_end(); s += 1e-3) {
    const CurvePoint p = exact.at(s);
    const double n = noise(random);
    wheel << 1e3 * p.y - n * p.dz << ' ' << 1e3 * p.z + n * p.dy << '\n';
  }
  wheel.close();
  const std::string said =
      tablegen("geometry --wheel wheel.txt --rail 60E1 --lateral 0:0.0001 --yaw 0:0 -o out.h5").err;
  std::smatch found;
  ASSERT_TRUE(std::regex_search(said, found,
                                std::regex("equivalent conicity at 3 mm: (\\S+) as the profiles are, (\\S+) with "
                                           "--smoothing 3e-06\n")))
      << said;
  const double exactly =
      conicity_of_wave(radius_difference_of(WheelRailPair(
                           exact, ProfileCurve(standard_profile(ProfileKind::rail, "60E1", 1.0 / 40.0)), {})),
                       3e-3)
          .tan_gamma;
  EXPECT_NEAR(std::stod(found[2]), exactly, 0.15 * exactly) << said;
}

TEST_F(TablegenCommand, ATruncatedTableIsRejected) {
  ASSERT_EQ(tablegen(std::string(quick) + "--quiet").exit_code, 0);
  std::filesystem::resize_file(folder_ / "out.h5", std::filesystem::file_size(folder_ / "out.h5") / 2);
  expect_rejected_with_table("info out.h5", "out.h5");
}

TEST_F(TablegenCommand, QuietPrintsNothing) {
  const Outcome made = tablegen(std::string(quick) + "--quiet");
  EXPECT_EQ(made.exit_code, 0);
  EXPECT_EQ(made.out + made.err, "");
}

// Killed in the middle, the same command goes on from the parts that are done, to the same bits.
TEST_F(TablegenCommand, KilledItGoesOnToTheSameTable) {
  const std::string command =
      "geometry --wheel conic-arc-stand-in --rail JIS60-stand-in --wheel-radius 0.4575 --lateral -0.006:0.006 "
      "--roll=-0.005:0.005 --quiet --threads 1 -o killed.h5";
  std::istringstream words(command);
  const std::vector<std::string> arguments{std::istream_iterator<std::string>(words), {}};
  ASSERT_EQ(tablegen(command.substr(0, command.find("-o")) + "-o whole.h5").exit_code, 0);

  const std::filesystem::path first = folder_ / "killed.h5.part-0-1", third = folder_ / "killed.h5.part-0-3";
  ASSERT_TRUE(killed_when(TABLEGEN_COMMAND, arguments, [&] { return std::filesystem::exists(first); }));
  const auto made = std::filesystem::last_write_time(first);
  ASSERT_TRUE(killed_when(TABLEGEN_COMMAND, arguments, [&] { return std::filesystem::exists(third); }));
  EXPECT_EQ(std::filesystem::last_write_time(first), made) << "a part that is done is made again";
  EXPECT_FALSE(std::filesystem::exists(folder_ / "killed.h5")) << "an unfinished table has its final name";
  std::filesystem::resize_file(first, std::filesystem::file_size(first) / 2);  // cut short: made anew
  ASSERT_EQ(tablegen(command).exit_code, 0);
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    EXPECT_EQ(entry.path().filename().string().find(".part"), std::string::npos) << entry.path();
  }
  const GeometryTableData a = read_geometry_table(folder_ / "whole.h5"), b = read_geometry_table(folder_ / "killed.h5");
  EXPECT_EQ(a.node, b.node);
  EXPECT_EQ(a.leaf_branch, b.leaf_branch);
  EXPECT_EQ(a.trusted_lowering, b.trusted_lowering);
  EXPECT_EQ(a.coefficient, b.coefficient);
  EXPECT_EQ(a.statistics, b.statistics);
}

// What stands in the place of a part is used only where it is one of this very table.
TEST_F(TablegenCommand, PartsOfAnotherTableAreMadeAnew) {
  ASSERT_EQ(tablegen(quick).exit_code, 0);
  ASSERT_EQ(tablegen("geometry --wheel cone-1:20 --rail 60E1 --lateral -0.002:0.002 --yaw 0:0.01 --shard 1/8 -o "
                     "out.h5.part-0-1")
                .exit_code,
            0);
  std::ofstream(folder_ / "out.h5.part-0-2") << "not HDF5";
  const GeometryTableData before = read_geometry_table(folder_ / "out.h5");
  ASSERT_EQ(tablegen(quick).exit_code, 0);
  const GeometryTableData after = read_geometry_table(folder_ / "out.h5");
  EXPECT_EQ(before.node, after.node);
  EXPECT_EQ(before.coefficient, after.coefficient);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.h5.part-0-1"));
  EXPECT_EQ(contents(folder_ / "out.h5.part-0-2"), "not HDF5") << "somebody's file is replaced";
}

TEST_F(TablegenCommand, TheOutputIsLookedAtBeforeTheSweep) {
  std::filesystem::create_directory(folder_ / "folder.h5");
  expect_rejected("geometry --wheel S1002 --rail 60E1 -o folder.h5", "a folder");
  expect_rejected("geometry --wheel S1002 --rail 60E1 -o missing/out.h5", "no folder");
  expect_rejected(std::string(quick) + "--refinement 1.5", "--refinement");
}

}  // namespace
}  // namespace railtab
