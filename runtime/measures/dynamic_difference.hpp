#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace railtab {

/// How one history of some channels differs from a reference, and how large the reference's dynamic part is: what every
/// channel differs from its mean over time by. Sums of squares and largest values, over all times and channels.
struct DynamicDifference {
  double square = 0.0, largest = 0.0;                  ///< of the difference
  double dynamic_square = 0.0, dynamic_largest = 0.0;  ///< of the dynamic part
};

/// @param reference, other channels by times; over those times that both have
template <class Number>
[[nodiscard]] DynamicDifference dynamic_difference(const std::vector<std::vector<Number>>& reference,
                                                   const std::vector<std::vector<Number>>& other) {
  DynamicDifference of;
  const std::size_t times = std::min(reference.size(), other.size());
  if (times == 0) return of;
  std::vector<double> mean(reference.front().size(), 0.0);
  for (std::size_t i = 0; i < times; ++i) {
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += reference[i][k] / static_cast<double>(times);
  }
  for (std::size_t i = 0; i < times; ++i) {
    for (std::size_t k = 0; k < mean.size(); ++k) {
      const double r = reference[i][k], difference = other[i][k] - r, dynamic = r - mean[k];
      of.square += difference * difference;
      of.dynamic_square += dynamic * dynamic;
      of.largest = std::max(of.largest, std::abs(difference));
      of.dynamic_largest = std::max(of.dynamic_largest, std::abs(dynamic));
    }
  }
  return of;
}

}  // namespace railtab
