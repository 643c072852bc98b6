#include "command/json_text.hpp"

#include <fmt/format.h>

#include <string>

#include "railtab/runtime/base/printable_text.hpp"
#include "railtab/runtime/base/process_end.hpp"

namespace railtab {

namespace {

std::string dumped(const nlohmann::ordered_json& json, int indent) {
  const std::string text = json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    if (const std::size_t bytes = printable_bytes(std::string_view(text).substr(i))) {
      result.append(text, i, bytes);
      i += bytes;
      continue;
    }
    // of valid UTF-8: DEL, or a C1 control character, whose second byte is its number
    if (text[i] == '\xC2') ++i;
    result += fmt::format("\\u{:04x}", static_cast<unsigned>(static_cast<unsigned char>(text[i++])));
  }
  return result + "\n";
}

}  // namespace

void print_json(const nlohmann::ordered_json& json) { print_text(dumped(json, 2)); }

void print_json_line(const nlohmann::ordered_json& json) {
  const std::string lines = dumped(json, 0);  // line feeds within texts are escaped
  std::string line;
  for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
    if (lines[i] != '\n') {
      line += lines[i];
    } else if (lines[i - 1] == ',') {
      line += ' ';
    }
  }
  print_text(line + "\n");
}

}  // namespace railtab
