#pragma once

#include <istream>
#include <string>

#include "railtab/runtime/profile/outline.hpp"

namespace railtab {

/// Points of a file of two columns y z in m. Comments begin with # or !; one of them may state the units,
/// "units: mm" or "units: m", before the first point. Without one the width decides: wheels and rails are
/// between 5 and 500 mm wide, so that only one unit fits.
/// @throws InputError with file and line
[[nodiscard]] ProfilePoints read_two_columns(std::istream& in, const std::string& file);

/// Scales points by the unit, mm or m, in which they are as wide as a profile, and notes it.
/// @throws InputError with file where neither fits
void infer_units(const std::string& file, ProfilePoints& outline);

}  // namespace railtab
