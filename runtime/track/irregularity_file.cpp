#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

#include "railtab/runtime/track/irregularity.hpp"
#include "railtab/tables/input_error.hpp"

namespace railtab {
namespace {

constexpr size_t columns = 5;
constexpr std::array<std::string_view, columns> column_names{"x", "y_left", "z_left", "y_right", "z_right"};

/// One line and where it stands.
struct Line {
  std::string place;  // "file:line"
  std::string_view text;
};

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blank = " \t\r";
  const size_t first = text.find_first_not_of(blank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

std::array<std::string_view, columns> split(const Line& line) {
  std::array<std::string_view, columns> cells;
  size_t count = 0;
  for (size_t begin = 0; begin <= line.text.size(); ++count) {
    const size_t end = std::min(line.text.find(',', begin), line.text.size());
    if (count < columns) cells[count] = trimmed(line.text.substr(begin, end - begin));
    begin = end + 1;
  }
  if (count == columns) return cells;
  throw input_error(line.place, fmt::format("{} columns", count), "5: x, y_left, z_left, y_right, z_right");
}

/// Factor to metres of one header cell, "y_left[mm]".
double unit_factor(const Line& line, std::string_view cell, std::string_view name) {
  const size_t bracket = cell.find('[');
  if (trimmed(cell.substr(0, bracket)) == name && bracket != std::string_view::npos) {
    const std::string_view unit = trimmed(cell.substr(bracket));
    if (unit == "[m]") return 1.0;
    if (unit == "[mm]") return 1e-3;
  }
  throw input_error(line.place, fmt::format("header '{}'", cell), fmt::format("'{0}[m]' or '{0}[mm]'", name));
}

double number(const Line& line, std::string_view cell, std::string_view name) {
  double value = 0;
  const char* const end = cell.data() + cell.size();
  const auto [stop, error] = std::from_chars(cell.data(), end, value);
  if (error == std::errc{} && stop == end && std::isfinite(value)) return value;
  throw input_error(line.place, fmt::format("'{}' in column {}", cell, name), "a finite number");
}

}  // namespace

Irregularity read_irregularity(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw input_error(file.string(), "no readable file", "a text file of track irregularity");

  std::array<double, columns> factor{};
  std::array<std::vector<double>, columns> data;
  bool has_header = false;
  std::string text;
  for (long number_of_line = 1; std::getline(stream, text); ++number_of_line) {
    const Line line{fmt::format("{}:{}", file.string(), number_of_line), trimmed(text)};
    if (line.text.empty() || line.text.front() == '#') continue;
    const std::array<std::string_view, columns> cells = split(line);
    if (!has_header) {
      for (size_t c = 0; c < columns; ++c) factor[c] = unit_factor(line, cells[c], column_names[c]);
      has_header = true;
      continue;
    }
    for (size_t c = 0; c < columns; ++c) data[c].push_back(factor[c] * number(line, cells[c], column_names[c]));
    const std::vector<double>& x = data[0];
    if (x.size() > 1 && !(x.back() > x[x.size() - 2])) {
      throw input_error(line.place, fmt::format("x = {} m", x.back()),
                        fmt::format("more than {} m of the point before", x[x.size() - 2]));
    }
  }
  if (stream.bad()) throw input_error(file.string(), "a read error", "a readable text file");
  if (data[0].size() < 2) {
    throw input_error(file.string(), fmt::format("{} points", data[0].size()), "a header row and at least 2 points");
  }
  return Irregularity(std::move(data[0]), std::move(data[1]), std::move(data[2]), std::move(data[3]),
                      std::move(data[4]));
}

}  // namespace railtab
