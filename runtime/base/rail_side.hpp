#pragma once

namespace railtab {

enum class RailSide { left = 0, right = 1 };

[[nodiscard]] constexpr RailSide opposite(RailSide side) noexcept {
  return side == RailSide::left ? RailSide::right : RailSide::left;
}

}  // namespace railtab
