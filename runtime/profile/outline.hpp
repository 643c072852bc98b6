#pragma once

#include <string>
#include <vector>

namespace railtab {

/// One point of a profile file, with the line that it stands on for messages.
struct OutlinePoint {
  double y, z;  ///< [m]
  int line;
};

/// Refuses points that are no outline of a body, naming file and line:
/// fewer than 4 points, an extent that is no wheel's or rail's, consecutive points less than 1 nm apart, points that
/// turn back by more than 120 degrees (wrong order, stitched scans), and an outline that crosses or touches itself.
/// @throws InputError
void check_outline(const std::string& file, const std::vector<OutlinePoint>& points);

}  // namespace railtab
