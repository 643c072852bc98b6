#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

namespace railtab {

/// Unknowns `begin` to `begin + count`: those that take part in a step.
struct DofRange {
  Eigen::Index begin = 0, count = 0;
  [[nodiscard]] Eigen::Index end() const noexcept { return begin + count; }
  [[nodiscard]] auto of(Eigen::VectorXd& vector) const { return vector.segment(begin, count); }
  [[nodiscard]] auto of(const Eigen::VectorXd& vector) const { return vector.segment(begin, count); }
  bool operator==(const DofRange&) const = default;
};

/// Unknowns with from <= x <= to. @param x of every unknown, not decreasing
[[nodiscard]] inline DofRange dofs_between(const std::vector<double>& x, double from, double to) {
  const auto begin = std::lower_bound(x.begin(), x.end(), from) - x.begin();
  return {begin, std::upper_bound(x.begin(), x.end(), to) - x.begin() - begin};
}

}  // namespace railtab
