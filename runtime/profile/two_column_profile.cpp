#include "railtab/runtime/profile/two_column_profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <string_view>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/profile/profile_text.hpp"

namespace railtab {

namespace {

/// Metres per unit of a comment "units: mm" or "units: m"; nothing where the comment is about something else.
std::optional<double> units_of(std::string_view comment, const std::string& place) {
  std::string text(trimmed(comment));
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (!text.starts_with("units")) return std::nullopt;
  const std::size_t colon = text.find(':');
  const std::string_view unit = colon == std::string::npos ? "" : trimmed(std::string_view(text).substr(colon + 1));
  if (unit == "mm") return 1e-3;
  if (unit == "m") return 1.0;
  throw input_error(place, fmt::format("\"{}\"", trimmed(comment)), "\"units: mm\" or \"units: m\"");
}

}  // namespace

void infer_units(const std::string& file, ProfilePoints& outline) {
  std::vector<OutlinePoint>& points = outline.points;
  if (points.empty()) return;
  const auto [low, high] =
      std::minmax_element(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.y < b.y; });
  const double width = high->y - low->y;
  const bool millimetres = width >= 5.0 && width <= 500.0;
  if (!millimetres && !(width >= 0.005 && width <= 0.5)) {
    throw input_error(file, fmt::format("no line \"# units: ...\" and a width of {:.6g}", width),
                      "units, or a width from 5 to 500 (mm) or 0.005 to 0.5 (m)");
  }
  if (millimetres) {
    for (OutlinePoint& p : points) {
      p.y *= 1e-3;
      p.z *= 1e-3;
    }
  }
  outline.notes.push_back(
      fmt::format("{}: no units, taken as {} from the width of {:.6g}", file, millimetres ? "mm" : "m", width));
}

ProfilePoints read_two_columns(std::istream& in, const std::string& file) {
  ProfileText text{in, file, 0};
  std::optional<double> unit;
  ProfilePoints outline;
  while (const std::optional<std::string> line = text.next()) {
    const std::size_t comment = line->find_first_of("#!");
    if (comment != std::string::npos && !unit) {
      unit = units_of(std::string_view(*line).substr(comment + 1), text.place());
      if (unit && !outline.points.empty()) {
        throw input_error(text.place(), "units after the first point", "a line \"# units: ...\" before all points");
      }
    }
    const std::string_view content = trimmed(std::string_view(*line).substr(0, comment));
    if (content.empty()) continue;
    const std::vector<std::string_view> field = fields(content);
    const std::string place = text.place();
    if (field.size() != 2)
      throw input_error(place, fmt::format("\"{}\"", content), expected_numbers(content, "two numbers y z"));
    const double y = number(field[0], place, "a number for y");
    const double z = number(field[1], place, "a number for z");
    const double scale = unit.value_or(1.0);
    outline.points.push_back({y * scale, z * scale, text.line});
  }
  if (!unit) infer_units(file, outline);
  return outline;
}

}  // namespace railtab
