#include "railtab/runtime/base/column_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "railtab/runtime/base/column_rows.hpp"
#include "railtab/runtime/base/input_error.hpp"

namespace railtab {
namespace {

FileColumn header_column(const LineReader& reader, std::string_view cell, std::string_view example) {
  const std::size_t bracket = cell.find('[');
  if (bracket == std::string_view::npos || bracket == 0 || cell.back() != ']') {
    throw reader.error("header " + quoted(cell),
                       example.empty() ? "name[unit]" : fmt::format("name[unit], as in {}", example));
  }
  FileColumn column;
  column.name = std::string(stripped(cell.substr(0, bracket)));
  column.unit = std::string(stripped(cell.substr(bracket + 1, cell.size() - bracket - 2)));
  return column;
}

double number(std::string_view cell, const std::string& place) {
  double value = 0.0;
  if (!parse(cell, value)) throw input_error(place, quoted(cell), "a finite number");
  return value;
}

std::string place_of(const std::string& row, std::string_view column) {
  return fmt::format("{}: column {}", row, column);
}

void require_increase(const FileColumn& first) {
  const std::size_t rows = first.values.size();
  if (rows < 2 || first.values[rows - 1] > first.values[rows - 2]) return;
  throw input_error(first.place(rows), fmt::format("{}", first.values[rows - 1]),
                    fmt::format("more than {} of the row before", first.values[rows - 2]));
}

/// For each column of the file, the index of its name.
std::vector<std::size_t> column_order(const ColumnRows& file, const std::vector<std::string>& names) {
  const std::string expected = fmt::format("the columns {}, separated by commas", fmt::join(names, ","));
  const std::vector<std::string>& header = file.header();
  file.require_commas(expected);
  std::vector<std::size_t> order;
  for (const std::string& name : header) {
    const auto known = std::find(names.begin(), names.end(), name);
    if (known == names.end()) throw file.reader().error(fmt::format("column '{}'", name), expected);
    const auto index = static_cast<std::size_t>(known - names.begin());
    if (std::find(order.begin(), order.end(), index) != order.end()) {
      throw file.reader().error(fmt::format("column '{}' twice", name), expected);
    }
    order.push_back(index);
  }
  if (!order.empty() && order.size() != names.size()) {
    throw file.reader().error(fmt::format("{} columns", order.size()), expected);
  }
  return order;
}

}  // namespace

std::string FileColumn::place(std::size_t row) const { return place_of(fmt::format("{}:{}", file, line[row]), name); }

std::vector<FileColumn> read_columns(const std::filesystem::path& file, std::string_view example) {
  ColumnRows rows(file, "a text file with columns");
  rows.require_commas("columns separated by commas");
  std::vector<FileColumn> columns;
  for (const std::string& cell : rows.header()) {
    columns.push_back(header_column(rows.reader(), cell, example));
    columns.back().file = file.string();
    columns.back().line.push_back(rows.header_line());
  }
  while (rows.next()) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      FileColumn& column = columns[c];
      column.line.push_back(rows.reader().line_number());
      column.values.push_back(number(rows.cells()[c], column.place(column.line.size() - 1)));
    }
    require_increase(columns.front());
  }
  const std::size_t count = columns.empty() ? 0 : columns.front().values.size();
  if (count < 2) throw input_error(file.string(), fmt::format("{} rows", count), "a header row and at least 2 rows");
  return columns;
}

NumberRows read_number_rows(const std::filesystem::path& file, const std::vector<std::string>& columns) {
  ColumnRows rows(file, "a CSV file");
  const std::vector<std::size_t> order = column_order(rows, columns);
  NumberRows table;
  while (rows.next()) {
    std::vector<double> row(columns.size());
    for (std::size_t c = 0; c < order.size(); ++c) {
      row[order[c]] = number(rows.cells()[c], place_of(rows.reader().place(), columns[order[c]]));
    }
    table.rows.push_back(std::move(row));
    table.places.push_back(rows.reader().place());
  }
  if (table.rows.empty()) {
    throw input_error(file.string(), "no row of numbers", fmt::format("rows of {}", fmt::join(columns, ",")));
  }
  return table;
}

bool has_column(const std::filesystem::path& file, std::string_view name) {
  const ColumnRows rows(file, "a CSV file");
  return std::find(rows.header().begin(), rows.header().end(), name) != rows.header().end();
}

std::string names_of(const std::vector<FileColumn>& columns) {
  std::string names;
  for (const FileColumn& column : columns) {
    names += names.empty() ? "columns " : ", ";
    names += column.name;
  }
  return names;
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
