#pragma once

#include <array>

namespace railtab {

/// Order of a body's or node's degrees of freedom: x, y, z, roll, pitch, yaw.
using DofIndices = std::array<int, 6>;
inline constexpr int held = -1;  ///< a degree of freedom that is not an unknown

/// In which motions unknowns are built: all six of a body or node, or those within the vertical plane alone (x, z,
/// pitch), which is the same where nothing acts or stands out of that plane.
enum class MotionPlane { spatial, vertical };

}  // namespace railtab
