#pragma once

#include <filesystem>
#include <string>

#include "railtab/tables/profile_knots.hpp"

namespace railtab {

/// Read a profile from a file: SIMPACK .prw/.prr (header keys for units, mirror, shift, rotation, bounds and
/// inversion are obeyed in the format's order 1-7), or any other extension as two columns y z with a units line
/// ("# units: mm" or "# units: m").
/// @throws InputError with file and line: missing file, wrong kind, no units, non-numeric field, fewer than 4 points,
///         repeated points, points that go back or cross the curve.
[[nodiscard]] ProfileKnots read_profile_file(const std::filesystem::path& file, ProfileKind kind);

/// A built-in name or a file: what the commands accept for --wheel and --rail. A rail from a file is taken as it
/// stands (already inclined), as SIMPACK and CONTACT do.
/// @throws InputError
[[nodiscard]] ProfileKnots load_profile(const std::string& name_or_file, ProfileKind kind, double rail_inclination);

/// C2 cubic spline through points in arc length (chord lengths, corrected once for the arc), natural at the ends.
/// @throws InputError naming the point where consecutive points coincide.
[[nodiscard]] ProfileKnots spline_through_points(ProfileKind kind, std::string name, const std::vector<double>& y,
                                                 const std::vector<double>& z);

}  // namespace railtab
