#include "railtab/runtime/report/html_page.hpp"

#include <fmt/format.h>

#include "railtab/runtime/report/html_text.hpp"
#include "railtab/runtime/report/page_assets.hpp"

namespace railtab::report {

std::string html_first_line(std::string_view kind) {
  return fmt::format(
      "<!DOCTYPE html><html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"generator\" "
      "content=\"railtab: {}\">\n",
      escaped(kind));
}

std::string html_page(std::string_view kind, std::string_view title, std::string_view body, std::string_view version) {
  return html_first_line(kind) +
         fmt::format(
             "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><title>{} – "
             "railtab</title><style>{}</style></head>\n"
             "<body><main>{}<footer>railtab {}</footer></main><script>{}</script></body></html>\n",
             escaped(title), page_style(), body, escaped(version), page_script());
}

std::string html_section(std::string_view title, const std::string& content) {
  return content.empty() ? "" : fmt::format("<section><h2>{}</h2>{}</section>", title, content);
}

}  // namespace railtab::report
