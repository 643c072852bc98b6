#pragma once

#include <cstddef>

namespace railtab {

/// A number that is not negative as an index of a container.
[[nodiscard]] constexpr std::size_t index(int i) noexcept { return static_cast<std::size_t>(i); }

}  // namespace railtab
