#include "run_error.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>

#include "railtab/runtime/measures/dynamic_difference.hpp"

namespace railtab::work_precision {

namespace {

bool is_car_body(const std::string& name) {
  return name.find("wheelset") == std::string::npos && name.find("bogie") == std::string::npos;
}

// The quantity's channels at one time.
std::vector<double> channels(const MeasuredRun& run, const StepRecord& record, Quantity quantity) {
  std::vector<double> values;
  switch (quantity) {
    case Quantity::wheel_forces:
      for (const WheelRecord& wheel : record.wheels) values.insert(values.end(), {wheel.Q, wheel.Y});
      break;
    case Quantity::car_body_acceleration:
      for (std::size_t i = 0; i < record.bodies.size(); ++i) {
        if (i < run.body_names.size() && !is_car_body(run.body_names[i])) continue;
        values.insert(values.end(), {record.bodies[i].acceleration[2], record.bodies[i].acceleration[1]});
      }
      break;
    case Quantity::deck_acceleration:
      for (std::size_t i = 0; i < record.nodes.size(); ++i) {
        if (i < run.node_names.size() && !is_deck(run.node_names[i])) continue;
        values.push_back(record.nodes[i].acceleration[2]);
      }
      break;
  }
  return values;
}

}  // namespace

MeasuredRun measured(const std::function<RunSummary(const RunObserver&)>& run) {
  MeasuredRun result;
  std::clock_t begin = std::clock();
  RunObserver observer;
  observer.start = [&](const ResultHeader& header) {
    result.body_names = header.body_names;
    result.node_names = header.node_names;
  };
  observer.ready = [&] { begin = std::clock(); };
  observer.record = [&](const StepRecord& record) { result.records.push_back(record); };
  result.summary = run(observer);
  result.seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  return result;
}

std::vector<MeasuredRun> median_runs(std::size_t count, bool quick,
                                     const std::function<MeasuredRun(std::size_t)>& run) {
  std::vector<MeasuredRun> last(count);
  std::vector<std::vector<double>> seconds(count);
  for (int round = 0; round < (quick ? 1 : 3); ++round) {
    for (std::size_t i = 0; i < count; ++i) seconds[i].push_back((last[i] = run(i)).seconds);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const auto middle = seconds[i].begin() + static_cast<std::ptrdiff_t>(seconds[i].size() / 2);
    std::nth_element(seconds[i].begin(), middle, seconds[i].end());
    last[i].seconds = *middle;
  }
  return last;
}

RunError run_error(const MeasuredRun& reference, const MeasuredRun& run, Quantity quantity) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  if (reference.records.size() != run.records.size()) return {none, none};
  std::vector<std::vector<double>> expected, found;
  for (std::size_t i = 0; i < reference.records.size(); ++i) {
    if (std::abs(reference.records[i].time - run.records[i].time) > 1e-9) return {none, none};
    expected.push_back(channels(reference, reference.records[i], quantity));
    found.push_back(channels(run, run.records[i], quantity));
  }
  const DynamicDifference of = dynamic_difference(expected, found);
  if (!(of.dynamic_square > 0.0)) return {none, none};
  return {std::sqrt(of.square / of.dynamic_square), of.largest / of.dynamic_largest};
}

}  // namespace railtab::work_precision
