#include "channel_values.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "railtab/runtime/measures/track_mean.hpp"

namespace railtab::report {

bool sparse(const RunResults& run) {
  constexpr double widest = 0.5;  // m
  for (std::size_t i = 1; i < run.steps.size(); ++i) {
    if (run.steps[i].position - run.steps[i - 1].position > widest) return true;
  }
  return run.steps.size() < 2;
}

std::vector<double> sliding_means(const RunResults& run, const std::function<double(const StepRecord&)>& value) {
  constexpr double averaged = 2.0;  // m
  TrackMean mean(averaged);
  std::vector<double> means;
  means.reserve(run.steps.size());
  for (const StepRecord& step : run.steps) {
    const double now = value(step);
    const std::optional<double> result = std::isfinite(now) ? mean.add(step.position, now) : std::nullopt;
    means.push_back(result ? std::abs(*result) : std::numeric_limits<double>::quiet_NaN());
  }
  return means;
}

std::optional<double> even_spacing(const RunResults& run) {
  constexpr double allowed = 1e-6;
  if (run.steps.size() < 3) return std::nullopt;
  const double first = run.steps[1].time - run.steps[0].time;
  for (std::size_t i = 2; i + 1 < run.steps.size(); ++i) {
    if (std::abs(run.steps[i].time - run.steps[i - 1].time - first) > allowed * first) return std::nullopt;
  }
  return first;
}

double largest_amount(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values) {
    if (std::isfinite(value)) most = std::max(most, std::abs(value));
  }
  return most;
}

}  // namespace railtab::report
