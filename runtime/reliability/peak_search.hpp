#pragma once

#include <functional>
#include <map>
#include <vector>

namespace railtab {

struct PeakSearchOptions {
  std::size_t points = 0;       ///< of the grid
  std::size_t coarse_step = 8;  ///< the search begins with every so many points and the last
  double share = 0.75;          ///< peaks at least so high between the smallest and the largest value found are refined
  std::size_t most_evaluations = 0;  ///< 0: a quarter of the grid, and no less than the coarse points
  std::vector<std::size_t> also{};   ///< points to begin with besides
};

struct PeakSearch {
  std::map<std::size_t, double> values;  ///< of the points evaluated
  std::size_t highest = 0;               ///< the point of the largest value
  bool resolved = false;  ///< all peaks that count have both their neighbours on the grid among the points
};

/// The largest value on a grid without most of its points: after the coarse points, the intervals on both sides of each
/// local maximum that counts are halved until they are one step wide. The next points of all peaks are asked for at a
/// time. A peak narrower than two coarse steps can be missed.
/// @param values of points of the grid, in their order; no NaN @pre points >= 1, coarse_step >= 1, 0 <= share <= 1
[[nodiscard]] PeakSearch search_peak(const PeakSearchOptions& options,
                                     const std::function<std::vector<double>(const std::vector<std::size_t>&)>& values);

}  // namespace railtab
