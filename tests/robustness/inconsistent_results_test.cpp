// Results with right checksums whose arrays do not agree with one another, or hold what no run writes: each is rejected
// with file, dataset, what was found and what is expected.

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <map>

#include "../folder_fixture.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/results/result_columns.hpp"
#include "railtab/runtime/results/result_file.hpp"
#include "railtab/tables/files/array_file.hpp"

namespace railtab {
namespace {

namespace columns = result_columns;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr std::size_t records = 3;

/// What to write instead: values of a dataset of the header or of a history, extents of a history's rows, texts, or an
/// attribute of the summary.
struct Fault {
  std::map<std::string, std::vector<double>> values{};
  std::map<std::string, std::vector<std::size_t>> rows{};
  std::map<std::string, std::vector<std::string>> texts{};
  std::map<std::string, double> summary{};
  bool older = false;  ///< none: a file of a version that did not write all entries of the summary
};

template <typename Value>
Value one_of(const std::map<std::string, Value>& faults, const std::string& path, Value sound) {
  const auto found = faults.find(path);
  return found == faults.end() ? sound : found->second;
}

class ResultsFile {
 public:
  ResultsFile(const std::filesystem::path& file, const Fault& fault)
      : fault_(fault), out_(file, results_filetype, columns::format_version, ArrayFileWriter::Mode::growing) {}

  void write() {
    for (const columns::HeaderText& text : columns::header_texts) {
      out_.attribute("header", text.name, std::string_view("text"));
    }
    texts("header/scene_text", {"text"});
    for (const columns::HeaderTexts& list : columns::header_text_lists) texts(list.path, {"a", "b"});
    for (const columns::MotionGroup& group : columns::motion_groups) {
      texts(std::string(group.name) + "/names", {"one", "other"});
    }
    const double speed = one_of(fault_.values, "header/speed", {50.0}).front();
    out_.write("header/speed", std::span(&speed, 1), {}, "m/s", "speed");
    for (const columns::HeaderColumn& column : columns::header) {
      const std::vector<double> values = one_of(fault_.values, column.path, std::vector<double>{2.0, 4.0});
      out_.write(column.path, values, {values.size()}, column.unit, column.description);
    }
    for (const columns::StepColumn& column : columns::step) history(column.path, {});
    history(columns::newton_iterations.path, {});
    for (const columns::WheelColumn& column : columns::wheel) history(column.path, {2});
    history(columns::patches.path, {2});
    for (const columns::MotionGroup& group : columns::motion_groups) {
      for (const columns::MotionColumn& column : columns::motion) {
        history(std::string(group.name) + "/" + column.path, {2, 6});
      }
    }
    summary();
    for (const auto& [path, values] : histories_) out_.append(path, values);
    out_.close();
  }

 private:
  void texts(const std::string& path, const std::vector<std::string>& sound) {
    out_.write(path, one_of(fault_.texts, path, sound), "texts");
  }

  void history(const std::string& path, const std::vector<std::size_t>& sound) {
    const std::vector<std::size_t> shape = one_of(fault_.rows, path, sound);
    std::size_t count = records;
    for (const std::size_t extent : shape) count *= extent;
    std::vector<double> values(count);
    for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<double>(i);
    out_.create_growing(path, shape, "1", "values");
    histories_[path] = one_of(fault_.values, path, values);
  }

  void summary() {
    out_.attribute("summary", "message", std::string_view("none"));
    out_.attribute("summary", "contact_mode", std::string_view("table"));
    const auto number = [&](const std::string& name, double sound) {
      out_.attribute("summary", name, one_of(fault_.summary, name, sound));
    };
    number("complete", 1.0);
    const auto numbers = [&](const auto& entries) {
      for (const auto& entry : entries) {
        if (entry.in_all_files || !fault_.older) number(entry.name, 1.0);
      }
    };
    numbers(columns::summary_counts);
    numbers(columns::summary_numbers);
    number(columns::contact_energy_impacts, 1.0);
    for (const auto& entry : columns::summary_contact_energy) number(entry.name, 1.0);
    for (const auto& entry : columns::summary_wheel_extremes) {
      number(entry.name, 1.0);
      number(std::string(entry.name) + "_time", 1.0);
      number(std::string(entry.name) + "_wheel", 1.0);
    }
  }

  const Fault& fault_;
  ArrayFileWriter out_;
  std::map<std::string, std::vector<double>> histories_;
};

class InconsistentResults : public testing::InFolder {
 protected:
  [[nodiscard]] std::string message_for(const Fault& fault) const {
    const std::filesystem::path file = folder_ / "r.h5";
    ResultsFile(file, fault).write();
    try {
      static_cast<void>(read_results(file));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  void expect_rejected(const Fault& fault, const std::string& path, const std::string& found,
                       const std::string& expected) const {
    const std::string message = message_for(fault);
    for (const std::string& word : {std::string("r.h5: ") + path, "found " + found, expected}) {
      EXPECT_NE(message.find(word), std::string::npos) << "\"" << word << "\" is missing in: " << message;
    }
  }
};

TEST_F(InconsistentResults, ButNotWithoutAFault) { EXPECT_EQ(message_for({}), ""); }
TEST_F(InconsistentResults, NorFromAnOlderVersion) { EXPECT_EQ(message_for({.older = true}), ""); }

TEST_F(InconsistentResults, LengthsOfTheHeaderAgree) {
  const std::vector<double> three{1.0, 2.0, 3.0};
  expect_rejected({.values = {{"header/static_wheel_load", three}}}, "header/static_wheel_load", "the shape (3)",
                  "2 wheels as in header/wheel_x");
  expect_rejected({.values = {{"header/wheel_z", three}}}, "header/wheel_z", "the shape (3)",
                  "2 wheel points as in header/wheel_y");
  expect_rejected({.values = {{"header/rail_z", {}}}}, "header/rail_z", "the shape (0)",
                  "2 rail points as in header/rail_y");
  expect_rejected({.values = {{"header/node_x", three}}}, "nodes/names", "the shape (2)",
                  "3 nodes as in header/node_x");
  expect_rejected({.texts = {{"header/input_checksums", {"one"}}}}, "header/input_checksums", "the shape (1)",
                  "2 files as in header/input_files");
  expect_rejected({.texts = {{"header/scene_text", {}}}}, "header/scene_text", "the shape (0)", "(1)");
  expect_rejected(
      {.values = {{"header/wheel_x", three}, {"header/static_wheel_load", three}, {"header/wheel_outline", three}}},
      "header/wheel_x", "3 wheels", "an even number");
  expect_rejected({.values = {{"header/judged", {10.0}}}}, "header/judged", "10", "begin and end of a stretch");
  expect_rejected({.values = {{"header/judged", {10.0, 5.0}}}}, "header/judged", "10, 5", "begin and end of a stretch");
}

TEST_F(InconsistentResults, HistoriesHaveTheShapeOfTheHeader) {
  for (const char* path : {"wheels/Q", "wheels/patches", "wheels/second_normal_force"}) {
    expect_rejected({.rows = {{path, {3}}}}, path, "the shape (3, 3)", "(3 records, 2 wheels as in header/wheel_x)");
  }
  expect_rejected({.rows = {{"time", {2}}}}, "time", "the shape (3, 2)", "(3 records)");
  expect_rejected({.rows = {{"bodies/velocity", {3, 6}}}}, "bodies/velocity", "the shape (3, 3, 6)",
                  "(3 records, 2 bodies as in bodies/names, 6)");
  expect_rejected({.rows = {{"nodes/acceleration", {2, 5}}}}, "nodes/acceleration", "the shape (3, 2, 5)", "6)");
}

TEST_F(InconsistentResults, NumbersAreFinite) {
  for (const columns::HeaderColumn& column : columns::header) {
    expect_rejected({.values = {{column.path, {1.0, nan}}}}, column.path, "nan as value 1", "a finite number");
  }
  expect_rejected({.values = {{"header/speed", {infinite}}}}, "header/speed", "inf", "a finite number");
  expect_rejected({.values = {{"position", {0.0, nan, 1.0}}}}, "position", "nan", "a finite number");
  expect_rejected({.values = {{"wheels/Y", {0, 0, 0, 0, 0, -infinite}}}}, "wheels/Y", "-inf", "a finite number");
  for (const std::string name : {"seconds_total", "largest_Q", "contact_energy_gain"}) {
    expect_rejected({.summary = {{name, nan}}}, "summary, attribute " + name, "nan", "a finite number");
  }
  expect_rejected({.summary = {{"steps", nan}}}, "summary, attribute steps", "nan", "a whole number");
}

TEST_F(InconsistentResults, CountsAreCountsAndTimeIncreases) {
  expect_rejected({.values = {{"newton_iterations", {1.0, 1.5, 2.0}}}}, "newton_iterations", "1.5", "a count");
  expect_rejected({.values = {{"wheels/patches", {0, 0, -1.0, 0, 0, 0}}}}, "wheels/patches", "-1", "a count");
  expect_rejected({.values = {{"time", {0.0, 1.0, 1.0}}}}, "time", "1 as value 2, after 1", "strictly increasing");
  expect_rejected({.summary = {{"complete", 2.0}}}, "summary, attribute complete", "2", "0 to 1");
  expect_rejected({.summary = {{"largest_Q_wheel", 2.0}}}, "summary, attribute largest_Q_wheel", "2", "-1 to 1");
}

}  // namespace
}  // namespace railtab
