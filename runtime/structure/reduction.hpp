#pragma once

#include <string_view>

namespace railtab {

enum class Reduction { none, window };
/// "none", "window"
[[nodiscard]] std::string_view reduction_name(Reduction reduction) noexcept;

/// How the number of active degrees of freedom of a structure is reduced.
struct ReductionParameters {
  Reduction kind = Reduction::none;
  double ahead = 20.0;   ///< window: track before the first wheelset and its span [m]
  double behind = 20.0;  ///< window: track behind the last wheelset and its span [m]
};

}  // namespace railtab
