#pragma once

#include <string_view>

namespace railtab::report {

/// What a page carries inside, so that it is one file and loads nothing. The texts of assets/ and of dygraphs, put into
/// the program when it is built.
[[nodiscard]] std::string_view page_style();
/// Values under the pointer, read back from the static lines of a chart.
[[nodiscard]] std::string_view readout_script();
/// Charts that are drawn from stored histories: needs dygraphs_script() before it.
[[nodiscard]] std::string_view chart_script();
[[nodiscard]] std::string_view dygraphs_script();
[[nodiscard]] std::string_view dygraphs_style();
[[nodiscard]] std::string_view dygraphs_licence();

}  // namespace railtab::report
