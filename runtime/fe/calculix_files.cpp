#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "railtab/runtime/base/text_lines.hpp"
#include "railtab/runtime/fe/fe_files.hpp"

namespace railtab {

Eigen::SparseMatrix<double> read_calculix_matrix(const std::filesystem::path& file, int rows) {
  constexpr std::string_view export_again = "a whole file: run ccx once more, with room on the disk";
  LineReader reader(file, "a matrix stored by CalculiX (.sti, .mas)");
  std::vector<Eigen::Triplet<double>> triplets;
  triplets.reserve(2 * static_cast<std::size_t>(reader.file_bytes() / 30));  // "1 1  1.8026080246914e+09" and more
  bool above = false, below = false;
  int last = 0;
  while (reader.next()) {
    std::array<std::string_view, 3> words;
    const std::size_t count = split(reader.line(), words);
    if (count == 0) continue;
    if (count != 3) {
      const std::string place = reader.place(reader.line_number()), text(reader.line().substr(0, 80));
      if (count > 3 || reader.next()) throw input_error(place, fmt::format("'{}'", text), "row, column, value");
      throw input_error(place, fmt::format("the end of the file within the line '{}'", text), export_again);
    }
    const int i = reader.number<int>(words[0], "a row number");
    const int j = reader.number<int>(words[1], "a column number");
    if (i < 1 || i > rows || j < 1 || j > rows) {
      throw reader.error(fmt::format("row {}, column {}", i, j),
                         fmt::format("1 to {}, the lines of the table of dofs", rows));
    }
    const auto value = reader.number<double>(words[2], "a finite number");
    last = std::max({last, i, j});
    above = above || i < j;
    below = below || i > j;
    if (above && below) throw reader.error("entries on both sides of the diagonal", "one triangle");
    if (value == 0.0) continue;
    triplets.emplace_back(i - 1, j - 1, value);
    if (i != j) triplets.emplace_back(j - 1, i - 1, value);
  }
  if (triplets.empty()) throw reader.file_error("no entry", "a matrix stored by CalculiX (.sti, .mas)");
  if (last < rows) {
    throw input_error(reader.place(reader.line_number()),
                      fmt::format("the end of the file after row {} of {}", last, rows), export_again);
  }
  Eigen::SparseMatrix<double> matrix(rows, rows);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return matrix;
}

std::vector<FeRow> read_calculix_rows(const std::filesystem::path& file) {
  LineReader reader(file, "a table of dofs by CalculiX (.dof)");
  std::vector<FeRow> rows;
  while (reader.next()) {
    const std::string_view text = stripped(reader.line());
    if (text.empty()) continue;
    const std::size_t dot = text.find('.');
    FeRow row;
    if (dot == std::string_view::npos || !parse(text.substr(0, dot), row.node) || row.node < 1 ||
        !parse(text.substr(dot + 1), row.motion) || row.motion < 1 || row.motion > 6) {
      throw reader.error(fmt::format("'{}'", text.substr(0, 40)), "node.direction, direction 1 to 6");
    }
    --row.motion;
    row.line = reader.line_number();
    rows.push_back(row);
  }
  if (rows.empty()) throw reader.file_error("no line", "node.direction, one line for each row of the matrices");
  return rows;
}

}  // namespace railtab
