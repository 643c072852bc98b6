#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <span>
#include <utility>

#include "railtab/runtime/base/column_rows.hpp"
#include "railtab/runtime/fe/fe_files.hpp"

namespace railtab {

namespace {

constexpr std::array<std::string_view, 6> ansys_labels{"UX", "UY", "UZ", "ROTX", "ROTY", "ROTZ"};
constexpr std::array<std::string_view, 6> motions{"X", "Y", "Z", "ROTX", "ROTY", "ROTZ"};

using NumberedRow = std::pair<int, FeRow>;  // row of the matrices, from 1

NumberedRow numbered_row(const LineReader& reader, std::span<const std::string_view> words,
                         const std::array<std::string_view, 6>& names) {
  const int number = reader.number<int>(words[0], "the number of a row");
  FeRow row;
  row.line = reader.line_number();
  row.node = reader.number<int>(words[1], "the number of a node");
  const std::string label = upper_case(words[2]);
  const auto* const known = std::find(names.begin(), names.end(), label);
  if (known == names.end()) {
    throw reader.error(fmt::format("'{}'", words[2]),
                       fmt::format("{}: a structure has no other motions", fmt::join(names, ", ")));
  }
  row.motion = static_cast<int>(known - names.begin());
  return {number, row};
}

std::vector<FeRow> in_order(const LineReader& reader, std::vector<NumberedRow>& rows) {
  std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<FeRow> result;
  for (const auto& [number, row] : rows) {
    const int expected = static_cast<int>(result.size()) + 1;
    if (number != expected) {
      const bool twice = number < expected;
      throw input_error(reader.place(twice ? row.line : 0),
                        fmt::format("row {} {}", twice ? number : expected, twice ? "again" : "missing"),
                        "each row of the matrices once");
    }
    result.push_back(row);
  }
  if (result.empty()) throw reader.file_error("no row", "one line for each row of the matrices");
  return result;
}

}  // namespace

std::vector<FeRow> read_ansys_rows(const std::filesystem::path& file) {
  LineReader reader(file, "a mapping file of ANSYS");
  std::vector<NumberedRow> rows;
  while (reader.next()) {
    std::array<std::string_view, 3> words;
    const std::size_t count = split(reader.line(), words);
    int number = 0;
    if (count == 0 || !parse(words[0], number)) {
      if (rows.empty()) continue;  // headings
      if (count == 0) continue;
    }
    if (count != 3) {
      throw reader.error(fmt::format("'{}'", reader.line().substr(0, 80)), "equation, node, label");
    }
    rows.push_back(numbered_row(reader, words, ansys_labels));
  }
  return in_order(reader, rows);
}

std::vector<FeRow> read_row_table(const std::filesystem::path& file) {
  ColumnRows table(file, "a table of rows", "row,node,motion");
  const LineReader& reader = table.reader();
  std::vector<NumberedRow> rows;
  std::set<std::pair<int, int>> named;
  while (table.next()) {
    rows.push_back(numbered_row(reader, table.cells(), motions));
    const FeRow& row = rows.back().second;
    if (!named.emplace(row.node, row.motion).second) {
      throw reader.error(fmt::format("{} of node {} again", table.cells()[2], row.node), "each motion of a node once");
    }
  }
  return in_order(reader, rows);
}

}  // namespace railtab
