#pragma once

#include <string_view>

namespace railtab::report {

/// Style sheet and read-out script of the page, both inline: a report is one file and loads nothing.
[[nodiscard]] std::string_view page_style();
[[nodiscard]] std::string_view page_script();

}  // namespace railtab::report
