#pragma once

#include <functional>
#include <map>
#include <vector>

namespace railtab {

/// A point on the grid of one of several searches.
struct SearchPoint {
  std::size_t search = 0, point = 0;
};

struct ThresholdSearch {
  std::map<std::size_t, double> values;  ///< of the points evaluated
  std::size_t reached = 0;               ///< the point found; as many as the grid has: none
};

/// The first point of each grid whose value is at least `limit`, by bisection: at most log2(points + 1) rounds, in
/// which the next points of all searches are asked for at a time. Values are taken to reach the limit once and to stay
/// there: of several crossings one is found, with a value below the limit at the point before.
/// @param values of the points asked for, in their order; no NaN @pre points >= 1
[[nodiscard]] std::vector<ThresholdSearch> search_thresholds(
    std::size_t searches, std::size_t points, double limit,
    const std::function<std::vector<double>(const std::vector<SearchPoint>&)>& values);

}  // namespace railtab
