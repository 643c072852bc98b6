#pragma once

#include <string>
#include <vector>

#include "railtab/runtime/profile/profile_curve.hpp"

namespace railtab {

/// Lengths of the polygon through points, from 0. @throws InputError naming the point where two coincide
[[nodiscard]] std::vector<double> chord_lengths(const std::string& name, const std::vector<double>& y,
                                                const std::vector<double>& z);

/// Arc length at each knot of a curve, from 0.
[[nodiscard]] std::vector<double> arc_lengths(const ProfileCurve& curve);

}  // namespace railtab
