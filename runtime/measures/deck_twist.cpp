#include "railtab/runtime/measures/deck_twist.hpp"

#include <algorithm>
#include <cmath>

namespace railtab {
namespace {

double at(std::span<const double> x, std::span<const double> values, double place) {
  const auto above = std::upper_bound(x.begin() + 1, x.end() - 1, place) - x.begin();
  const auto b = static_cast<std::size_t>(above), a = b - 1;
  return values[a] + (values[b] - values[a]) * (place - x[a]) / (x[b] - x[a]);
}

}  // namespace

Twist largest_twist(std::span<const double> x, std::span<const double> cross_level, double base) {
  Twist twist;
  const auto look = [&](double from) {
    if (from < x.front() || from + base > x.back()) return;
    const double change = std::abs(at(x, cross_level, from + base) - at(x, cross_level, from));
    if (change > twist.value) twist = {change, from};
  };
  for (const double place : x) {  // a piecewise linear difference is largest where one of its ends has a kink
    look(place);
    look(place - base);
  }
  return twist;
}

}  // namespace railtab
