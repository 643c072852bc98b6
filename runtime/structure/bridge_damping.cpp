#include "railtab/runtime/structure/bridge_damping.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

namespace {

struct Bound {
  std::string_view type;
  double long_span;  // ratio from 20 m on
  double per_metre;  // more for each metre below
};
constexpr std::array<Bound, 3> bounds{{{"steel-composite", 0.005, 0.00125},
                                       {"prestressed-concrete", 0.010, 0.0007},
                                       {"reinforced-concrete", 0.015, 0.0007}}};
constexpr double long_enough = 20.0;  // [m]

}  // namespace

std::vector<std::string> bridge_damping_types() {
  std::vector<std::string> names;
  for (const Bound& bound : bounds) names.emplace_back(bound.type);
  return names;
}

double damping_lower_bound(std::string_view key, std::string_view type, double span) {
  const auto* const bound = std::find_if(bounds.begin(), bounds.end(), [&](const Bound& b) { return b.type == type; });
  if (bound == bounds.end()) {
    throw input_error(key, type, fmt::format("one of {}", fmt::join(bridge_damping_types(), ", ")));
  }
  if (!(span > 0.0)) throw input_error(key, fmt::format("a span of {} m", span), "a span > 0 m");
  return bound->long_span + bound->per_metre * std::max(0.0, long_enough - span);
}

}  // namespace railtab
