#pragma once

#include <string>

#include "railtab/runtime/profile/outline.hpp"
#include "railtab/tables/profile_knots.hpp"

namespace railtab {

/// Brings points of either direction, side and sign into the frame of a right wheel or rail, as far as the shape tells
/// for sure, with a note for each change: from the track centre to the field side; z down; a wheel's flange at y < 0.
/// A wheel's rim faces, steeper than 80 degrees at the outline's ends, are no flange. A rail's side does not show in
/// its shape; a head that leans to the field side gets a note. A gauge face that was measured to at least 10 mm below
/// the top, where it stands at more than 60 degrees, is continued to 17 mm: where its last 3 mm are an arc of 8 to 25
/// mm, along that arc until it is vertical, else straight.
/// @throws InputError with file: a wheel that does not contain y = 0, a rail whose top is one of its ends
void orient(const std::string& file, ProfileKind kind, ProfilePoints& outline);

/// Moves the origin to the highest point, where rail profiles have it. @throws InputError
void centre_rail(const std::string& file, ProfileKnots& knots);

}  // namespace railtab
