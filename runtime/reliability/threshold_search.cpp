#include "railtab/runtime/reliability/threshold_search.hpp"

namespace railtab {

std::vector<ThresholdSearch> search_thresholds(
    std::size_t searches, std::size_t points, double limit,
    const std::function<std::vector<double>(const std::vector<SearchPoint>&)>& values) {
  struct Interval {
    std::size_t low, high;  // the point sought is one of these
  };
  std::vector<ThresholdSearch> found(searches);
  std::vector<Interval> within(searches, {0, points});
  for (;;) {
    std::vector<SearchPoint> next;
    for (std::size_t i = 0; i < searches; ++i) {
      if (within[i].low < within[i].high) next.push_back({i, (within[i].low + within[i].high) / 2});
    }
    if (next.empty()) break;
    const std::vector<double> at = values(next);
    for (std::size_t k = 0; k < next.size(); ++k) {
      const auto [search, point] = next[k];
      found[search].values.emplace(point, at[k]);
      if (at[k] >= limit) {
        within[search].high = point;
      } else {
        within[search].low = point + 1;
      }
    }
  }
  for (std::size_t i = 0; i < searches; ++i) found[i].reached = within[i].low;
  return found;
}

}  // namespace railtab
