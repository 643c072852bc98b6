#pragma once

#include <filesystem>
#include <string>

#include "railtab/tables/profile_knots.hpp"

namespace railtab {

/// Origin of a rail profile that is read from a file.
enum class RailOrigin {
  highest_point,  ///< moved to the highest point of the head
  of_file,        ///< kept, where a file states its place on the track: [EN15302], 750 mm from the track centre
};

/// Read a profile from a file: SIMPACK .prw/.prr (header keys for units, mirror, shift, rotation, bounds and
/// inversion are obeyed in the format's order 1-7), MiniProf .whl/.ban, or any other extension as two columns y z, with
/// a line of units ("# units: mm" or "# units: m") or a width that only one of them fits. Right side of the track, y to
/// the field side, z down; points along the outline in either direction.
///
/// Faults of measured profiles are repaired where that is safe, and the knots' notes say so: repeated points, small
/// steps back of stitched scans, z up, a wheel's y to the track centre, a gauge face not measured deep enough.
/// A wheel keeps its origin, the tape circle. The name is that of the file without its folder.
/// @param noise standard deviation of the points normal to the outline [m]: smoothing_spline(). 0: the curve goes
/// through the points, spline_through_points()
/// @throws InputError with file and line: missing file, wrong kind, non-numeric field, fewer than 4 points, points that
///         go back or cross the curve; with the file: extents or axes of no such profile.
[[nodiscard]] ProfileKnots read_profile_file(const std::filesystem::path& file, ProfileKind kind, double noise = 0.0,
                                             RailOrigin origin = RailOrigin::highest_point);

/// A built-in name or a file: what the commands accept for --wheel and --rail. A rail from a file is
/// already inclined, as SIMPACK and CONTACT take it. `noise` and `origin` are for files, as in read_profile_file(); a
/// built-in rail has its origin at its highest point.
/// @throws InputError
[[nodiscard]] ProfileKnots load_profile(const std::string& name_or_file, ProfileKind kind, double rail_inclination,
                                        double noise = 0.0, RailOrigin origin = RailOrigin::highest_point);

/// C2 cubic spline through points in arc length (chord lengths, corrected once for the arc), natural at the ends.
/// @throws InputError naming the point where consecutive points coincide.
[[nodiscard]] ProfileKnots spline_through_points(ProfileKind kind, std::string name, const std::vector<double>& y,
                                                 const std::vector<double>& z);

/// A curve near points, and how far it passes from them.
struct SmoothedProfile {
  ProfileKnots knots;             ///< one per point
  double rms_distance = 0.0;      ///< of the points from the curve, normal to it [m]
  double largest_distance = 0.0;  ///< the same, of the farthest [m]
};

/// The smoothest curve that the points' noise allows: the natural cubic spline in arc length that minimises
/// Σ|p_i − r(s_i)|² + λ∫|r''|² ds [Reinsch1967], with λ such that the root mean square distance of the points from the
/// curve, normal to it, is `noise` [m] (discrepancy principle). Curvature that changes within a few points is rounded.
/// @throws InputError where noise is not in (0, 1e-3], or no λ leaves so much (the points lie on a line within it)
[[nodiscard]] SmoothedProfile smoothing_spline(ProfileKind kind, std::string name, const std::vector<double>& y,
                                               const std::vector<double>& z, double noise);

}  // namespace railtab
