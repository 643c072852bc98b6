#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "railtab/tables/profile_knots.hpp"

namespace railtab {

/// Radius of the half-circle that is the head of the rail "knife-edge" [m]: small against every wheel's radii, large
/// enough for the rounding of a position (1e-17 m) to leave its curvature alone.
inline constexpr double knife_edge_radius = 1e-4;

/// Names of the built-in profiles of one kind that can form a pair, for messages and --help.
[[nodiscard]] std::vector<std::string> standard_profile_names(ProfileKind kind);

/// Whether a name is one of standard_profile_names(); case is ignored.
[[nodiscard]] bool is_standard_profile(ProfileKind kind, std::string_view name);

/// A built-in profile by name (case is ignored): wheels "S1002", "LMA-type", "cone-1:20", "cone-1:40",
/// "conic-arc-stand-in"; rails "60E1" (also "UIC60"), "CHN60", "JIS60-stand-in", and for tests of curves "knife-edge",
/// which is too narrow for the contact search. A name with "stand-in" is no standard's profile but has the main
/// dimensions of one whose drawing was not at hand. `rail_inclination` is the tangent of the inclination (1/40, 1/20,
/// 0) by which the rail head leans to the track centre, from 0 to 0.1; wheels and the knife-edge ignore it. Computed
/// from the segment definitions, each smooth segment splined by itself with its exact end tangents, so that curvature
/// may jump at the joints and nowhere else.
/// @throws InputError with the known names where the name is unknown.
[[nodiscard]] ProfileKnots standard_profile(ProfileKind kind, std::string_view name, double rail_inclination);

}  // namespace railtab
