#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>

namespace railtab {

/// Local coordinates in a leaf, -1..1 on each axis: a lateral, b yaw², c roll. That of a fixed axis is not used.
struct LocalPoint {
  float a, b, c;
};

constexpr int branch_quantities = 4;
constexpr int most_branch_terms = 12;
/// Terms of a branch's polynomials, by the axes that are not fixed: 1 a a² a³, and with yaw² b b² ab a²b, and with
/// roll c c² ac bc. A single one of the two counts as b.
[[nodiscard]] constexpr int branch_terms(bool yaw_axis, bool roll_axis) noexcept {
  return 4 * (1 + static_cast<int>(yaw_axis) + static_cast<int>(roll_axis));
}

/// Where Newton is to start for a wheel on one branch.
struct BranchStart {
  double z_touch;          ///< centre height of a wheel that just touches on this branch [m]
  double s_wheel, s_rail;  ///< the deepest pair, about [m]
};

/// What a query needs of the leaf of a geometry table that it falls into. Views the table's coefficients.
///
/// A look-up is one chain of dependent operations: start() stands here, so that it runs into what is made of it.
struct GeometryLeaf {
  const float* coefficient = nullptr;  ///< `count` branches of `terms` x branch_quantities, 16-byte aligned
  int count = 0;                       ///< of branches
  int terms = 0;                       ///< branch_terms()
  LocalPoint point{};                  ///< a single axis beside the lateral one is b
  float per_metre = 0;                 ///< lateral local coordinate per metre: the inverse half width [1/m]
  /// Largest height of the wheel below first touch on the lowest of the branches at which these are all that can be in
  /// contact [m]. 0: not to be trusted at any height.
  float trusted_lowering = 0;
  bool inside = false;  ///< the query is on the table's axes

  /// The start on branch n, 0 <= n < count, of a wheel whose centre is at height z [m].
  /// A wheel at (y, z) with penetration d along n touches, moved back by d n, at the same pair: the start is the
  /// touching pair at y* = y - d n_y, where d = (z - z_touch) n_z.
  [[nodiscard]] BranchStart start(int n, double z) const noexcept;

 private:
  using Row = Eigen::Array4f;  // z_touch, s_wheel, s_rail, n_y n_z
};

inline BranchStart GeometryLeaf::start(int n, double z) const noexcept {
  const float* const c = coefficient + static_cast<std::ptrdiff_t>(n) * terms * branch_quantities;
  const auto row = [c](int k) -> Row { return Eigen::Map<const Row, Eigen::Aligned16>(c + branch_quantities * k); };
  // By powers of a, at (b, c).
  Row r0 = row(0);
  Row r1 = row(1);
  Row r2 = row(2);
  Row r3 = row(3);
  if (terms > 4) {
    const float b = point.b;
    r0 = r0 + b * (r1 + b * r2);
    r1 = r3 + b * row(4);
    r2 = row(5) + b * row(6);
    r3 = row(7);
  }
  if (terms > 8) {
    r0 += point.c * (row(8) + point.c * row(9) + point.b * row(10));
    r1 += point.c * row(11);
  }
  // Not Horner's order: two products side by side.
  const auto at = [&](float a) -> Row { return (r0 + a * r1) + (a * a) * (r2 + a * r3); };
  const Row touch = at(point.a);
  const float shift = std::max(static_cast<float>(z) - touch[0], 0.0F) * (touch[3] * per_metre);
  const Row pair = at(point.a - shift);
  return {static_cast<double>(touch[0]), static_cast<double>(pair[1]), static_cast<double>(pair[2])};
}

}  // namespace railtab
