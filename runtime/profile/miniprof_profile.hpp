#pragma once

#include <istream>
#include <string>

#include "railtab/runtime/profile/outline.hpp"
#include "railtab/tables/profile_knots.hpp"

namespace railtab {

/// Points of a MiniProf .whl (wheel) or .ban (rail) file in m: lines "Key=value", an empty line, then columns in mm as
/// ColumnDef names them (letters X, Y, A, C, N, K; X and Y without it). XOffset and YOffset are added; lines that
/// begin with ! " % or # are comments. MiniProf rails have their gauge side at positive X: y = -X. The signs of a
/// wheel, and the vertical axis, differ between files and are left to the shape.
/// @throws InputError with file and line
[[nodiscard]] ProfilePoints read_miniprof(std::istream& in, const std::string& file, ProfileKind kind);

}  // namespace railtab
