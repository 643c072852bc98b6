#include "csv_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/text_file.hpp"

namespace railtab::vsi {
namespace {

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t begin = 0;;) {
    const std::size_t comma = line.find(',', begin);
    fields.push_back(trimmed(line.substr(begin, comma - begin)));
    if (comma == std::string_view::npos) return fields;
    begin = comma + 1;
  }
}

/// Spreadsheets of many languages write semicolons.
void refuse_other_separator(std::string_view line, const std::string& place, const std::string& expected) {
  for (const auto& [separator, name] : {std::pair{';', "semicolons"}, {'\t', "tabs"}, {' ', "blanks"}}) {
    if (line.find(separator) == std::string_view::npos) continue;
    throw input_error(place, fmt::format("columns separated by {}", name), expected + ", separated by commas");
  }
}

/// For each field of the header, the index of its column.
std::vector<std::size_t> column_order(const std::vector<std::string_view>& header,
                                      const std::vector<std::string>& columns, const std::string& place) {
  const std::string expected = fmt::format("the columns {}", fmt::join(columns, ","));
  if (header.size() == 1) refuse_other_separator(header.front(), place, expected);
  std::vector<std::size_t> order;
  for (const std::string_view name : header) {
    const auto column = std::find(columns.begin(), columns.end(), name);
    if (column == columns.end()) throw input_error(place, fmt::format("column '{}'", name), expected);
    const auto index = static_cast<std::size_t>(column - columns.begin());
    if (std::find(order.begin(), order.end(), index) != order.end()) {
      throw input_error(place, fmt::format("column '{}' twice", name), expected);
    }
    order.push_back(index);
  }
  if (order.size() != columns.size()) throw input_error(place, fmt::format("{} columns", order.size()), expected);
  return order;
}

double number(std::string_view field, const std::string& place, const std::string& column) {
  double value = 0.0;
  const std::string_view digits = field.starts_with('+') ? field.substr(1) : field;
  const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (status != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value)) {
    throw input_error(place, fmt::format("'{}' in column {}", field, column), "a finite number");
  }
  return value;
}

}  // namespace

CsvTable read_csv(const std::filesystem::path& file, const std::vector<std::string>& columns) {
  if (!is_file(file)) throw input_error(file.string(), std::string(what_is_at(file)), "a CSV file");
  std::ifstream stream(file);
  CsvTable table;
  std::vector<std::size_t> order;
  std::string text;
  for (int line = 1; std::getline(stream, text); ++line) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (line == 1 && text.starts_with(byte_order_mark)) text.erase(0, byte_order_mark.size());
    const std::string_view content = trimmed(text);
    if (content.empty() || content.front() == '#') continue;
    const std::string place = fmt::format("{}:{}", file.string(), line);
    const std::vector<std::string_view> fields = fields_of(content);
    if (order.empty()) {
      order = column_order(fields, columns, place);
      continue;
    }
    if (fields.size() != order.size()) {
      throw input_error(place, fmt::format("{} fields", fields.size()), fmt::format("{} fields", order.size()));
    }
    std::vector<double> row(columns.size());
    for (std::size_t i = 0; i < fields.size(); ++i) row[order[i]] = number(fields[i], place, columns[order[i]]);
    table.rows.push_back(std::move(row));
    table.line.push_back(line);
  }
  if (table.rows.empty()) {
    throw input_error(file.string(), "no row of numbers", fmt::format("rows of {}", fmt::join(columns, ",")));
  }
  return table;
}

}  // namespace railtab::vsi
