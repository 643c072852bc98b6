#include "railtab/tables/files/array_file.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <fstream>
#include <limits>
#include <numeric>
#include <thread>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tables/files/file_fields.hpp"

namespace railtab {
namespace {

using Mode = ArrayFileWriter::Mode;

/// A folder of its own for each test, removed at its end.
class ArrayFile : public ::testing::Test {
 protected:
  ArrayFile() {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() / (std::string("railtab_array_file_") + info->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~ArrayFile() override { std::filesystem::remove_all(folder_); }
  [[nodiscard]] std::filesystem::path file(const char* name = "a.h5") const { return folder_ / name; }
  [[nodiscard]] std::ptrdiff_t files_in_folder() const {
    return std::distance(std::filesystem::directory_iterator(folder_), std::filesystem::directory_iterator());
  }

  std::filesystem::path folder_;
};

template <typename Action>
std::string message_of(const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no InputError";
}

void expect_words(const std::string& message, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    EXPECT_NE(message.find(word), std::string::npos) << "\"" << word << "\" is missing in: " << message;
  }
}

TEST_F(ArrayFile, ReturnsEveryBitOfWhatWasWritten) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> values{
      1.0 / 3.0, -0.0, nan, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::denorm_min(), -1e308};
  const std::vector<std::int64_t> integers{std::numeric_limits<std::int64_t>::min(), -1,
                                           std::numeric_limits<std::int64_t>::max()};
  const std::vector<float> floats{0.1F, -1e-40F, std::numeric_limits<float>::max()};
  const std::vector<std::string> names{"", "coach-1/car-body", "Fahrgestell \xC3\xBC"};
  ArrayFileWriter out(file(), "test-file", 3);
  out.write("a/b/values", values, {2, 3}, "m", "some values");
  out.write("floats", floats, {3}, "m", "some floats");
  out.write("integers", integers, {3}, "1", "some integers");
  out.write("names", names, "some names");
  out.write("none", std::vector<std::string>{}, "no names");
  out.write("empty", std::span<const double>{}, {0, 4}, "m", "no values");
  out.write("scalar", std::vector<double>{2.5}, {}, "N", "a scalar");
  out.attribute("a/b", "ratio", 0.1);
  out.attribute("", "count", std::int64_t{7});
  out.attribute("new group", "words", std::string_view("two words"));
  out.close();

  const ArrayFileReader in(file(), "test-file", 3);
  const Array read = in.read("a/b/values");
  EXPECT_EQ(read.shape, (std::vector<std::size_t>{2, 3}));
  ASSERT_EQ(read.values.size(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(read.values[i]), std::bit_cast<std::uint64_t>(values[i])) << i;
  }
  EXPECT_EQ(in.read_floats("floats").values, floats);
  EXPECT_EQ(in.read("floats").values, std::vector<double>(floats.begin(), floats.end()));
  EXPECT_EQ(in.read_floats("scalar").values, std::vector<float>{2.5F});
  EXPECT_EQ(in.read_integers("integers"), integers);
  EXPECT_EQ(in.read_strings("names"), names);
  EXPECT_TRUE(in.read_strings("none").empty());
  EXPECT_EQ(in.read("empty").shape, (std::vector<std::size_t>{0, 4}));
  EXPECT_TRUE(in.read("scalar").shape.empty());
  EXPECT_EQ(in.read("scalar").values, std::vector<double>{2.5});
  EXPECT_EQ(in.number("a/b", "ratio"), 0.1);
  EXPECT_EQ(in.number("", "count"), 7.0);
  EXPECT_EQ(in.text("new group", "words"), "two words");
  EXPECT_EQ(in.text("a/b/values", "unit"), "m");
  EXPECT_EQ(in.text("a/b/values", "description"), "some values");
  EXPECT_TRUE(in.contains("a/b"));
  EXPECT_FALSE(in.contains("a/c"));
  EXPECT_FALSE(in.contains("no/such/path"));
  EXPECT_EQ(array_file_type(file()), "test-file");
}

TEST_F(ArrayFile, KeepsManyAttributesInTheirOrder) {
  std::vector<std::string> names;
  ArrayFileWriter out(file(), "test-file", 1);
  for (int i = 0; i < 300; ++i) {
    names.push_back("attribute " + std::to_string(997 * i % 300));
    out.attribute("statistics", names.back(), static_cast<double>(i));
  }
  out.close();
  const ArrayFileReader in(file(), "test-file", 1);
  EXPECT_EQ(in.attribute_names("statistics"), names);
  EXPECT_EQ(in.number("statistics", names[299]), 299.0);
}

TEST_F(ArrayFile, MessagesNameFilePlaceFoundAndExpected) {
  ArrayFileWriter out(file(), "test-file", 3);
  out.write("group/values", std::vector<double>(6), {2, 3}, "m", "values");
  out.write("integers", std::vector<std::int64_t>{1}, {1}, "1", "integers");
  out.write("large", std::vector<double>{1e39}, {1}, "m", "more than a float holds");
  out.close();
  const ArrayFileReader in(file(), "test-file", 3);
  const std::string name = file().string();
  expect_words(message_of([&] { return in.read("group/other"); }), {name, "group/other", "no such dataset"});
  expect_words(message_of([&] { return in.read("group"); }), {name, "a group", "a dataset"});
  expect_words(message_of([&] { return in.read("integers"); }), {name, "integers", "floating-point"});
  expect_words(message_of([&] { return in.read_integers("group/values"); }), {name, "group/values", "integers"});
  expect_words(message_of([&] { return in.read_strings("integers"); }), {name, "text"});
  const Field tall{"group/values", {"3", "any"}, "m", ""}, flat{"group/values", {"6"}, "m", ""};
  expect_words(message_of([&] { return FieldReader(in).numbers(tall); }), {name, "(2, 3)", "(3, any number of any)"});
  expect_words(message_of([&] { return FieldReader(in).numbers(flat); }), {name, "(2, 3)", "(6)"});
  const Field large{"large", {"1"}, "m", ""};
  expect_words(message_of([&] { return FieldReader(in).floats(large); }), {name, "large", "inf", "a finite number"});
  expect_words(message_of([&] { return in.number("group", "none"); }), {name, "group", "none", "no such attribute"});
  expect_words(message_of([&] { return in.number("", "filetype"); }), {name, "filetype", "no number"});
  expect_words(message_of([&] { return in.text("", "format_version"); }), {name, "format_version", "text"});
  expect_words(message_of([&] { ArrayFileReader(file(), "other-file", 3); }), {name, "test-file", "other-file"});
  expect_words(message_of([&] { ArrayFileReader(file(), "test-file", 4); }), {name, "version 3", "version 4"});
  expect_words(message_of([&] { ArrayFileReader(file("b.h5"), "test-file", 3); }), {"b.h5", "no such file"});
  expect_words(message_of([&] { ArrayFileReader(folder_, "test-file", 3); }), {folder_.string(), "a folder"});
  expect_words(message_of([&] { ArrayFileWriter(folder_ / "no" / "a.h5", "test-file", 3); }),
               {"a.h5", "existing folder"});
}

TEST_F(ArrayFile, RejectsWhatIsNotHdf5) {
  std::ofstream(file("empty.h5")).close();
  expect_words(message_of([&] { static_cast<void>(array_file_type(file("empty.h5"))); }),
               {"empty.h5", "an empty file"});
  std::ofstream(file("text.h5")) << "this is a text of more than eight characters";
  expect_words(message_of([&] { static_cast<void>(array_file_type(file("text.h5"))); }),
               {"text.h5", "no HDF5 signature"});
}

TEST_F(ArrayFile, WholeOrNothingLeavesTheOldFileUntilClose) {
  {
    ArrayFileWriter out(file(), "test-file", 1);
    out.attribute("", "edition", 1.0);
    EXPECT_FALSE(std::filesystem::exists(file()));
    out.close();
  }
  {
    ArrayFileWriter out(file(), "test-file", 1);
    out.attribute("", "edition", 2.0);
  }
  EXPECT_EQ(ArrayFileReader(file(), "test-file", 1).number("", "edition"), 1.0);
  EXPECT_EQ(files_in_folder(), 1) << "the discarded file is still there";
  {
    ArrayFileWriter out(file(), "test-file", 1);
    out.attribute("", "edition", 3.0);
    out.close();
  }
  EXPECT_EQ(ArrayFileReader(file(), "test-file", 1).number("", "edition"), 3.0);
  EXPECT_EQ(files_in_folder(), 1);
}

std::vector<double> rows(std::size_t first, std::size_t count, std::size_t row_size) {
  std::vector<double> values(count * row_size);
  std::iota(values.begin(), values.end(), static_cast<double>(first * row_size));
  return values;
}

TEST_F(ArrayFile, GrowsOverManyChunksAndIsReadableAfterEachFlush) {
  ArrayFileWriter out(file(), "test-file", 1, Mode::growing);
  out.create_growing("time", {}, "s", "time");
  out.create_growing("motion/displacement", {3, 6}, "m", "motions");
  EXPECT_FALSE(std::filesystem::exists(file()));
  std::size_t done = 0;
  for (const std::size_t count : {1U, 7U, 500U, 3U, 4000U}) {
    out.append("time", rows(done, count, 1));
    out.append("motion/displacement", rows(done, count, 18));
    out.flush();
    done += count;
    EXPECT_EQ(out.records(), done);
    const ArrayFileReader in(file(), "test-file", 1);
    EXPECT_EQ(in.records(), done);
    EXPECT_EQ(in.read("time").values, rows(0, done, 1));
    EXPECT_EQ(in.read("motion/displacement").shape, (std::vector<std::size_t>{done, 3, 6}));
    EXPECT_EQ(in.read("motion/displacement").values, rows(0, done, 18));
  }
  // What is appended, but not flushed, is no record yet.
  out.append("time", rows(done, 2, 1));
  EXPECT_EQ(ArrayFileReader(file(), "test-file", 1).read("time").values, rows(0, done, 1));
  out.append("motion/displacement", rows(done, 2, 18));
  out.close();
  EXPECT_EQ(ArrayFileReader(file(), "test-file", 1).read("time").values, rows(0, done + 2, 1));
  EXPECT_EQ(files_in_folder(), 1);
}

TEST_F(ArrayFile, ReopensTruncatesAndContinues) {
  {
    ArrayFileWriter out(file(), "test-file", 1, Mode::growing);
    out.create_growing("x", {2}, "m", "positions");
    out.create_slot("slot", "1", "a slot");
    out.attribute("state", "complete", std::int64_t{0});
    out.append("x", rows(0, 1234, 2));
    out.flush();
    out.append("x", rows(1234, 1766, 2));
    out.replace("slot", std::vector<double>{1, 2, 3});
    out.close();
  }
  {
    ArrayFileWriter out = ArrayFileWriter::reopen(file(), "test-file", 1);
    EXPECT_EQ(out.records(), 3000U);
    EXPECT_THROW(out.truncate(1235), InputError) << "no flush ended there";
    out.truncate(1234);
    EXPECT_EQ(ArrayFileReader(file(), "test-file", 1).read("x").values, rows(0, 1234, 2));
    out.append("x", rows(1234, 100, 2));
    out.replace("slot", std::vector<double>{4, 5});
    out.attribute("state", "complete", std::int64_t{1});
    out.close();
  }
  const ArrayFileReader in(file(), "test-file", 1);
  EXPECT_EQ(in.records(), 1334U);
  EXPECT_EQ(in.read("x").values, rows(0, 1334, 2));
  const std::vector<double> slot = in.read("slot").values;
  ASSERT_EQ(slot.size(), 3U);
  EXPECT_EQ(slot[0], 4.0);
  EXPECT_EQ(slot[1], 5.0);
  EXPECT_TRUE(std::isnan(slot[2])) << "nothing of the longer content may be left";
  EXPECT_EQ(in.number("state", "complete"), 1.0);
  EXPECT_THROW(static_cast<void>(ArrayFileWriter::reopen(file(), "other-file", 1)), InputError);
  EXPECT_THROW(static_cast<void>(ArrayFileWriter::reopen(file("none.h5"), "test-file", 1)), InputError);
}

TEST_F(ArrayFile, TextTooLongForItsRoomEndsInDots) {
  {
    ArrayFileWriter out(file(), "test-file", 1, Mode::growing);
    out.attribute("summary", "message", std::string_view("short"), 16);
    out.flush();
    out.attribute("summary", "message", std::string_view("exactly sixteen."));
    EXPECT_EQ(ArrayFileReader(file(), "test-file", 1).text("summary", "message"), "exactly sixteen.");
    out.attribute("summary", "message", std::string_view("longer than sixteen"));
    out.close();
  }
  EXPECT_EQ(ArrayFileReader(file(), "test-file", 1).text("summary", "message"), "longer than s...");
}

TEST_F(ArrayFile, AllowsOneWriterOfAGrowingFile) {
  ArrayFileWriter out(file(), "test-file", 1, Mode::growing);
  out.create_growing("x", {}, "m", "positions");
  out.append("x", rows(0, 10, 1));
  out.flush();
  expect_words(message_of([&] { ArrayFileWriter::reopen(file(), "test-file", 1); }), {"a.h5", "another run"});
  expect_words(message_of([&] { ArrayFileWriter(file(), "test-file", 1, Mode::growing); }), {"a.h5", "another run"});
  out.close();
  EXPECT_EQ(ArrayFileWriter::reopen(file(), "test-file", 1).records(), 10U);
}

// Rows that nobody can find under the file's name are not written.
TEST_F(ArrayFile, AGrowingFileThatIsRemovedOrReplacedIsNotFinished) {
  for (const bool replaced : {false, true}) {
    ArrayFileWriter out(file(), "test-file", 1, Mode::growing);
    out.create_growing("x", {}, "m", "positions");
    out.append("x", rows(0, 10, 1));
    out.flush();
    std::filesystem::remove(file());
    if (replaced) std::ofstream(file()) << "another file";
    EXPECT_THROW(out.close(), ComputationError) << replaced;
    std::filesystem::remove(file());
  }
}

TEST_F(ArrayFile, TwoThreadsMayUseTwoFiles) {
  const auto work = [&](const char* name, double value) {
    for (int i = 0; i < 20; ++i) {
      ArrayFileWriter out(file(name), "test-file", 1);
      out.write("x", std::vector<double>(1000, value), {1000}, "m", "values");
      out.close();
      EXPECT_EQ(ArrayFileReader(file(name), "test-file", 1).read("x").values, std::vector<double>(1000, value));
    }
  };
  std::thread other(work, "b.h5", 2.0);
  work("a.h5", 1.0);
  other.join();
}

TEST(Checksum, IsFnv1a) {
  // Offset basis, and the published value of "foobar" [http://www.isthe.com/chongo/tech/comp/fnv, test vectors], whose
  // first bytes here make a double together with two zero bytes hashed on top.
  EXPECT_EQ(checksum({}), 0xcbf29ce484222325ULL);
  std::uint64_t expected = 0x85944171f73967e8ULL;  // "foobar"
  constexpr std::uint64_t prime = 0x100000001b3ULL;
  expected *= prime;
  expected *= prime;
  const double value = std::bit_cast<double>(std::array<char, 8>{'f', 'o', 'o', 'b', 'a', 'r', '\0', '\0'});
  EXPECT_EQ(checksum({&value, 1}), expected);
  const std::vector<double> values{1.0, 2.0, 3.0};
  EXPECT_EQ(checksum(values), checksum(std::span(values).subspan(1), checksum(std::span(values).first(1))));
}

}  // namespace
}  // namespace railtab
