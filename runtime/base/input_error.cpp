#include "railtab/runtime/base/input_error.hpp"

#include <fmt/format.h>

#include "railtab/runtime/base/printable_text.hpp"

namespace railtab {

InputError input_error(std::string_view place, std::string_view found, std::string_view expected) {
  constexpr std::size_t longest = 40;
  return InputError(fmt::format("{}: found {}, expected {}", printable(place), printable(found, longest), expected));
}

}  // namespace railtab
