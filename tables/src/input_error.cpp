#include "railtab/tables/input_error.hpp"

#include <fmt/format.h>

namespace railtab {

InputError input_error(std::string_view place, std::string_view found, std::string_view expected) {
  return InputError(fmt::format("{}: found {}, expected {}", place, found, expected));
}

}  // namespace railtab
