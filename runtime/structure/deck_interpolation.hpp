#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "railtab/runtime/structure/deck_channels.hpp"
#include "railtab/runtime/structure/fe_structure.hpp"

namespace railtab {

/// Motion k of a node, x to yaw; of an expanded one the mean over its rows, of a shell's three (bottom, middle, top)
/// that over its thickness by Simpson's rule; of one that is held that of its support. Empty where it is at rest.
[[nodiscard]] DofSum node_motion(const FeNode& node, std::size_t k);

/// Vertical displacement of a deck's surface at (x, y), by the straight line or the smallest triangle of nodes around
/// it: at a node its own. None where no such nodes are near.
using SurfaceMotion = std::function<std::optional<DofSum>(double x, double y)>;
[[nodiscard]] SurfaceMotion surface_motion(const FeStructure& structure, const std::vector<int>& deck);

/// Slopes of that displacement over 0.75 m to both sides of (x, y), the half width of a track; over what there is of it
/// within the deck. Roll = dz/dy, pitch = −dz/dx. None where there are no nodes to either side.
struct SurfaceSlopes {
  std::optional<DofSum> roll, pitch;
};
[[nodiscard]] SurfaceSlopes surface_slopes(const SurfaceMotion& motion, double x, double y);

}  // namespace railtab
