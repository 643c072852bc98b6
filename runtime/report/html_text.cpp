#include "railtab/runtime/report/html_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "railtab/runtime/base/printable_text.hpp"

namespace railtab::report {

std::string escaped(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t bytes = text[i] == '\t' ? 1 : printable_bytes(text.substr(i));
    switch (bytes == 1 ? text[i] : '\0') {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        result += bytes > 0 ? std::string(text.substr(i, bytes)) : printable(text.substr(i, 1));
    }
    i += std::max<std::size_t>(bytes, 1);
  }
  return result;
}

std::string shown(double value, int digits) {
  if (!std::isfinite(value)) return "–";
  if (value == 0.0) return "0";
  const double size = std::abs(value);
  std::string text;
  if (size < 1e-4 || size >= 1e7) {
    text = fmt::format("{:.{}e}", value, digits - 1);
  } else {
    const int decimals = std::max(0, digits - 1 - static_cast<int>(std::floor(std::log10(size))));
    text = fmt::format("{:.{}f}", value, decimals);
  }
  if (text.front() == '-') text.replace(0, 1, "−");
  return text;
}

}  // namespace railtab::report
