#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "railtab/runtime/results/result_file.hpp"

namespace railtab {

inline ResultHeader made_up_header(bool with_nodes = true) {
  ResultHeader header;
  header.scene_name = "made-up scene";
  header.scene_text = "[train]\nspeed = 55.5\n" + std::string(100000, '#');  // more than an HDF5 attribute holds
  header.program_version = "0.1.0";
  header.speed = 55.5;
  header.wheel_x = {0.0, 0.0, -2.5, -2.5};
  header.static_wheel_load = {5e4, 5.1e4, 5.2e4, 5.3e4};
  header.body_names = {"coach-1/car-body", "coach-1/bogie-1", "coach-1/wheelset-1"};
  header.body_x = {-9.5, -1.25, 0.0};
  header.span_from = {0.0, 20.0};
  header.span_to = {20.0, 45.0};
  header.built = {"2 x coach", "flexible track"};
  header.warnings = {"a load that acts nowhere"};
  if (with_nodes) {
    header.node_names = {"midspan", "quarter span"};
    header.node_x = {15.0, 7.5};
  }
  header.wheel_profile = "S1002";
  header.rail_profile = "60E1";
  header.wheel_y = {-0.03, 0.0, 0.03};
  header.wheel_z = {0.02, 0.0, -0.001};
  header.rail_y = {-0.03, 0.03};
  header.rail_z = {0.01, 0.012};
  return header;
}

/// A record whose every number is different, and a function of its index alone.
inline StepRecord made_up_record(long index, const ResultHeader& header) {
  StepRecord record;
  int k = 0;
  const auto next = [&] { return std::sin(static_cast<double>(++k)) + static_cast<double>(index); };
  record.time = next();
  record.position = next();
  for (std::size_t i = 0; i < header.wheel_x.size(); ++i) {
    WheelRecord w;
    w.patches = static_cast<int>((index + static_cast<long>(i)) % 3);
    w.from_table = static_cast<int>((index + static_cast<long>(i)) % 2);
    for (double* value : {&w.Q, &w.Y, &w.X, &w.y_rail, &w.y_wheel, &w.angle, &w.rolling_radius, &w.normal_force,
                          &w.penetration, &w.second_y_rail, &w.second_normal_force, &w.wear_number, &w.pressure}) {
      *value = next();
    }
    record.wheels.push_back(w);
  }
  const auto motion = [&] {
    MotionRecord m;
    for (auto* values : {&m.displacement, &m.velocity, &m.acceleration}) {
      for (double& value : *values) value = next();
    }
    return m;
  };
  for (std::size_t i = 0; i < header.body_names.size(); ++i) record.bodies.push_back(motion());
  for (std::size_t i = 0; i < header.node_names.size(); ++i) record.nodes.push_back(motion());
  record.newton_iterations = static_cast<int>(index % 7);
  return record;
}

/// All numbers of a record in one list.
inline std::vector<double> numbers_of(const StepRecord& r) {
  std::vector<double> n{r.time, r.position, static_cast<double>(r.newton_iterations)};
  for (const WheelRecord& w : r.wheels) {
    n.insert(n.end(), {w.Q, w.Y, w.X, static_cast<double>(w.patches), static_cast<double>(w.from_table), w.y_rail,
                       w.y_wheel, w.angle, w.rolling_radius, w.normal_force, w.penetration, w.second_y_rail,
                       w.second_normal_force, w.wear_number, w.pressure});
  }
  for (const auto* motions : {&r.bodies, &r.nodes}) {
    for (const MotionRecord& m : *motions) {
      n.insert(n.end(), m.displacement, m.displacement + 6);
      n.insert(n.end(), m.velocity, m.velocity + 6);
      n.insert(n.end(), m.acceleration, m.acceleration + 6);
    }
  }
  return n;
}

inline void expect_made_up_records(const RunResults& results, const ResultHeader& header) {
  for (std::size_t i = 0; i < results.steps.size(); ++i) {
    const std::vector<double> found = numbers_of(results.steps[i]);
    const std::vector<double> expected = numbers_of(made_up_record(static_cast<long>(i), header));
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
      ASSERT_EQ(found[k], expected[k]) << "number " << k << " of record " << i << " of " << results.steps.size();
    }
  }
}

inline RunSummary complete_summary() {
  RunSummary summary;
  summary.complete = true;
  return summary;
}

inline std::vector<double> made_up_state(long step) {
  std::vector<double> state(5000);
  for (std::size_t i = 0; i < state.size(); ++i) state[i] = static_cast<double>(step) + 1e-3 * static_cast<double>(i);
  return state;
}

class ResultFile : public ::testing::Test {
 protected:
  ~ResultFile() override { std::filesystem::remove(file_); }

  std::filesystem::path file_ =
      std::filesystem::temp_directory_path() / ("railtab_results_" + std::to_string(::getpid()) + ".h5");
  ResultHeader header_ = made_up_header();
};

/// Everything that a reader returns, as bytes.
inline std::string all_read(const std::filesystem::path& file) {
  const RunResults r = read_results(file);
  std::string all = r.header.scene_text + r.header.scene_name + r.header.program_version + r.header.wheel_profile +
                    r.header.rail_profile + r.summary.message + r.summary.contact_mode;
  for (const auto* names :
       {&r.header.body_names, &r.header.node_names, &r.header.input_files, &r.header.input_checksums}) {
    for (const std::string& name : *names) all += name + '\n';
  }
  std::vector<double> numbers{r.header.speed, r.summary.complete ? 1.0 : 0.0, static_cast<double>(r.summary.steps),
                              r.summary.seconds_total};
  for (const auto* values : {&r.header.wheel_x, &r.header.static_wheel_load, &r.header.node_x, &r.header.wheel_y,
                             &r.header.wheel_z, &r.header.rail_y, &r.header.rail_z}) {
    numbers.insert(numbers.end(), values->begin(), values->end());
  }
  for (const StepRecord& step : r.steps) {
    const std::vector<double> more = numbers_of(step);
    numbers.insert(numbers.end(), more.begin(), more.end());
  }
  return all + std::string(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double));
}

}  // namespace railtab
