#pragma once

#include <istream>
#include <string>

#include "railtab/runtime/profile/outline.hpp"
#include "railtab/tables/profile_knots.hpp"

namespace railtab {

/// Points of a SIMPACK .prw/.prr file in m, after the file's own processing options in the format's order:
/// 1 point.dist.min, 2 shift.y/.z, 3 rotate, 4 bound.y/.z, 5 mirror.y/.z, 6 inversion, 7 units. Keys that are one of
/// these but for their case get a note.
/// @throws InputError with file and line
[[nodiscard]] ProfilePoints read_simpack(std::istream& in, const std::string& file, ProfileKind kind);

}  // namespace railtab
