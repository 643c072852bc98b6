#include "railtab/runtime/report/html_page.hpp"

#include <fmt/format.h>

#include "railtab/runtime/report/history_store.hpp"
#include "railtab/runtime/report/html_text.hpp"
#include "railtab/runtime/report/page_assets.hpp"

namespace railtab::report {
namespace {

/// A browser keeps to the policy: what is not inside the page is not loaded.
std::string page(std::string_view kind, std::string_view title, const std::string& styles, const std::string& main,
                 const std::string& scripts) {
  return html_first_line(kind) +
         fmt::format(
             "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><meta name=\"color-scheme\" "
             "content=\"light dark\"><meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
             "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">"
             "<title>{} – railtab</title><style>{}</style></head>\n"
             "<body>{}{}</body></html>\n",
             escaped(title), styles, main, scripts);
}

}  // namespace

std::string html_first_line(std::string_view kind) {
  return fmt::format(
      "<!DOCTYPE html><html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"generator\" "
      "content=\"railtab: {}\">\n",
      escaped(kind));
}

std::string html_page(std::string_view kind, std::string_view title, std::string_view body, std::string_view version) {
  return page(kind, title, std::string(page_style()),
              fmt::format("<main>{}<footer>railtab {}</footer></main>", body, escaped(version)),
              fmt::format("<script>{}</script>", readout_script()));
}

std::string live_html_page(std::string_view kind, std::string_view title, std::string_view body,
                           std::string_view version, const HistoryStore& histories, std::string_view script) {
  if (histories.empty()) return html_page(kind, title, body, version);
  const std::string foot = fmt::format(
      "<footer>railtab {}<details><summary>Licence of dygraphs, which draws the charts</summary><pre>{}</pre></details>"
      "</footer>",
      escaped(version), escaped(dygraphs_licence()));
  return page(kind, title, fmt::format("{}\n{}", dygraphs_style(), page_style()),
              fmt::format("<main class=\"wide\">{}{}</main>", body, foot),
              fmt::format("<script type=\"application/json\" id=\"histories\">{}</script>\n<script>{}</script>\n"
                          "<script>{}</script>\n<script>{}</script>",
                          histories.json(), dygraphs_script(), chart_script(), script));
}

std::string html_section(std::string_view title, const std::string& content) {
  return content.empty() ? "" : fmt::format("<section><h2>{}</h2>{}</section>", title, content);
}

std::string html_chart_section(std::string_view title, const std::string& charts) {
  return html_section(title, charts.empty() ? "" : fmt::format("<div class=\"charts\">{}</div>", charts));
}

}  // namespace railtab::report
