#pragma once

#include <cstddef>
#include <span>

namespace railtab {

/// Index i of the interval nodes[i] <= x <= nodes[i + 1]. Constant time where nodes are evenly spaced,
/// otherwise O(log d) with d intervals between this one and that of evenly spaced nodes.
/// @pre nodes strictly increasing, at least two; nodes.front() <= x <= nodes.back()
[[nodiscard]] size_t interval_at(std::span<const double> nodes, double x) noexcept;

}  // namespace railtab
