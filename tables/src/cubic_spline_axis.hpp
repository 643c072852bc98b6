#pragma once

#include <Eigen/Core>
#include <array>

namespace railtab {

/// What a spline does at an end of its axis: `free` has no knot at the second node (not-a-knot), `even` and `odd` are
/// mirrored there, `turned` goes on at the other end with its sign changed, `periodic` goes on there as it is.
enum class SplineEnd { free, even, odd, periodic, turned };

/// Matrix from values at `nodes` uniform nodes to the coefficients of the cubic B-spline through them: nodes + 2 rows,
/// the first belongs to the place one step before the first node. Periodic and turned ends come in pairs; the node that
/// would repeat the first one is not among the nodes, and there is one row more, for the cell that closes the circle.
/// [deBoor1978, Ch. XIII]
[[nodiscard]] Eigen::MatrixXd spline_coefficient_matrix(int nodes, SplineEnd first, SplineEnd last);

/// Weights of the four coefficients around a cell, at fraction f of it, and their derivatives with respect to f.
template <typename Real>
struct SplineWeights {
  std::array<Real, 4> value, slope;

  explicit SplineWeights(Real f) noexcept {
    const Real g = Real(1) - f, ff = f * f, gg = g * g;
    constexpr Real sixth = Real(1) / Real(6);
    value = {sixth * gg * g, sixth * (Real(4) + ff * (Real(3) * f - Real(6))),
             sixth * (Real(4) + gg * (Real(3) * g - Real(6))), sixth * ff * f};
    slope = {Real(-0.5) * gg, f * (Real(1.5) * f - Real(2)), g * (Real(2) - Real(1.5) * g), Real(0.5) * ff};
  }
};

}  // namespace railtab
