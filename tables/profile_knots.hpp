#pragma once

#include <string>
#include <vector>

namespace railtab {

enum class ProfileKind { wheel, rail };

/// A wheel or rail profile as it is stored in a table: the knots of a piecewise cubic Hermite curve
/// (y(s), z(s)) over arc length s [m], y to the field side, z down, right side of the track.
///
/// Wheel: origin at the tape circle, z = 0 at nominal radius, flange at y < 0.
/// Rail: origin at the highest point of the inclined head, gauge side at y < 0.
/// Knots run from the track centre to the field side; s is strictly increasing from s[0].
/// Slopes are stored, so that a curve read back is the written one to the last bit.
struct ProfileKnots {
  ProfileKind kind = ProfileKind::wheel;
  std::string name;            ///< built-in name or file name
  std::vector<double> s;       ///< arc length [m]
  std::vector<double> y, z;    ///< position [m]
  std::vector<double> dy, dz;  ///< dy/ds, dz/ds [-]
  /// What was done to the points of a profile file when it was read, for the user; part of the provenance.
  std::vector<std::string> notes = {};
  std::string inclination = {};  ///< of a built-in rail, "1:40" or "upright"; empty: that of the points of its file
};

/// "S1002", "60E1 1:40".
[[nodiscard]] inline std::string profile_in_words(const ProfileKnots& profile) {
  return profile.inclination.empty() ? profile.name : profile.name + " " + profile.inclination;
}

}  // namespace railtab
