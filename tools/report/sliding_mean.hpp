#pragma once

#include <deque>
#include <optional>

namespace railtab::report {

/// Mean of what was recorded over the last metres of way, as running-safety quantities are averaged.
class SlidingMean {
 public:
  /// @param length of the way averaged over [m]
  explicit SlidingMean(double length) : length_(length) {}

  /// The mean of the records between `position` − length and `position` [m]; empty until so much way has been recorded.
  /// @pre positions do not decrease
  [[nodiscard]] std::optional<double> add(double position, double value) {
    if (!first_) first_ = position;
    samples_.push_back({position, value});
    while (samples_.front().position < position - length_) samples_.pop_front();
    if (position - *first_ < length_) return std::nullopt;
    double sum = 0.0;
    for (const Sample& sample : samples_) sum += sample.value;
    return sum / static_cast<double>(samples_.size());
  }

 private:
  struct Sample {
    double position, value;
  };
  double length_;
  std::optional<double> first_;
  std::deque<Sample> samples_;
};

}  // namespace railtab::report
