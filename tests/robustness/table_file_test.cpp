// Damaged geometry tables: every one is rejected with a message that names the file, or read as it was written.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <fstream>
#include <limits>
#include <random>
#include <span>

#include "../unit/small_geometry_table.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tables/files/array_file.hpp"
#include "railtab/tables/files/creep_table_file.hpp"
#include "railtab/tables/files/geometry_table_file.hpp"

namespace railtab {
namespace {

constexpr std::string_view filetype = "railtab-geometry-table";

class TableFile : public ::testing::Test {
 protected:
  TableFile() {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    write_geometry_table(file_, table_);
    std::ifstream stream(file_, std::ios::binary);
    bytes_.assign(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  ~TableFile() override { std::filesystem::remove_all(folder_); }

  void write_bytes(std::string_view bytes) const {
    std::ofstream stream(file_, std::ios::binary | std::ios::trunc);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }

  /// The message of the InputError, or "" where the file was read; then it is the table that was written.
  [[nodiscard]] std::string outcome() const {
    try {
      const GeometryTableData read = read_geometry_table(file_);
      EXPECT_TRUE(same_table(read, table_)) << "a damaged file was read as another table";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(file_.string()), std::string::npos) << error.what();
      return error.what();
    }
    return "";
  }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("railtab_table_file_" + std::to_string(::getpid()));
  std::filesystem::path file_ = folder_ / "table.h5";
  GeometryTableData table_ = small_geometry_table();
  std::string bytes_;
};

TEST_F(TableFile, CutAnywhereIsRejected) {
  for (std::size_t length = 0; length < bytes_.size(); length += length < 1200 ? 1 : 97) {
    write_bytes(std::string_view(bytes_).substr(0, length));
    EXPECT_NE(outcome(), "") << "cut to " << length << " of " << bytes_.size() << " bytes";
  }
  write_bytes(std::string_view(bytes_).substr(0, bytes_.size() - 1));
  const std::string sizes = "found " + std::to_string(bytes_.size() - 1) + " bytes, expected " +
                            std::to_string(bytes_.size()) + " bytes: the file is cut short";
  EXPECT_NE(outcome().find(sizes), std::string::npos) << outcome();
  std::string damaged = bytes_;
  damaged[bytes_.size() / 2] ^= 1;
  write_bytes(damaged);
  EXPECT_NE(outcome().find("the file is damaged"), std::string::npos) << outcome();
  damaged = bytes_;
  damaged[20] ^= 1;
  write_bytes(damaged);
  EXPECT_NE(outcome().find("damage in the first 512 bytes"), std::string::npos) << outcome();
  write_bytes(bytes_);
  EXPECT_EQ(outcome(), "") << "the whole file is still a good one";
}

TEST_F(TableFile, SealsOfEarlierVersionsHold) {
  EXPECT_NE(bytes_.find("word checksum"), std::string::npos) << "what seals are made with today";
  constexpr std::size_t block_bytes = 512, mark_bytes = 8;
  const std::string contents = bytes_.substr(block_bytes);
  std::string padded = contents;
  padded.resize((contents.size() + 7) / 8 * 8, '\0');
  const std::uint64_t sum = checksum_of_bytes(std::as_bytes(std::span(padded)), checksum_seed);
  std::string seal = bytes_.substr(0, mark_bytes) + fmt::format("{} bytes follow this block of {}, FNV-1a {:016x}\n",
                                                                contents.size(), block_bytes, sum);
  seal.resize(block_bytes, '\0');
  write_bytes(seal + contents);
  EXPECT_EQ(outcome(), "");
  write_bytes(seal + contents.substr(1));
  EXPECT_NE(outcome().find("the file is cut short"), std::string::npos) << outcome();
  std::string damaged = contents;
  damaged[contents.size() / 2] ^= 1;
  write_bytes(seal + damaged);
  EXPECT_NE(outcome().find("the file is damaged"), std::string::npos) << outcome();
  seal[block_bytes / 2] ^= 1;
  write_bytes(seal + contents);
  EXPECT_NE(outcome().find("damage in the first 512 bytes"), std::string::npos) << outcome();
}

TEST_F(TableFile, EveryFlippedByteIsRejected) {
  std::mt19937 random(20240131);
  std::uniform_int_distribution<int> mask(1, 255);
  for (std::size_t i = 0; i < bytes_.size(); i += i < 1200 ? 1 : 7) {
    std::string damaged = bytes_;
    damaged[i] ^= static_cast<char>(mask(random));
    write_bytes(damaged);
    EXPECT_NE(outcome(), "") << "byte " << i;
  }
}

TEST_F(TableFile, ManyFlippedBytesAreRejected) {
  std::mt19937 random(20240131);
  std::uniform_int_distribution<std::size_t> position(0, bytes_.size() - 1);
  std::uniform_int_distribution<int> byte(0, 255), count(2, 40);
  for (int trial = 0; trial < 1000; ++trial) {
    std::string damaged = bytes_;
    for (int n = count(random); n > 0; --n) damaged[position(random)] = static_cast<char>(byte(random));
    if (damaged == bytes_) continue;
    write_bytes(damaged);
    EXPECT_NE(outcome(), "") << "trial " << trial;
  }
}

TEST_F(TableFile, OtherTypesAndVersionsAreNamed) {
  ArrayFileWriter results(file_, "railtab-results", 1);
  results.close();
  EXPECT_NE(outcome().find("found a file of type railtab-results, expected type railtab-geometry-table"),
            std::string::npos);
  ArrayFileWriter newer(file_, filetype, 7);
  newer.close();
  EXPECT_NE(outcome().find("found format version 7 of railtab-geometry-table, expected version " +
                           std::to_string(geometry_table_version)),
            std::string::npos);
  write_bytes("s y z\n0 0 0\n");
  EXPECT_NE(outcome().find("no HDF5 signature"), std::string::npos);
  std::filesystem::remove(file_);
  EXPECT_NE(outcome().find("no such file"), std::string::npos);
}

/// What to make wrong in a copy of a table file, by the path of a dataset.
struct Fault {
  std::string left_out{}, wrong_shape{}, not_finite{}, last_bit{};
};

/// A copy of the file with a fault; it is whole and sealed, and keeps the checksum of the original.
void copy_with_fault(const std::filesystem::path& from, const std::filesystem::path& to, const Fault& fault) {
  const ArrayFileReader in(from, filetype, geometry_table_version);
  ArrayFileWriter out(to, filetype, geometry_table_version);
  const auto copy = [&](const std::string& path) {
    if (path == fault.left_out) return;
    auto [shape, values] = in.read(path);
    if (path == fault.wrong_shape) {
      values.resize(values.size() / shape.front() * (shape.front() + 1), 0.5);
      ++shape.front();
    }
    if (path == fault.not_finite) values.back() = -std::numeric_limits<double>::infinity();
    if (path == fault.last_bit) values.front() = std::nextafter(values.front(), 10.0);
    out.write(path, values, shape, "m", "values");
  };
  const auto copy_floats = [&](const std::string& path) {
    if (path == fault.left_out) return;
    auto [shape, values] = in.read(path);
    std::vector<float> floats(values.begin(), values.end());
    if (path == fault.wrong_shape) {
      floats.resize(floats.size() / shape.back() * (shape.back() + 1), 0.5F);
      ++shape.back();
    }
    if (path == fault.not_finite) floats.back() = -std::numeric_limits<float>::infinity();
    if (path == fault.last_bit) floats.front() = std::nextafter(floats.front(), 10.0F);
    out.write(path, floats, shape, "m", "values");
  };
  const auto copy_counts = [&](const std::string& path) {
    if (path == fault.left_out) return;
    std::vector<std::int64_t> values = in.read_integers(path);
    if (path == fault.last_bit) ++values.front();
    out.write(path, values, {values.size()}, "1", "values");
  };
  for (const char* profile : {"profiles/wheel", "profiles/rail"}) {
    for (const char* column : {"s", "y", "z", "dy", "dz"}) copy(std::string(profile) + "/" + column);
    out.attribute(profile, "name", in.text(profile, "name"));
  }
  for (const char* axis : {"lateral", "yaw_squared", "roll"}) {
    const std::string path = std::string("axes/") + axis;
    copy(path);
    if (path != fault.left_out) {
      out.attribute(path, "cells", static_cast<std::int64_t>(in.number(path, "cells")));
    }
  }
  for (const char* name : {"track_gauge", "gauge_height", "flange_back", "nominal_radius", "tolerance"}) {
    copy(std::string("dimensions/") + name);
  }
  for (const char* name : {"shard_index", "shard_count"}) {
    out.attribute("cells", name, static_cast<std::int64_t>(in.number("cells", name)));
  }
  copy_counts("cells/node");
  copy_counts("cells/leaf_branches");
  copy_floats("cells/trusted_lowering");
  copy_floats("branches/coefficient");
  for (const std::string& name : in.attribute_names("statistics")) {
    out.attribute("statistics", name, in.number("statistics", name));
  }
  for (const char* name : {"program_version", "command_line", "created"}) {
    out.attribute("provenance", name, in.text("provenance", name));
  }
  out.attribute("", "checksum", in.text("", "checksum"));
  out.close();
}

TEST_F(TableFile, MissingMisshapenInfiniteOrChangedDatasetsAreNamed) {
  const std::filesystem::path original = folder_ / "original.h5";
  std::filesystem::copy_file(file_, original);
  const auto outcome_of = [&](const Fault& fault) {
    copy_with_fault(original, file_, fault);
    return outcome();
  };
  const auto expect = [](const std::string& message, const std::string& words) {
    EXPECT_NE(message.find(words), std::string::npos) << "\"" << words << "\" is missing in: " << message;
  };
  EXPECT_EQ(outcome_of({}), "") << "the copy without a fault is a good table";
  for (const std::string path : {"profiles/wheel/s", "profiles/rail/dz", "axes/lateral", "axes/roll",
                                 "cells/trusted_lowering", "branches/coefficient"}) {
    expect(outcome_of({.left_out = path}), path + ": found no such dataset");
    expect(outcome_of({.not_finite = path}), path + ": found -inf");
    expect(outcome_of({.last_bit = path}), "with checksum");
  }
  for (const std::string path : {"cells/node", "cells/leaf_branches"}) {
    expect(outcome_of({.left_out = path}), path + ": found no such dataset");
    expect(outcome_of({.last_bit = path}), "with checksum");
  }
  expect(outcome_of({.last_bit = "dimensions/track_gauge"}), "with checksum");
  for (const std::string path :
       {"profiles/wheel/dy", "axes/lateral", "cells/trusted_lowering", "branches/coefficient"}) {
    expect(outcome_of({.wrong_shape = path}), path + ": found the shape");
  }
}

TEST_F(TableFile, ProfilesWithoutIncreasingArcLengthAreNamed) {
  GeometryTableData table = table_;
  table.rail.s[2] = table.rail.s[1];
  write_geometry_table(file_, table);
  EXPECT_NE(outcome().find("profiles/rail/s: found"), std::string::npos) << outcome();
  EXPECT_NE(outcome().find("expected strictly increasing values"), std::string::npos) << outcome();
}

/// A creep table in the paper's layout, right in its checksum but for what `change` does to the arrays.
std::string creep_outcome(const std::filesystem::path& file, const std::string& path, const std::vector<double>& values,
                          const std::vector<std::size_t>& shape) {
  CreepTableData table;
  table.layout = CreepTableLayout::paper;
  table.nodes = {{{0.5, 2.0}, {0.0, 1.0, 3.0}, {0.0, 0.5}, {-1.0, 0.0, 1.0}}};
  table.values.assign(3 * 2 * 3 * 2 * 3, 0.25);
  const std::filesystem::path sound = file.string() + ".sound";
  write_creep_table(sound, table);
  {
    const ArrayFileReader in(sound, creep_table_filetype, 1);
    ArrayFileWriter out(file, creep_table_filetype, 1);
    for (const std::string each : {"axes/ratio", "axes/x", "axes/y", "axes/spin", "values"}) {
      const Array array = in.read(each);
      out.write(each, each == path ? values : array.values, each == path ? shape : array.shape, "1", "values");
    }
    out.attribute("options", "layout", in.text("options", "layout"));
    for (const char* name : {"poisson", "elements"}) out.attribute("options", name, in.number("options", name));
    for (const char* name : {"program_version", "command_line", "created"}) {
      out.attribute("provenance", name, in.text("provenance", name));
    }
    out.attribute("", "checksum", in.text("", "checksum"));
    out.close();
  }
  std::filesystem::remove(sound);
  try {
    static_cast<void>(read_creep_table(file));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

// A loaded part is checked as it is read, and the message names the file.
TEST_F(TableFile, LoadedPartsThatDoNotAgreeAreNamed) {
  GeometryTableData table = table_;
  LoadedTableData loaded;
  loaded.lateral = {0.0, 1e-3};
  loaded.roll = {-1e-3, 1e-3};
  loaded.yaw_squared = {0.0};
  loaded.levels = 3;
  loaded.largest_level = 1.0;
  loaded.contact_modulus = 1e11;
  loaded.statistics.emplace_back("largest", 0.0);
  loaded.shift.assign(8, 0.0);
  loaded.touch.assign(4, 0.0);
  loaded.height.assign(48, 0.0F);
  loaded.pressed.assign(6, 0U);
  const auto outcome_of = [&](const LoadedTableData& part) {
    table.loaded = part;
    write_geometry_table(file_, table);
    return outcome();
  };
  EXPECT_EQ(outcome_of(loaded), "");
  LoadedTableData broken = loaded;
  broken.pressed[2] = 4U;
  const std::string message = outcome_of(broken);
  EXPECT_NE(message.find(file_.filename().string() + ": loaded: pressed: found 4"), std::string::npos) << message;
  broken = loaded;
  broken.roll = {1e-3, -1e-3};
  EXPECT_NE(outcome_of(broken).find("loaded/roll: found"), std::string::npos);
  broken = loaded;
  broken.climb = 11.0;
  EXPECT_NE(outcome_of(broken).find(": loaded, attribute climb: found 11, expected 0 to 2"), std::string::npos);
  // A table with a number that no reader accepts does not replace the one before.
  broken = loaded;
  broken.height[5] = std::numeric_limits<float>::quiet_NaN();
  table.loaded = broken;
  const std::string before = array_file_checksum(file_);
  try {
    write_geometry_table(file_, table);
    ADD_FAILURE() << "written";
  } catch (const ComputationError& error) {
    EXPECT_EQ(error.what(), file_.string() +
                                ": loaded/height: value 5 is nan, not a finite number; the file is not "
                                "written");
  }
  EXPECT_EQ(array_file_checksum(file_), before);
  loaded.climb = 0.5;
  EXPECT_EQ(outcome_of(loaded), "");
  EXPECT_EQ(read_geometry_table(file_).loaded->climb, 0.5);
}

TEST_F(TableFile, ArraysOfACreepTableThatDoNotAgreeAreNamed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto expect = [](const std::string& message, const std::string& words) {
    EXPECT_NE(message.find(words), std::string::npos) << "\"" << words << "\" is missing in: " << message;
  };
  EXPECT_EQ(creep_outcome(file_, "", {}, {}), "");
  expect(creep_outcome(file_, "axes/x", {0.0, 1.0}, {2}),
         "values: found the shape (2, 3, 2, 3, 3), expected (2 ratio as in axes/ratio, 2 x as in axes/x, ");
  expect(creep_outcome(file_, "axes/spin", {-1.0, nan, 1.0}, {3}), "axes/spin: found nan as value 1");
  expect(creep_outcome(file_, "axes/y", {0.5, 0.5}, {2}), "axes/y: found 0.5 as value 1, after 0.5");
  expect(creep_outcome(file_, "axes/y", {0.0, 0.5}, {1, 2}), "axes/y: found the shape (1, 2)");
}

TEST_F(TableFile, AFullDiskIsAComputationErrorAndKeepsTheOldTable) {
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{8192, 8192};  // stands for the full disk: no file may grow beyond
    ::setrlimit(RLIMIT_FSIZE, &limit);
    int code = 1;
    try {
      write_geometry_table(file_, table_);
    } catch (const ComputationError&) {
      code = 0;
    }
    ::_exit(code);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << "status " << status;
  EXPECT_EQ(outcome(), "");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1) << "a temporary file was left";
}

}  // namespace
}  // namespace railtab
