#include "json_object.hpp"

#include <fmt/format.h>

#include <cmath>

namespace railtab::vsi {
namespace {

std::string in_quotes(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      result += '\\';
      result += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      result += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      result += c;
    }
  }
  return result + "\"";
}

std::string number_text(double value) { return std::isfinite(value) ? fmt::format("{}", value) : "null"; }

}  // namespace

JsonObject& JsonObject::add_raw(std::string_view name, std::string_view value) {
  if (!members_.empty()) members_ += ", ";
  members_ += in_quotes(name) + ": " + std::string(value);
  return *this;
}

JsonObject& JsonObject::add(std::string_view name, double value) { return add_raw(name, number_text(value)); }
JsonObject& JsonObject::add(std::string_view name, long value) { return add_raw(name, std::to_string(value)); }
JsonObject& JsonObject::add(std::string_view name, bool value) { return add_raw(name, value ? "true" : "false"); }
JsonObject& JsonObject::add(std::string_view name, std::string_view value) { return add_raw(name, in_quotes(value)); }
JsonObject& JsonObject::add(std::string_view name, const JsonObject& value) { return add_raw(name, value.text()); }
JsonObject& JsonObject::add(std::string_view name, const std::vector<std::string>& values) {
  std::string list;
  for (const std::string& value : values) list += (list.empty() ? "" : ", ") + in_quotes(value);
  return add_raw(name, "[" + list + "]");
}
JsonObject& JsonObject::add(std::string_view name, const std::vector<double>& values) {
  std::string list;
  for (double value : values) list += (list.empty() ? "" : ", ") + number_text(value);
  return add_raw(name, "[" + list + "]");
}

}  // namespace railtab::vsi
