#include "railtab/tables/files/geometry_table_file.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tables/files/array_file.hpp"
#include "small_geometry_table.hpp"

namespace railtab {
namespace {

class GeometryTableFile : public ::testing::Test {
 protected:
  ~GeometryTableFile() override { std::filesystem::remove(file_); }

  std::filesystem::path file_ =
      std::filesystem::temp_directory_path() / ("railtab_geometry_table_" + std::to_string(::getpid()) + ".h5");
};

TEST_F(GeometryTableFile, ReturnsTheTableToTheLastBit) {
  const GeometryTableData table = small_geometry_table();
  write_geometry_table(file_, table);
  const GeometryTableData read = read_geometry_table(file_);
  EXPECT_TRUE(same_table(read, table));
  EXPECT_EQ(read.statistics, table.statistics) << "order included";
  EXPECT_NO_THROW(GeometryTable{read});
}

TEST_F(GeometryTableFile, KeepsWhatWasSaidAboutTheProfiles) {
  GeometryTableData table = small_geometry_table();
  table.wheel.notes = {"wheel.txt:9: 2 repeated points left out", "wheel.txt: z mirrored"};
  write_geometry_table(file_, table);
  const GeometryTableData read = read_geometry_table(file_);
  EXPECT_EQ(read.wheel.notes, table.wheel.notes);
  EXPECT_TRUE(read.rail.notes.empty());
  EXPECT_TRUE(read.rail.inclination.empty());
  table.rail.inclination = "1:20";
  write_geometry_table(file_, table);
  EXPECT_EQ(profile_in_words(read_geometry_table(file_).rail), table.rail.name + " 1:20");
}

TEST_F(GeometryTableFile, TellsATableFromAnotherOne) {
  // The comparison itself: a difference in the last bit of any part must show.
  const GeometryTableData table = small_geometry_table();
  const auto differs = [&](const auto& change) {
    GeometryTableData other = table;
    change(other);
    return !same_table(other, table);
  };
  EXPECT_TRUE(differs([](GeometryTableData& t) { t.rail.dz[3] = std::nextafter(t.rail.dz[3], 1.0); }));
  EXPECT_TRUE(differs([](GeometryTableData& t) { t.coefficient[7] = std::nextafter(t.coefficient[7], 1.0F); }));
  EXPECT_TRUE(differs([](GeometryTableData& t) { t.trusted_lowering.pop_back(); }));
  EXPECT_TRUE(differs([](GeometryTableData& t) { t.node[0] ^= 1U; }));
  EXPECT_TRUE(differs([](GeometryTableData& t) { t.roll.cells = 2; }));
}

TEST_F(GeometryTableFile, KeepsATableWithoutBranchesAndStatistics) {
  GeometryTableData table = small_geometry_table();
  table.statistics.clear();
  table.coefficient.clear();
  table.yaw_squared = {0.0, 0.0, 1};
  table.roll = {0.0, 0.0, 1};
  table.node = {CellNode::leaf(0), CellNode::leaf(1)};
  table.leaf_branch = {0, 0};
  table.trusted_lowering = {0.0F, 0.0F};
  write_geometry_table(file_, table);
  EXPECT_TRUE(same_table(read_geometry_table(file_), table));
}

TEST_F(GeometryTableFile, KeepsAPart) {
  GeometryTableData table = small_geometry_table();
  table.shard = {2, 3};
  write_geometry_table(file_, table);
  EXPECT_TRUE(same_table(read_geometry_table(file_), table));
  EXPECT_THROW(GeometryTable{table}, InputError) << "a part is no table";
}

TEST_F(GeometryTableFile, NamesUnitAndMeaningOfEveryDataset) {
  write_geometry_table(file_, small_geometry_table());
  const ArrayFileReader in(file_, "railtab-geometry-table", geometry_table_version);
  const std::vector<std::pair<std::string, std::string>> units{{"profiles/wheel/s", "m"},
                                                               {"profiles/rail/dz", "1"},
                                                               {"axes/lateral", "m"},
                                                               {"axes/yaw_squared", "rad^2"},
                                                               {"axes/roll", "rad"},
                                                               {"cells/node", "1"},
                                                               {"cells/leaf_branches", "1"},
                                                               {"cells/trusted_lowering", "m"},
                                                               {"branches/coefficient", "m; 1"},
                                                               {"dimensions/track_gauge", "m"},
                                                               {"dimensions/tolerance", "m"}};
  for (const auto& [path, unit] : units) {
    EXPECT_EQ(in.text(path, "unit"), unit) << path;
    EXPECT_GT(in.text(path, "description").size(), 5U) << path;
  }
  EXPECT_EQ(in.read("branches/coefficient").shape, (std::vector<std::size_t>{4, 12, 4}));
  EXPECT_EQ(in.number("axes/lateral", "cells"), 2);
}

TEST_F(GeometryTableFile, AFolderThatDoesNotExistIsAnInputError) {
  EXPECT_THROW(write_geometry_table(file_ / "no" / "t.h5", small_geometry_table()), InputError);
}

}  // namespace
}  // namespace railtab
