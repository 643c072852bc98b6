#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <vector>

namespace railtab {

/// Linear between points; beyond them the first or the last value.
/// @pre points strictly increasing, at least one, as many values
template <class Value>
[[nodiscard]] Value interpolate(const std::vector<double>& points, const std::vector<Value>& values, double at) {
  assert(!points.empty() && points.size() == values.size());
  const auto after = std::upper_bound(points.begin(), points.end(), at);
  if (after == points.begin()) return values.front();
  if (after == points.end()) return values.back();
  const auto i = static_cast<std::size_t>(after - points.begin());
  const double part = (at - points[i - 1]) / (points[i] - points[i - 1]);
  return (1.0 - part) * values[i - 1] + part * values[i];
}

}  // namespace railtab
