#include "railtab/runtime/measures/percentile.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace railtab {

double percentile(std::vector<double> values, double share) {
  assert(!values.empty() && share >= 0.0 && share <= 1.0);
  const double place = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(std::floor(place));
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(below);
  std::nth_element(values.begin(), at, values.end());
  const double low = *at;
  if (below + 1 == values.size()) return low;
  const double high = *std::min_element(at + 1, values.end());
  return low + (place - static_cast<double>(below)) * (high - low);
}

}  // namespace railtab
