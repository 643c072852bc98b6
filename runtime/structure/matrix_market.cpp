#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "railtab/runtime/structure/structure_import.hpp"
#include "railtab/tables/input_error.hpp"

namespace railtab {

namespace {

struct Line {
  std::string place;  // "file:line"
  std::string text;
};

std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  constexpr std::string_view blank = " \t\r";
  for (std::size_t begin = text.find_first_not_of(blank); begin != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(blank, begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(blank, end);
  }
  return words;
}

template <class Number>
Number number(const Line& line, std::string_view word, std::string_view expected) {
  Number value{};
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  bool good = error == std::errc{} && stop == word.data() + word.size();
  if constexpr (std::is_floating_point_v<Number>) good = good && std::isfinite(value);
  if (!good) throw input_error(line.place, fmt::format("'{}'", word), expected);
  return value;
}

// The next line that is neither empty nor a comment; false at the end of the file.
bool next(std::ifstream& stream, const std::filesystem::path& file, long& count, Line& line) {
  while (std::getline(stream, line.text)) {
    ++count;
    if (line.text.starts_with('%') || words_of(line.text).empty()) continue;
    line.place = fmt::format("{}:{}", file.string(), count);
    return true;
  }
  if (stream.bad()) throw input_error(file.string(), "a read error", "a readable text file");
  return false;
}

// Whether only one half is stored.
bool read_banner(std::ifstream& stream, const std::filesystem::path& file) {
  std::string text;
  std::getline(stream, text);
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  const std::vector<std::string_view> words = words_of(text);
  const bool known = words.size() == 5 && words[0] == "%%matrixmarket" && words[1] == "matrix" &&
                     words[2] == "coordinate" && (words[3] == "real" || words[3] == "integer") &&
                     (words[4] == "general" || words[4] == "symmetric");
  if (!known) {
    throw input_error(fmt::format("{}:1", file.string()), fmt::format("'{}'", text.substr(0, 80)),
                      "'%%MatrixMarket matrix coordinate real general' or '… symmetric'");
  }
  return words[4] == "symmetric";
}

}  // namespace

Eigen::SparseMatrix<double> read_matrix_market(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw input_error(file.string(), "no readable file", "a Matrix Market file");
  const bool symmetric = read_banner(stream, file);
  long line_count = 1;
  Line line;
  if (!next(stream, file, line_count, line)) throw input_error(file.string(), "no size line", "rows, columns, entries");
  const std::vector<std::string_view> sizes = words_of(line.text);
  if (sizes.size() != 3) throw input_error(line.place, fmt::format("'{}'", line.text), "rows, columns, entries");
  const int rows = number<int>(line, sizes[0], "the number of rows");
  const int columns = number<int>(line, sizes[1], "the number of columns");
  const long entries = number<long>(line, sizes[2], "the number of entries");
  if (rows < 1 || columns < 1 || entries < 0) {
    throw input_error(line.place, fmt::format("'{}'", line.text), "positive numbers of rows and columns");
  }
  std::vector<Eigen::Triplet<double>> triplets;
  long found = 0;
  while (next(stream, file, line_count, line)) {
    if (++found > entries) throw input_error(line.place, "another entry", fmt::format("{} entries", entries));
    const std::vector<std::string_view> words = words_of(line.text);
    if (words.size() != 3) throw input_error(line.place, fmt::format("'{}'", line.text), "row, column, value");
    const int i = number<int>(line, words[0], "a row number");
    const int j = number<int>(line, words[1], "a column number");
    if (i < 1 || i > rows || j < 1 || j > columns) {
      throw input_error(line.place, fmt::format("row {}, column {}", i, j),
                        fmt::format("1 to {} and 1 to {}", rows, columns));
    }
    const auto value = number<double>(line, words[2], "a finite number");
    triplets.emplace_back(i - 1, j - 1, value);
    if (symmetric && i != j) triplets.emplace_back(j - 1, i - 1, value);
  }
  if (found < entries) {
    throw input_error(file.string(), fmt::format("{} entries", found), fmt::format("{}", entries));
  }
  Eigen::SparseMatrix<double> matrix(rows, columns);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return matrix;
}

}  // namespace railtab
