#pragma once

#include <filesystem>
#include <string>

#include "railtab/tables/profile_knots.hpp"

namespace railtab {

/// Read a profile from a file: SIMPACK .prw/.prr (header keys for units, mirror, shift, rotation, bounds and
/// inversion are obeyed in the format's order 1-7), or any other extension as two columns y z with a units line
/// ("# units: mm" or "# units: m"). Right side of the track, y to the field side, z down; points along the outline in
/// either direction. Through the points goes spline_through_points(). A wheel keeps its origin, the tape circle; the
/// origin of a rail is moved to its highest point. The name is that of the file without its folder.
/// @throws InputError with file and line: missing file, wrong kind, no units, non-numeric field, fewer than 4 points,
///         repeated points, points that go back or cross the curve; with the file: extents or axes of no such profile.
[[nodiscard]] ProfileKnots read_profile_file(const std::filesystem::path& file, ProfileKind kind);

/// A built-in name or a file: what the commands accept for --wheel and --rail. A rail from a file is
/// already inclined, as SIMPACK and CONTACT take it.
/// @throws InputError
[[nodiscard]] ProfileKnots load_profile(const std::string& name_or_file, ProfileKind kind, double rail_inclination);

/// C2 cubic spline through points in arc length (chord lengths, corrected once for the arc), natural at the ends.
/// @throws InputError naming the point where consecutive points coincide.
[[nodiscard]] ProfileKnots spline_through_points(ProfileKind kind, std::string name, const std::vector<double>& y,
                                                 const std::vector<double>& z);

}  // namespace railtab
