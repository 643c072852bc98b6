#include "railtab/runtime/profile/miniprof_profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "railtab/runtime/base/constants.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/profile/profile_text.hpp"

namespace railtab {

namespace {

constexpr std::array<std::string_view, 6> header_keys{"ColumnDef", "XOffset", "Xoffset",
                                                      "YOffset",   "Yoffset", "XYPoints"};

/// The entries of the header that are used.
struct MiniprofHeader {
  std::size_t columns = 0;  ///< per line; 0: not stated
  std::size_t x = 0, y = 1;
  double x_offset = 0.0, y_offset = 0.0;  ///< [mm]
  std::optional<double> points;

  void set(std::string_view key, std::string_view value, const std::string& place);
};

/// "X,Y,A,C": one letter per column.
void set_columns(MiniprofHeader& header, std::string_view value, const std::string& place) {
  const std::vector<std::string_view> letter = fields(value);
  const auto column = [&](std::string_view name) {
    const auto found = std::find(letter.begin(), letter.end(), name);
    if (found == letter.end()) {
      throw input_error(place, fmt::format("ColumnDef={}", value), "letters between commas, X and Y among them");
    }
    return static_cast<std::size_t>(found - letter.begin());
  };
  header.x = column("X");
  header.y = column("Y");
  header.columns = letter.size();
}

void MiniprofHeader::set(std::string_view key, std::string_view value, const std::string& place) {
  const auto value_of = [&] { return number(value, place, fmt::format("a number for {}", key)); };
  if (key == "ColumnDef") set_columns(*this, value, place);
  if (key == "XOffset" || key == "Xoffset") x_offset = value_of();
  if (key == "YOffset" || key == "Yoffset") y_offset = value_of();
  if (key == "XYPoints") points = value_of();
}

OutlinePoint point_of(const MiniprofHeader& header, std::string_view content, const ProfileText& text) {
  const std::vector<std::string_view> field = fields(content);
  const bool fits = header.columns > 0 ? field.size() == header.columns : field.size() >= 2;
  if (!fits) {
    throw input_error(text.place(), fmt::format("\"{}\"", content),
                      header.columns > 0
                          ? expected_numbers(content, fmt::format("{} numbers as ColumnDef says", header.columns))
                          : std::string("at least two numbers X Y"));
  }
  return {(number(field[header.x], text.place(), "a number for X") + header.x_offset) * mm,
          (number(field[header.y], text.place(), "a number for Y") + header.y_offset) * mm, text.line};
}

}  // namespace

ProfilePoints read_miniprof(std::istream& in, const std::string& file, ProfileKind kind) {
  ProfileText text{in, file, 0};
  MiniprofHeader header;
  ProfilePoints outline;
  while (const std::optional<std::string> line = text.next()) {
    const std::string_view content = trimmed(*line);
    if (content.empty() || std::string_view("!\"%#").find(content.front()) != std::string_view::npos) continue;
    if (const std::size_t equals = content.find('='); equals != std::string_view::npos) {
      if (!outline.points.empty()) {
        throw input_error(text.place(), fmt::format("\"{}\" after the first point", content), "a point");
      }
      const std::string_view key = trimmed(content.substr(0, equals)), value = trimmed(content.substr(equals + 1));
      if (value.empty()) continue;
      header.set(key, value, text.place());
      if (std::string note = note_of_case(text, key, header_keys); !note.empty())
        outline.notes.push_back(std::move(note));
      continue;
    }
    outline.points.push_back(point_of(header, content, text));
  }
  if (header.points && *header.points != static_cast<double>(outline.points.size())) {
    outline.notes.push_back(
        fmt::format("{}: {} points, where XYPoints says {}", file, outline.points.size(), *header.points));
  }
  if (kind == ProfileKind::rail) {
    for (OutlinePoint& p : outline.points) p.y = -p.y;
    outline.notes.push_back(file + ": y = -X, since MiniProf rails have their gauge side at positive X");
  }
  return outline;
}

}  // namespace railtab
