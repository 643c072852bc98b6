#pragma once

#include <array>
#include <string_view>

namespace railtab {

/// Of a body's or node's degrees of freedom, in the order of DofIndices.
inline constexpr std::array<std::string_view, 6> motion_names{"x", "y", "z", "roll", "pitch", "yaw"};
inline constexpr int x_dof = 0, y_dof = 1, z_dof = 2, roll_dof = 3, pitch_dof = 4, yaw_dof = 5;

}  // namespace railtab
