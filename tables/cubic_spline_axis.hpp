#pragma once

#include <Eigen/Core>

namespace railtab {

/// What a spline does at an end of its axis: `free` has no knot at the second node (not-a-knot), `even` and `odd` are
/// mirrored there, `turned` goes on at the other end with its sign changed, `periodic` goes on there as it is.
enum class SplineEnd { free, even, odd, periodic, turned };

/// Matrix from values at `nodes` uniform nodes to the coefficients of the cubic B-spline through them: nodes + 2 rows,
/// the first belongs to the place one step before the first node. Periodic and turned ends come in pairs; the node that
/// would repeat the first one is not among the nodes, and there is one row more, for the cell that closes the circle.
/// [deBoor1978, Ch. XIII]
[[nodiscard]] Eigen::MatrixXd spline_coefficient_matrix(int nodes, SplineEnd first, SplineEnd last);

}  // namespace railtab
