#include "run_error.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>

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
  if (reference.records.empty() || reference.records.size() != run.records.size()) return {none, none};
  std::vector<double> mean = channels(reference, reference.records.front(), quantity);
  std::fill(mean.begin(), mean.end(), 0.0);
  for (const StepRecord& record : reference.records) {
    const std::vector<double> r = channels(reference, record, quantity);
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += r[k] / static_cast<double>(reference.records.size());
  }
  double difference2 = 0.0, dynamic2 = 0.0, difference = 0.0, dynamic = 0.0;
  for (std::size_t i = 0; i < reference.records.size(); ++i) {
    if (std::abs(reference.records[i].time - run.records[i].time) > 1e-9) return {none, none};
    const std::vector<double> r = channels(reference, reference.records[i], quantity);
    const std::vector<double> a = channels(run, run.records[i], quantity);
    for (std::size_t k = 0; k < mean.size(); ++k) {
      difference2 += (a[k] - r[k]) * (a[k] - r[k]);
      dynamic2 += (r[k] - mean[k]) * (r[k] - mean[k]);
      difference = std::max(difference, std::abs(a[k] - r[k]));
      dynamic = std::max(dynamic, std::abs(r[k] - mean[k]));
    }
  }
  if (!(dynamic2 > 0.0)) return {none, none};
  return {std::sqrt(difference2 / dynamic2), difference / dynamic};
}

}  // namespace railtab::work_precision
