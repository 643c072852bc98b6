#include "railtab/runtime/base/interval_search.hpp"

#include <algorithm>
#include <cassert>

namespace railtab {

size_t interval_at(std::span<const double> nodes, double x) noexcept {
  assert(nodes.size() >= 2 && nodes.front() <= x && x <= nodes.back());
  const size_t intervals = nodes.size() - 1;
  // right at once where the nodes are evenly spaced
  const double share = (x - nodes.front()) / (nodes.back() - nodes.front());
  const size_t guess = std::min(static_cast<size_t>(share * static_cast<double>(intervals)), intervals - 1);
  if (nodes[guess] <= x && x <= nodes[guess + 1]) return guess;
  // Otherwise low..high is widened from there, by twice as much each time, until it holds x.
  size_t low = guess, high = guess + 1;
  for (size_t reach = 1; low > 0 && nodes[low] > x; reach *= 2) {
    high = low;
    low -= std::min(reach, low);
  }
  for (size_t reach = 1; high < intervals && nodes[high] <= x; reach *= 2) {
    low = high;
    high += std::min(reach, intervals - high);
  }
  const auto above = std::upper_bound(nodes.data() + low, nodes.data() + high, x);
  return std::min(static_cast<size_t>(above - nodes.data()) - 1, intervals - 1);
}

}  // namespace railtab
