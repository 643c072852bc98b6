#include <fmt/format.h>

#include <array>

#include "railtab/runtime/base/text_lines.hpp"
#include "railtab/runtime/fe/fe_files.hpp"

namespace railtab {

namespace {

// The next line that is neither empty nor a comment; false at the end of the file.
bool next(LineReader& reader) {
  while (reader.next()) {
    if (!reader.line().starts_with('%') && !stripped(reader.line()).empty()) return true;
  }
  return false;
}

// Whether only one half is stored.
bool read_banner(LineReader& reader) {
  if (!reader.next()) throw reader.file_error("an empty file", "a Matrix Market file");
  const std::string text = upper_case(reader.line());
  std::array<std::string_view, 5> words;
  const bool known = split(text, words) == 5 && words[0] == "%%MATRIXMARKET" && words[1] == "MATRIX" &&
                     words[2] == "COORDINATE" && (words[3] == "REAL" || words[3] == "INTEGER") &&
                     (words[4] == "GENERAL" || words[4] == "SYMMETRIC");
  if (!known) {
    throw reader.error(fmt::format("'{}'", reader.line().substr(0, 80)),
                       "'%%MatrixMarket matrix coordinate real general' or '… symmetric'");
  }
  return words[4] == "SYMMETRIC";
}

}  // namespace

Eigen::SparseMatrix<double> read_matrix_market(const std::filesystem::path& file) {
  LineReader reader(file, "a Matrix Market file");
  const bool symmetric = read_banner(reader);
  if (!next(reader)) throw reader.file_error("no size line", "rows, columns, entries");
  std::array<std::string_view, 3> words;
  if (split(reader.line(), words) != 3) {
    throw reader.error(fmt::format("'{}'", reader.line().substr(0, 80)), "rows, columns, entries");
  }
  const long rows = reader.number<long>(words[0], "the number of rows");
  const long columns = reader.number<long>(words[1], "the number of columns");
  const long entries = reader.number<long>(words[2], "the number of entries");
  if (symmetric && rows != columns) {
    throw reader.error(fmt::format("{} rows and {} columns of a symmetric matrix", rows, columns),
                       "as many rows as columns");
  }
  require_possible_size(reader, rows, columns, entries, 6);  // "1 1 1" and the end of the line
  std::vector<Eigen::Triplet<double>> triplets;
  triplets.reserve(static_cast<std::size_t>(symmetric ? 2 * entries : entries));
  long found = 0;
  while (next(reader)) {
    if (++found > entries) throw reader.error("another entry", fmt::format("{} entries", entries));
    if (split(reader.line(), words) != 3) {
      throw reader.error(fmt::format("'{}'", reader.line().substr(0, 80)), "row, column, value");
    }
    const int i = reader.number<int>(words[0], "a row number");
    const int j = reader.number<int>(words[1], "a column number");
    if (i < 1 || i > rows || j < 1 || j > columns) {
      throw reader.error(fmt::format("row {}, column {}", i, j), fmt::format("1 to {} and 1 to {}", rows, columns));
    }
    const auto value = reader.number<double>(words[2], "a finite number");
    triplets.emplace_back(i - 1, j - 1, value);
    if (symmetric && i != j) triplets.emplace_back(j - 1, i - 1, value);
  }
  if (found < entries) throw reader.file_error(fmt::format("{} entries", found), fmt::format("{}", entries));
  Eigen::SparseMatrix<double> matrix(rows, columns);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return matrix;
}

}  // namespace railtab
