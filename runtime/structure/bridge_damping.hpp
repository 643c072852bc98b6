#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace railtab {

/// Kinds of bridges that EN 1991-2 knows lower bounds of damping for: "steel-composite", "prestressed-concrete",
/// "reinforced-concrete" (and filler beams).
[[nodiscard]] std::vector<std::string> bridge_damping_types();

/// Lower bound of the damping ratio of a bridge of a type and span [m] [EN1991-2, Table 6.6]: 0.5, 1.0 or 1.5 % from 20
/// m on, and for shorter spans 0.125, 0.07 or 0.07 % more per metre below.
/// @throws InputError naming `key` where the type is unknown or the span is not positive
[[nodiscard]] double damping_lower_bound(std::string_view key, std::string_view type, double span);

}  // namespace railtab
