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
  const size_t above = static_cast<size_t>(std::upper_bound(nodes.begin(), nodes.end(), x) - nodes.begin());
  return std::min(above - 1, intervals - 1);
}

}  // namespace railtab
