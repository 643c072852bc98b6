#pragma once

namespace railtab {

enum class RailSide { left = 0, right = 1 };

}  // namespace railtab
