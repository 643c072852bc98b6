#include "railtab/runtime/base/column_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <system_error>
#include <utility>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/text_file.hpp"

namespace railtab {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blank = " \t\r";
  const std::size_t first = text.find_first_not_of(blank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

std::vector<std::string_view> cells_of(std::string_view text) {
  std::vector<std::string_view> cells;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    cells.push_back(trimmed(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  return cells;
}

/// In quotes, and no more than a message can take.
std::string quoted(std::string_view cell) {
  constexpr std::size_t longest = 40;
  std::size_t end = std::min(cell.size(), longest);
  while (end + 4 > longest && end < cell.size() && (static_cast<unsigned char>(cell[end]) & 0xC0U) == 0x80U)
    --end;  // of UTF-8
  return fmt::format("'{}{}'", cell.substr(0, end), end < cell.size() ? "…" : "");
}

/// Spreadsheets of many languages write semicolons.
void refuse_other_separator(std::string_view header, const std::string& place) {
  if (header.find(',') != std::string_view::npos) return;
  for (const auto& [separator, name] : {std::pair{"];", "semicolons"}, {"]\t", "tabs"}}) {
    if (header.find(separator) == std::string_view::npos) continue;
    throw input_error(place, fmt::format("columns separated by {}", name), "columns separated by commas");
  }
}

FileColumn header_column(const std::string& file, long line, std::string_view cell) {
  const std::size_t bracket = cell.find('[');
  if (bracket == std::string_view::npos || bracket == 0 || cell.back() != ']') {
    throw input_error(fmt::format("{}:{}", file, line), "header " + quoted(cell), "name[unit]");
  }
  FileColumn column;
  column.name = std::string(trimmed(cell.substr(0, bracket)));
  column.unit = std::string(trimmed(cell.substr(bracket + 1, cell.size() - bracket - 2)));
  column.file = file;
  column.line.push_back(line);
  return column;
}

void append_row(std::vector<FileColumn>& columns, const std::string& file, long line, std::string_view text) {
  const std::vector<std::string_view> cells = cells_of(text);
  if (cells.size() != columns.size()) {
    throw input_error(fmt::format("{}:{}", file, line), fmt::format("{} columns", cells.size()),
                      fmt::format("{}, as in the header", columns.size()));
  }
  for (std::size_t c = 0; c < cells.size(); ++c) {
    FileColumn& column = columns[c];
    column.line.push_back(line);
    double value = 0.0;
    const char* const end = cells[c].data() + cells[c].size();
    const auto [stop, status] = std::from_chars(cells[c].data(), end, value);
    if (status != std::errc{} || stop != end || !std::isfinite(value)) {
      throw input_error(column.place(column.values.size() + 1), quoted(cells[c]), "a finite number");
    }
    column.values.push_back(value);
  }
  const std::vector<double>& first = columns.front().values;
  if (first.size() > 1 && !(first.back() > first[first.size() - 2])) {
    throw input_error(columns.front().place(first.size()), fmt::format("{}", first.back()),
                      fmt::format("more than {} of the row before", first[first.size() - 2]));
  }
}

}  // namespace

std::string FileColumn::place(std::size_t row) const { return fmt::format("{}:{}: column {}", file, line[row], name); }

std::vector<FileColumn> read_columns(const std::filesystem::path& file) {
  constexpr std::string_view expected = "a text file with columns";
  if (!is_file(file)) throw input_error(file.string(), std::string(what_is_at(file)), std::string(expected));
  std::ifstream stream(file);
  if (!stream) throw input_error(file.string(), "no readable file", std::string(expected));
  std::vector<FileColumn> columns;
  std::string text;
  for (long line = 1; std::getline(stream, text); ++line) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";  // some spreadsheets begin a file with it
    if (line == 1 && text.starts_with(byte_order_mark)) text.erase(0, byte_order_mark.size());
    const std::string_view content = trimmed(text);
    if (content.empty() || content.front() == '#') continue;
    if (columns.empty()) {
      refuse_other_separator(content, fmt::format("{}:{}", file.string(), line));
      for (const std::string_view cell : cells_of(content)) {
        columns.push_back(header_column(file.string(), line, cell));
      }
    } else {
      append_row(columns, file.string(), line, content);
    }
  }
  if (stream.bad()) throw input_error(file.string(), "a read error", "a readable text file");
  const std::size_t rows = columns.empty() ? 0 : columns.front().values.size();
  if (rows < 2) throw input_error(file.string(), fmt::format("{} rows", rows), "a header row and at least 2 rows");
  return columns;
}

double factor_to_si(const FileColumn& column, const std::vector<UnitFactor>& units) {
  std::string known;
  for (const UnitFactor& u : units) {
    if (column.unit == u.unit) return u.factor;
    known += fmt::format("{}{}[{}]", known.empty() ? "" : ", ", column.name, u.unit);
  }
  throw input_error(column.place(0), fmt::format("unit [{}]", column.unit), known);
}

void require_magnitude(const FileColumn& column, double factor, double limit) {
  for (std::size_t i = 0; i < column.values.size(); ++i) {
    if (std::abs(factor * column.values[i]) <= limit) continue;
    throw input_error(column.place(i + 1), fmt::format("{} {}", column.values[i], column.unit),
                      fmt::format("-{0:g} to {0:g} {1}", limit / factor, column.unit));
  }
}

void require_argument(const FileColumn& column) {
  constexpr double furthest = 1e9, nearest = 1e-9;
  require_magnitude(column, 1.0, furthest);
  for (std::size_t i = 1; i < column.values.size(); ++i) {
    if (column.values[i] - column.values[i - 1] >= nearest) continue;
    throw input_error(column.place(i + 1), fmt::format("{}", column.values[i]),
                      fmt::format("at least {:g} more than {} of the row before", nearest, column.values[i - 1]));
  }
}

}  // namespace railtab
