#pragma once

#include <Eigen/Core>

namespace railtab {

/// Unknowns `begin` to `begin + count`: those that take part in a step.
struct DofRange {
  Eigen::Index begin = 0, count = 0;
  [[nodiscard]] Eigen::Index end() const noexcept { return begin + count; }
  [[nodiscard]] auto of(Eigen::VectorXd& vector) const { return vector.segment(begin, count); }
  [[nodiscard]] auto of(const Eigen::VectorXd& vector) const { return vector.segment(begin, count); }
  bool operator==(const DofRange&) const = default;
};

}  // namespace railtab
