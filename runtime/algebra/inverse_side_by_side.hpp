#pragma once

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <cstddef>

#include "railtab/runtime/base/lane_numbers.hpp"

namespace railtab {

/// Eight square matrices side by side: row i, column j of matrix s is entry[n·i + j][s].
template <int n>
struct MatricesSideBySide {
  static constexpr int count = Lanes::count;
  std::array<Lanes, std::size_t{n} * n> entry;

  [[nodiscard]] Lanes& at(int i, int j) noexcept { return entry[static_cast<std::size_t>(n * i + j)]; }
  [[nodiscard]] const Lanes& at(int i, int j) const noexcept { return entry[static_cast<std::size_t>(n * i + j)]; }
};

/// Replaces the matrices by their inverses: Gauss–Jordan elimination with the pivots on the diagonal [Higham2002, Sect.
/// 14.4], and for a matrix with a pivot below `smallest_pivot` in amount a factor with row exchanges. Meant for
/// matrices of the size of the identity; the inverse of a singular one is not finite, or above 1e12. A matrix's inverse
/// does not depend on those beside it.
template <int n>
void invert_side_by_side(MatricesSideBySide<n>& m) noexcept {
  constexpr double smallest_pivot = 0.1;
  const MatricesSideBySide<n> given = m;
  Lanes smallest = Lanes{} + HUGE_VAL;
  for (int k = 0; k < n; ++k) {
    const Lanes pivot = m.at(k, k);
    smallest = min(abs(pivot), smallest);
    const Lanes inverse = 1.0 / pivot;
    m.at(k, k) = Lanes{} + 1.0;
    for (int j = 0; j < n; ++j) m.at(k, j) *= inverse;
    for (int i = 0; i < n; ++i) {
      if (i == k) continue;
      const Lanes factor = m.at(i, k);
      m.at(i, k) = Lanes{};
      for (int j = 0; j < n; ++j) m.at(i, j) -= factor * m.at(k, j);
    }
  }
  for (int s = 0; s < MatricesSideBySide<n>::count; ++s) {
    if (smallest[s] >= smallest_pivot) continue;
    Eigen::Matrix<double, n, n> matrix;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) matrix(i, j) = given.at(i, j)[s];
    }
    const Eigen::Matrix<double, n, n> inverse = matrix.partialPivLu().inverse();
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) m.at(i, j)[s] = inverse(i, j);
    }
  }
}

}  // namespace railtab
