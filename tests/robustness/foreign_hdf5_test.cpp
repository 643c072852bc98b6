// HDF5 files that another program made: nothing outside the file is read, and nothing inflates beyond its size.

#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/stat.h>

#include <array>
#include <vector>

#include "../folder_fixture.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/results/result_file.hpp"
#include "railtab/tables/files/array_file.hpp"

namespace railtab {
namespace {

constexpr std::array<double, 4> numbers{1.0, 2.0, 3.0, 4.0};

class ForeignHdf5 : public testing::InFolder {
 protected:
  void SetUp() override {
    InFolder::SetUp();
    file_ = create("foreign.h5");
    other_ = create("other.h5");
    write(other_, "secret");
    write(file_, "own");
    H5Fclose(other_);
  }

  /// As railtab begins a table, without a seal: files that other programs have rewritten have none.
  [[nodiscard]] hid_t create(const char* name) const {
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110);
    const hid_t file = H5Fcreate((folder_ / name).c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
    const hid_t scalar = H5Screate(H5S_SCALAR), text = H5Tcopy(H5T_C_S1);
    H5Tset_size(text, 9);
    H5Tset_strpad(text, H5T_STR_NULLPAD);
    const hid_t type = H5Acreate2(file, "filetype", text, scalar, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(type, text, "test-file");
    const hid_t version = H5Acreate2(file, "format_version", H5T_STD_I64LE, scalar, H5P_DEFAULT, H5P_DEFAULT);
    const std::int64_t one = 1;
    H5Awrite(version, H5T_NATIVE_INT64, &one);
    for (const hid_t attribute : {type, version}) H5Aclose(attribute);
    H5Tclose(text);
    H5Sclose(scalar);
    H5Pclose(access);
    return file;
  }

  static void write(hid_t file, const char* name, hid_t properties = H5P_DEFAULT, hsize_t extent = numbers.size()) {
    const hid_t space = H5Screate_simple(1, &extent, nullptr);
    const hid_t set = H5Dcreate2(file, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, properties, H5P_DEFAULT);
    if (extent == numbers.size()) H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data());
    H5Dclose(set);
    H5Sclose(space);
  }

  /// The message of the InputError at "values", or nothing where they are read.
  [[nodiscard]] std::string rejection_of(const char* path = "values") {
    H5Fclose(file_);
    try {
      const ArrayFileReader in(folder_ / "foreign.h5", "test-file", 1);
      EXPECT_EQ(in.read("own").values, std::vector<double>(numbers.begin(), numbers.end()));
      static_cast<void>(in.read(path));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  static void expect_words(const std::string& message, const std::vector<std::string>& words) {
    for (const std::string& word : words) EXPECT_NE(message.find(word), std::string::npos) << word << ": " << message;
  }

  hid_t file_ = -1, other_ = -1;
};

TEST_F(ForeignHdf5, ExternalLinksAreNotFollowed) {
  H5Lcreate_external("other.h5", "secret", file_, "values", H5P_DEFAULT, H5P_DEFAULT);
  expect_words(rejection_of(), {"foreign.h5: values", "a link to another file", "without links"});
}

TEST_F(ForeignHdf5, AnExternalLinkOnTheWayIsNotFollowed) {
  H5Lcreate_external("other.h5", "/", file_, "group", H5P_DEFAULT, H5P_DEFAULT);
  expect_words(rejection_of("group/secret"), {"foreign.h5: group", "a link to another file"});
}

TEST_F(ForeignHdf5, SoftLinksAreNotFollowed) {
  H5Lcreate_external("other.h5", "/", file_, "group", H5P_DEFAULT, H5P_DEFAULT);
  H5Lcreate_soft("/group/secret", file_, "values", H5P_DEFAULT, H5P_DEFAULT);
  expect_words(rejection_of(), {"foreign.h5: values", "a link to another place"});
}

TEST_F(ForeignHdf5, VirtualDatasetsAreRejected) {
  const hsize_t extent = numbers.size();
  const hid_t space = H5Screate_simple(1, &extent, nullptr), properties = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_virtual(properties, space, "other.h5", "secret", space);
  write(file_, "values", properties, extent + 1);
  H5Pclose(properties);
  H5Sclose(space);
  expect_words(rejection_of(), {"foreign.h5: values", "a virtual dataset"});
}

TEST_F(ForeignHdf5, ValuesInAPipeAreNotWaitedFor) {
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_external(properties, (folder_ / "pipe").c_str(), 0, 8 * sizeof(double));
  write(file_, "values", properties, 8);
  H5Pclose(properties);
  expect_words(rejection_of(), {"foreign.h5: values", "values in other files"});
}

TEST_F(ForeignHdf5, FiltersAreRejected) {
  const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
  const hsize_t chunk = 4;
  H5Pset_chunk(properties, 1, &chunk);
  constexpr H5Z_filter_t of_a_plugin = 32001;
  H5Pset_filter(properties, of_a_plugin, H5Z_FLAG_OPTIONAL, 0, nullptr);
  write(file_, "values", properties);
  H5Pclose(properties);
  expect_words(rejection_of(), {"foreign.h5: values", "the filter 32001", "without filters"});
}

TEST_F(ForeignHdf5, CompressedZerosDoNotInflate) {
  const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
  const hsize_t chunk = 1U << 20U;
  H5Pset_chunk(properties, 1, &chunk);
  H5Pset_deflate(properties, 9);
  write(file_, "values", properties, 400 * chunk);
  H5Pclose(properties);
  expect_words(rejection_of(), {"foreign.h5: values", "the filter 1 (deflate)"});
}

TEST_F(ForeignHdf5, AShapeBeyondTheFileIsRejected) {
  const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
  const hsize_t chunk = 4;
  H5Pset_chunk(properties, 1, &chunk);
  write(file_, "values", properties, 400'000'000);
  H5Pclose(properties);
  expect_words(rejection_of(), {"foreign.h5: values", "the shape (400000000)", "bytes of the file"});
}

TEST_F(ForeignHdf5, TheSameBytesUnderManyNamesAreNotReadForEver) {
  for (int i = 0; i < 2000; ++i) {
    H5Lcreate_hard(file_, "own", file_, ("name " + std::to_string(i)).c_str(), H5P_DEFAULT, H5P_DEFAULT);
  }
  H5Fclose(file_);
  const ArrayFileReader in(folder_ / "foreign.h5", "test-file", 1);
  const auto bytes = static_cast<double>(std::filesystem::file_size(folder_ / "foreign.h5"));
  int read = 0;
  try {
    for (; read < 2000; ++read) static_cast<void>(in.read("name " + std::to_string(read)));
  } catch (const InputError& error) {
    expect_words(error.what(), {"foreign.h5: name", "bytes of values up to this dataset"});
  }
  EXPECT_LE(read * 32.0, bytes);
}

TEST_F(ForeignHdf5, NoWriterFollowsALink) {
  H5Fclose(file_);
  const std::filesystem::path results = folder_ / "r.h5";
  ResultHeader header;
  header.wheel_x = header.static_wheel_load = {0.0, 0.0};
  {
    ResultWriter out(results, header, 1);
    for (long i = 0; i < 3; ++i) {
      StepRecord record;
      record.time = static_cast<double>(i);
      record.wheels.resize(2);
      out.append(record);
      out.checkpoint(std::vector<double>{1.0, 2.0}, i);
    }
  }
  const hid_t file = H5Fopen(results.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  H5Ldelete(file, "checkpoint/a", H5P_DEFAULT);
  H5Lcreate_external((folder_ / "other.h5").c_str(), "secret", file, "checkpoint/a", H5P_DEFAULT, H5P_DEFAULT);
  H5Fclose(file);
  const std::optional<Checkpoint> from = ResultWriter::read_checkpoint(results);
  ASSERT_TRUE(from.has_value()) << "the other slot is whole";
  EXPECT_THROW(
      {
        ResultWriter out = ResultWriter::resume(results, *from, 1);
        for (int i = 0; i < 2; ++i) out.checkpoint(std::vector<double>{5.0, 6.0}, 7);
      },
      InputError);
  const ArrayFileReader other(folder_ / "other.h5", "test-file", 1);
  EXPECT_EQ(other.read("secret").values, std::vector<double>(numbers.begin(), numbers.end()));
}

}  // namespace
}  // namespace railtab
