#pragma once

#include <fmt/format.h>

#include <utility>

#include "railtab/runtime/base/process_end.hpp"

namespace railtab {

/// To standard output as fmt::print, with what is not printable in texts from files escaped.
template <class... Values>
void print_formatted(fmt::format_string<Values...> format, Values&&... values) {
  print_text(fmt::format(format, std::forward<Values>(values)...));
}

}  // namespace railtab
