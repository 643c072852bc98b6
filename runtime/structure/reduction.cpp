#include "railtab/runtime/structure/reduction.hpp"

#include "railtab/runtime/base/parameter_range.hpp"

namespace railtab {

std::string_view reduction_name(Reduction reduction) noexcept {
  return reduction == Reduction::window ? "window" : "none";
}

void ReductionParameters::validate() const {
  require_between("structure.window_ahead", ahead, 5.0, 1e5, "m");
  require_between("structure.window_behind", behind, 5.0, 1e5, "m");
}

}  // namespace railtab
