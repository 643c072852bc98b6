#include "railtab/runtime/reliability/peak_search.hpp"

#include <algorithm>
#include <set>

namespace railtab {
namespace {

using Values = std::map<std::size_t, double>;

/// Middles of the intervals beside each local maximum that counts.
std::vector<std::size_t> next_points(const Values& values, double share) {
  const auto by_value = [](const auto& a, const auto& b) { return a.second < b.second; };
  const auto [least, most] = std::minmax_element(values.begin(), values.end(), by_value);
  const double counts = least->second + share * (most->second - least->second);
  std::set<std::size_t> next;
  for (auto at = values.begin(); at != values.end(); ++at) {
    const auto left = at == values.begin() ? at : std::prev(at);
    const auto right = std::next(at) == values.end() ? at : std::next(at);
    if (at->second < counts || at->second < left->second || at->second < right->second) continue;
    if (at->first - left->first > 1) next.insert((left->first + at->first) / 2);
    if (right->first - at->first > 1) next.insert((at->first + right->first) / 2);
  }
  return {next.begin(), next.end()};
}

}  // namespace

PeakSearch search_peak(const PeakSearchOptions& options,
                       const std::function<std::vector<double>(const std::vector<std::size_t>&)>& values) {
  std::set<std::size_t> coarse(options.also.begin(), options.also.end());
  for (std::size_t i = 0; i < options.points; i += options.coarse_step) coarse.insert(i);
  coarse.insert(options.points - 1);
  const std::size_t most =
      std::max(coarse.size(), options.most_evaluations > 0 ? options.most_evaluations : options.points / 4);
  PeakSearch search;
  std::vector<std::size_t> next(coarse.begin(), coarse.end());
  while (!next.empty()) {
    const std::vector<double> found = values(next);
    for (std::size_t k = 0; k < next.size(); ++k) search.values.emplace(next[k], found[k]);
    next = next_points(search.values, options.share);
    search.resolved = next.empty();
    const std::size_t left = most - search.values.size();
    if (next.size() <= left) continue;
    // the points beside the highest values first
    const auto near = [&](std::size_t point) {
      const auto right = search.values.lower_bound(point);
      return std::max(right->second, std::prev(right)->second);
    };
    std::stable_sort(next.begin(), next.end(), [&](std::size_t a, std::size_t b) { return near(a) > near(b); });
    next.resize(left);
    std::sort(next.begin(), next.end());
  }
  search.highest = std::max_element(search.values.begin(), search.values.end(), [](const auto& a, const auto& b) {
                     return a.second < b.second;
                   })->first;
  return search;
}

}  // namespace railtab
