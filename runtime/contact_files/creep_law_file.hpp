#pragma once

#include <filesystem>
#include <string_view>

#include "railtab/runtime/contact/creep_law.hpp"

namespace railtab {

/// "linear", "polach", "fastsim", or "table", which reads `table` (the shipped one where it is empty).
/// @throws InputError with the known names; where the table cannot be read or is for another Poisson's ratio.
[[nodiscard]] CreepLaw creep_law(std::string_view name, double nu, const std::filesystem::path& table = {});

}  // namespace railtab
