#pragma once

#include <filesystem>

namespace railtab {

/// The creep table that comes with railtab, for Poisson's ratio 0.28: in the folder RAILTAB_DATA_DIR of the
/// environment, in share/railtab beside the running program's bin, where railtab was installed, or in the source tree,
/// in that order. @throws InputError where it is in none of them.
[[nodiscard]] std::filesystem::path shipped_creep_table();

}  // namespace railtab
