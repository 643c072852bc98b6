#pragma once

#include <array>
#include <string_view>

namespace railtab {

/// Of a body's or node's degrees of freedom, in the order of DofIndices.
inline constexpr std::array<std::string_view, 6> motion_names{"x", "y", "z", "roll", "pitch", "yaw"};

}  // namespace railtab
