#include "railtab/runtime/base/printable_text.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace railtab {

std::size_t printable_bytes(std::string_view text) noexcept {
  if (text.empty()) return 0;
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return (first >= 0x20 && first != 0x7F) || first == '\n' ? 1 : 0;
  const std::size_t bytes = first >= 0xC2 && first < 0xE0 ? 2 : first >= 0xE0 && first < 0xF0 ? 3 : 4;
  if (first < 0xC2 || first > 0xF4 || text.size() < bytes) return 0;
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
  }
  // C1 control characters are two bytes of UTF-8
  return first == 0xC2 && byte(1) < 0xA0 ? 0 : bytes;
}

std::string printable(std::string_view text) { return printable(text, std::string_view::npos); }

std::string printable(std::string_view text, std::size_t longest) {
  std::string result;
  bool whole = true;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t bytes = printable_bytes(text.substr(i));
    if (bytes == 0) whole = false;
    if (!whole && result.size() >= longest) {
      return result + (text.ends_with('\'') ? "…'" : "…");
    }
    result +=
        bytes == 0 ? fmt::format("\\x{:02X}", static_cast<unsigned char>(text[i])) : std::string(text.substr(i, bytes));
    i += std::max<std::size_t>(bytes, 1);
  }
  return result;
}

}  // namespace railtab
