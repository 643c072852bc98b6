#pragma once

#include <span>
#include <vector>

namespace railtab {

/// ŷ = c₀ + Σ_j (b_j u_j + a_j u_j²) of least squares through responses y. Constant for fewer than three responses per
/// coefficient. Infinite responses count as the largest finite one.
class ResponseSurface {
 public:
  /// @param points  of the same number of variables, one for each response
  ResponseSurface(const std::vector<std::vector<double>>& points, std::span<const double> responses);

  [[nodiscard]] double operator()(std::span<const double> point) const;
  /// Root mean square of y − ŷ.
  [[nodiscard]] double deviation() const { return deviation_; }

 private:
  double constant_ = 0.0;
  std::vector<double> linear_, square_;  ///< b_j, a_j
  double deviation_ = 0.0;
};

}  // namespace railtab
