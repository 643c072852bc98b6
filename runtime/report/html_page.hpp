#pragma once

#include <string>
#include <string_view>

namespace railtab::report {

class HistoryStore;

/// The first line of a page, which names railtab as its generator and tells one kind of page from another.
/// @param kind plain text, "run report"
[[nodiscard]] std::string html_first_line(std::string_view kind);

/// A whole HTML page with style and read-out script inside: one file that loads nothing.
/// @param kind see html_first_line(); @param title plain text; @param body HTML
/// @param version of the program, for the foot of the page
[[nodiscard]] std::string html_page(std::string_view kind, std::string_view title, std::string_view body,
                                    std::string_view version);

/// The same with charts that are drawn live from `histories`, and a script of the page's own after that of the charts.
[[nodiscard]] std::string live_html_page(std::string_view kind, std::string_view title, std::string_view body,
                                         std::string_view version, const HistoryStore& histories,
                                         std::string_view script);

/// A section with its heading; empty where `content` is.
[[nodiscard]] std::string html_section(std::string_view title, const std::string& content);
/// The same for charts, side by side where the screen is wide.
[[nodiscard]] std::string html_chart_section(std::string_view title, const std::string& charts);

}  // namespace railtab::report
