#pragma once

namespace railtab {

/// The version of railtab, as tools/print_version prints it: "0.1.0", or with the commit.
[[nodiscard]] const char* version() noexcept;

}  // namespace railtab
