#pragma once

#include <cstddef>
#include <span>

namespace railtab {

/// Index i of the interval nodes[i] <= x <= nodes[i + 1]. O(log d), d intervals from where evenly spaced nodes have x.
/// @pre nodes strictly increasing, at least two; nodes.front() <= x <= nodes.back()
[[nodiscard]] size_t interval_at(std::span<const double> nodes, double x) noexcept;

}  // namespace railtab
