#pragma once

#include <vector>

#include "railtab/runtime/vehicle/vehicle_library.hpp"

namespace railtab {

/// The library of trains as it is compiled in, in no order: names of files without ".toml", and texts.
[[nodiscard]] const std::vector<LibraryFile>& train_library_files();

}  // namespace railtab
