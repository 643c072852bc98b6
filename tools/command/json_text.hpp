#pragma once

#include <nlohmann/json.hpp>

namespace railtab {

/// Writes a JSON object to standard output, members in their order, on one line: what is not finite as null, bytes that
/// are no UTF-8 as the replacement character, control characters escaped.
void print_json_line(const nlohmann::ordered_json& json);
/// The same over several lines, indented by two blanks.
void print_json(const nlohmann::ordered_json& json);

}  // namespace railtab
