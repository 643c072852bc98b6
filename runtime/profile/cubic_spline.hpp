#pragma once

#include <vector>

namespace railtab {

/// Slopes dv/ds at the knots of the C2 cubic spline through (s, v) whose end slopes are given.
/// @param s strictly increasing, at least 2 values
/// @param v as many values as `s`
[[nodiscard]] std::vector<double> clamped_spline_slopes(const std::vector<double>& s, const std::vector<double>& v,
                                                        double slope_begin, double slope_end);

/// The same with vanishing second derivatives at both ends (natural spline).
[[nodiscard]] std::vector<double> natural_spline_slopes(const std::vector<double>& s, const std::vector<double>& v);

}  // namespace railtab
