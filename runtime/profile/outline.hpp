#pragma once

#include <string>
#include <vector>

#include "railtab/tables/profile_knots.hpp"

namespace railtab {

/// One point of a profile file, with the line that it stands on for messages.
struct OutlinePoint {
  double y, z;  ///< [m]
  int line;
};

/// The points of a profile file in m, with notes for the user on repairs.
struct ProfilePoints {
  std::vector<OutlinePoint> points;
  std::vector<std::string> notes;
};

/// Rejects points that are no outline of a body, naming file and line: fewer than 4 points, an extent that is no
/// wheel's or rail's, points that turn back by more than 120 degrees (wrong order), and an outline that crosses or
/// touches itself. Points that follow each other lie apart.
/// @throws InputError
void check_outline(const std::string& file, ProfileKind kind, const std::vector<OutlinePoint>& points);

/// Removes what measured outlines have too much of, with a note for each kind:
/// - points that repeat the one before within 1 nm;
/// - points that step back along the outline, as where two scans were stitched together, where this is safe: at most
///   2 mm back and within 0.1 mm of the line that the outline had, and at most a tenth of all points.
/// @throws InputError with file and line where points step back by more
void repair_outline(const std::string& file, ProfilePoints& outline);

}  // namespace railtab
