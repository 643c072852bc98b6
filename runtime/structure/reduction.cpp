#include "railtab/runtime/structure/reduction.hpp"

namespace railtab {

std::string_view reduction_name(Reduction reduction) noexcept {
  return reduction == Reduction::window ? "window" : "none";
}

}  // namespace railtab
