#pragma once

#include <deque>
#include <optional>

namespace railtab {

/// Sliding mean along the track: of the line through the samples, over the last `length` [m] of way. Running safety
/// takes 2 m [EN14363]. Exact for that line, whatever the distance of the samples; bounded memory.
class TrackMean {
 public:
  explicit TrackMean(double length) : length_(length) {}
  /// The mean from `position` − length to `position` [m]; none before so much way is known.
  /// @pre positions rise
  [[nodiscard]] std::optional<double> add(double position, double value);

 private:
  struct Sample {
    double position, value, integral;  ///< from the first sample on
  };
  double length_;
  std::deque<Sample> samples_;
};

}  // namespace railtab
