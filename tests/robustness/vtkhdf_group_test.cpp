// The group for ParaView in results: which instants, what a resumed run makes of it, and what is rejected. Whether it
// is what its specification asks for is checked without railtab's own reader in vtkhdf_of_results.py.
#include <gtest/gtest.h>
#include <hdf5.h>

#include <cmath>
#include <functional>
#include <limits>

#include "../unit/result_fixture.hpp"
#include "railtab/runtime/base/file_checksum.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/drawing/drawn_records.hpp"
#include "railtab/runtime/results/result_file.hpp"
#include "railtab/runtime/results/result_size.hpp"
#include "railtab/tables/files/array_file.hpp"

namespace railtab {
namespace {

TEST(DrawnRecords, AreEveryPowerOfTwoAndTheLast) {
  for (const int most : {1, 2, 5, 100}) {
    for (const int records : {0, 1, 2, 5, 6, 21, 199, 200, 201, 1000}) {
      DrawnRecords drawn(most);
      StepRecord record;
      for (int i = 0; i < records; ++i) {
        record.time = i;
        drawn.add(record);
      }
      int spacing = 1;
      while ((records + spacing - 1) / spacing > most) spacing *= 2;
      std::vector<double> expected;
      for (int i = 0; i < records; i += spacing) expected.push_back(i);
      if (records > 0 && (records - 1) % spacing != 0) expected.push_back(records - 1);
      std::vector<double> found;
      for (const StepRecord& kept : drawn.take()) found.push_back(kept.time);
      EXPECT_EQ(found, expected) << records << " records, " << most << " at most";
      EXPECT_GE(DrawnRecords::count(records, most), static_cast<double>(found.size()));
      EXPECT_LE(DrawnRecords::count(records, most), static_cast<double>(found.size()) + 1.0);
    }
  }
}

ResultHeader drawn_header() {
  ResultHeader header = made_up_header();
  header.node_names = {"deck-15", "rail-left-15", "rail-right-15"};
  header.node_x = {15.0, 15.0, 15.0};
  return header;
}

class VtkhdfGroup : public ResultFile {
 protected:
  static constexpr long records = 12;
  static constexpr int most = 6;

  void SetUp() override { header_ = drawn_header(); }

  /// Ends after `until` records as a run that was asked to stop, or that was killed.
  void write(long until, bool finishes, const std::optional<Checkpoint>& from = std::nullopt) {
    DrawnRecords drawn(most);
    const long first = from ? static_cast<long>(from->records) : 0;
    ResultWriter out =
        from ? ResultWriter::resume(file_, *from, 3) : ResultWriter(file_, header_, 3, ResultWriter::Grid::at_the_end);
    for (long i = 0; i < until; ++i) {
      const StepRecord record = made_up_record(i, header_);
      drawn.add(record);
      if (i < first) continue;
      out.append(record);
      if (i == 4) out.checkpoint(made_up_state(i), i);
    }
    if (finishes) out.finish(complete_summary(), drawn.take());
  }
  [[nodiscard]] Array read(const char* path) const { return ArrayFileReader(file_, results_filetype, 5).read(path); }
  [[nodiscard]] std::string type() const { return ArrayFileReader(file_, results_filetype, 5).text("VTKHDF", "Type"); }

  /// Changes a dataset with HDF5 alone and gives it the right checksum.
  template <typename Number>
  void change(const char* path, hid_t number, const std::function<void(std::vector<Number>&)>& edit) const {
    const hid_t file = H5Fopen(file_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    ASSERT_GE(file, 0);
    const hid_t dataset = H5Dopen2(file, path, H5P_DEFAULT);
    const hid_t space = H5Dget_space(dataset);
    std::vector<Number> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
    std::array<hsize_t, 2> extent{};
    H5Sget_simple_extent_dims(space, extent.data(), nullptr);
    const std::size_t row = values.size() / extent[0];
    ASSERT_GE(H5Dread(dataset, number, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
    edit(values);
    extent[0] = values.size() / row;
    H5Dset_extent(dataset, extent.data());
    ASSERT_GE(H5Dwrite(dataset, number, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
    const auto sum = static_cast<std::int64_t>(word_checksum(std::as_bytes(std::span(values))));
    const hid_t attribute = H5Aopen(dataset, "checksum", H5P_DEFAULT);
    ASSERT_GE(H5Awrite(attribute, H5T_NATIVE_INT64, &sum), 0);
    H5Aclose(attribute);
    H5Sclose(space);
    H5Dclose(dataset);
    H5Fclose(file);
  }
  void change_integers(const char* path, const std::function<void(std::vector<std::int64_t>&)>& edit) const {
    change<std::int64_t>(path, H5T_NATIVE_INT64, edit);
  }
  void expect_rejected(const char* path, std::string_view words) const {
    try {
      static_cast<void>(read_results(file_));
      ADD_FAILURE() << path << " was accepted";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(file_.string() + ": " + path), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  }
};

TEST_F(VtkhdfGroup, HoldsTheInstantsOnceTheRunHasEnded) {
  write(records, false);
  EXPECT_EQ(type(), "not written yet!") << "of a run that was killed";
  EXPECT_EQ(read_results(file_).steps.size(), static_cast<std::size_t>(records));
  std::filesystem::remove(file_);
  write(records, true);
  EXPECT_EQ(type(), "UnstructuredGrid");
  static_cast<void>(read_results(file_));
  std::vector<double> times;
  for (const long i : {0, 2, 4, 6, 8, 10, 11}) times.push_back(made_up_record(i, header_).time);
  EXPECT_EQ(read("VTKHDF/Steps/Values").values, times);
}

TEST_F(VtkhdfGroup, OfAResumedRunIsThatOfOneThatWasNot) {
  write(records, true);
  const std::vector<double> points = read("VTKHDF/Points").values;
  const std::vector<double> displacement = read("VTKHDF/PointData/displacement").values;
  std::filesystem::remove(file_);
  for (const long stopped : {5L, 6L, 7L}) {  // with 5, 6 and 5 instants
    for (const bool finishes : {false, true}) {
      write(stopped, finishes);
      const std::optional<Checkpoint> from = ResultWriter::read_checkpoint(file_);
      ASSERT_TRUE(from.has_value());
      write(records, true, from);
      EXPECT_EQ(read("VTKHDF/Points").values, points) << stopped;
      EXPECT_EQ(read("VTKHDF/PointData/displacement").values, displacement) << stopped;
      static_cast<void>(read_results(file_));
      std::filesystem::remove(file_);
    }
  }
}

TEST_F(VtkhdfGroup, BecomesShorterWithARunThatIsResumedAndStoppedEarlier) {
  write(6, true);
  ASSERT_EQ(read("VTKHDF/Steps/Values").values.size(), 6u);
  write(5, true, ResultWriter::read_checkpoint(file_));
  EXPECT_EQ(read("VTKHDF/Steps/Values").values.size(), 5u);
  EXPECT_EQ(read_results(file_).steps.size(), 5u);
}

TEST_F(VtkhdfGroup, IsInvalidWhileARunIsGoneOnWith) {
  write(6, true);
  const std::optional<Checkpoint> from = ResultWriter::read_checkpoint(file_);
  write(6, false, from);
  EXPECT_EQ(type(), "not written yet!");
  EXPECT_EQ(read_results(file_).steps.size(), 6u);
}

TEST_F(VtkhdfGroup, TakesTheRoomThatIsPlanned) {
  const auto bytes_of = [&](ResultWriter::Grid grid) {
    std::filesystem::remove(file_);
    ResultWriter out(file_, header_, 200, grid);
    DrawnRecords drawn(100);
    for (long i = 0; i < 1000; ++i) {
      const StepRecord record = made_up_record(i, header_);
      drawn.add(record);
      out.append(record);
    }
    out.finish(complete_summary(), drawn.take());
    return static_cast<double>(std::filesystem::file_size(file_));
  };
  const double more = bytes_of(ResultWriter::Grid::at_the_end) - bytes_of(ResultWriter::Grid::absent);
  const ResultSize size = result_size(header_, 1000.0, 0.0, 100);
  EXPECT_LE(more, size.grid);
  EXPECT_GE(more, 0.8 * size.grid);
  EXPECT_EQ(result_size(header_, 1000.0, 0.0, 0).grid, 0.0);
}

TEST_F(VtkhdfGroup, WithFalseNumbersIsRejected) {
  constexpr std::int64_t far = 1'000'000;
  struct Change {
    const char* path;
    std::function<void(std::vector<std::int64_t>&)> edit;
    const char* words;
  };
  const std::vector<Change> changes{
      {"VTKHDF/Connectivity", [](auto& v) { v.back() = far; }, "found 1000000, expected 0 to "},
      {"VTKHDF/Connectivity", [](auto& v) { v.pop_back(); }, "the shape ("},
      {"VTKHDF/Offsets", [](auto& v) { v.front() = 1; }, "found 1 to "},
      {"VTKHDF/Offsets", [](auto& v) { v[1] = v[2] + 1; }, "corners of cell"},
      {"VTKHDF/NumberOfPoints", [](auto& v) { v.front() = 0; }, "found 0, expected 1 to"},
      {"VTKHDF/NumberOfPoints", [](auto& v) { v.back() += 1; }, "other numbers"},
      {"VTKHDF/NumberOfCells", [](auto& v) { v.push_back(v.back()); }, "the shape (8), expected (7)"},
      {"VTKHDF/Steps/NumberOfParts", [](auto& v) { v[3] = 2; }, "other numbers"},
      {"VTKHDF/Steps/PartOffsets", [](auto& v) { v[3] = 3; }, "other numbers"},
      {"VTKHDF/Steps/PointOffsets", [](auto& v) { v[3] += 1; }, "other numbers"},
      {"VTKHDF/Steps/CellOffsets", [](auto& v) { v[3] = 1; }, "other numbers"},
      {"VTKHDF/Steps/ConnectivityIdOffsets", [](auto& v) { v[3] = 1; }, "other numbers"},
      {"VTKHDF/Steps/PointDataOffsets/displacement", [](auto& v) { v[3] = far; }, "other numbers"},
      {"VTKHDF/Steps/PointDataOffsets/recorded", [](auto& v) { v[3] = -1; }, "other numbers"},
      {"VTKHDF/Steps/CellDataOffsets/part", [](auto& v) { v[3] = 5; }, "other numbers"}};
  for (const Change& one : changes) {
    write(records, true);
    change_integers(one.path, one.edit);
    expect_rejected(one.path, one.words);
    std::filesystem::remove(file_);
  }
}

TEST_F(VtkhdfGroup, WithFalseValuesIsRejected) {
  const auto expect = [&]<typename Number>(const char* path, hid_t type, Number value, const char* words) {
    write(records, true);
    change<Number>(path, type, [value](std::vector<Number>& values) { values[2] = value; });
    expect_rejected(path, words);
    std::filesystem::remove(file_);
  };
  constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
  expect("VTKHDF/Points", H5T_NATIVE_FLOAT, not_a_number, "not finite");
  expect("VTKHDF/PointData/displacement", H5T_NATIVE_FLOAT, not_a_number, "not finite");
  expect("VTKHDF/Types", H5T_NATIVE_UINT8, std::uint8_t{5}, "the kind 5");
  expect("VTKHDF/CellData/part", H5T_NATIVE_UINT8, std::uint8_t{4}, "found 4, expected 0 to 3");
  expect("VTKHDF/PointData/recorded", H5T_NATIVE_UINT8, std::uint8_t{2}, "found 2, expected 0 to 1");
  expect("VTKHDF/Steps/Values", H5T_NATIVE_DOUBLE, 1e-3, "times of records");
}

TEST_F(VtkhdfGroup, WithFalseAttributesIsRejected) {
  const auto overwrite = [&](const char* group, const char* name, hid_t type, const void* value) {
    const hid_t file = H5Fopen(file_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    const hid_t object = H5Gopen2(file, group, H5P_DEFAULT);
    const hid_t attribute = H5Aopen(object, name, H5P_DEFAULT);
    const hid_t own = H5Aget_type(attribute);
    ASSERT_GE(H5Awrite(attribute, type == H5T_C_S1 ? own : type, value), 0);
    H5Tclose(own);
    H5Aclose(attribute);
    H5Gclose(object);
    H5Fclose(file);
  };
  constexpr std::array<std::int64_t, 2> version{1, 0};
  constexpr std::int64_t steps = 6, none = 0;
  write(records, true);
  overwrite("VTKHDF", "Version", H5T_NATIVE_INT64, version.data());
  expect_rejected("VTKHDF", "Version 1, 0");
  std::filesystem::remove(file_);
  write(records, true);
  overwrite("VTKHDF", "Type", H5T_C_S1, "UnstructuredMesh");
  expect_rejected("VTKHDF", "Type UnstructuredMesh");
  std::filesystem::remove(file_);
  write(records, true);
  overwrite("VTKHDF/Steps", "NSteps", H5T_NATIVE_INT64, &steps);
  expect_rejected("VTKHDF/NumberOfPoints", "the shape (7), expected (6)");
  overwrite("VTKHDF/Steps", "NSteps", H5T_NATIVE_INT64, &none);
  EXPECT_THROW(static_cast<void>(read_results(file_)), InputError);
}

TEST_F(VtkhdfGroup, WithAChangedByteIsRejected) {
  for (const char* path : {"VTKHDF/Points", "VTKHDF/PointData/displacement"}) {
    write(records, true);
    const hid_t file = H5Fopen(file_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    const hid_t dataset = H5Dopen2(file, path, H5P_DEFAULT);
    const std::array<hsize_t, 2> at{3, 1}, one{1, 1};
    const hid_t rows = H5Dget_space(dataset), value = H5Screate(H5S_SCALAR);
    H5Sselect_hyperslab(rows, H5S_SELECT_SET, at.data(), nullptr, one.data(), nullptr);
    const float other = 1.5F;
    ASSERT_GE(H5Dwrite(dataset, H5T_NATIVE_FLOAT, value, rows, H5P_DEFAULT, &other), 0);
    H5Sclose(rows);
    H5Sclose(value);
    H5Dclose(dataset);
    H5Fclose(file);
    expect_rejected(path, "do not agree with their checksum");
    std::filesystem::remove(file_);
  }
}

}  // namespace
}  // namespace railtab
