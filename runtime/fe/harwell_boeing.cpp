#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "railtab/runtime/base/text_lines.hpp"
#include "railtab/runtime/fe/fe_files.hpp"

namespace railtab {

namespace {

/// Fields of equal width on a card: (10I8), (1P5E16.8), (3D25.16).
struct FieldFormat {
  int per_line = 0;
  int width = 0;
};

FieldFormat field_format(const LineReader& reader, std::string_view card, std::string_view letters) {
  std::string text;
  for (char c : card) {
    if (c != ' ') text += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  const auto rejection = [&] {
    return reader.error(fmt::format("format '{}'", stripped(card)), fmt::format("one like (5{}16)", letters.front()));
  };
  if (text.size() < 4 || text.front() != '(' || text.back() != ')') throw rejection();
  std::string_view inside = std::string_view(text).substr(1, text.size() - 2);
  // A scale factor changes nothing where numbers have exponents.
  if (const std::size_t p = inside.find('P'); p != std::string_view::npos && letters.front() != 'I') {
    inside.remove_prefix(p + 1);
    if (inside.starts_with(',')) inside.remove_prefix(1);
  }
  const std::size_t letter = inside.find_first_of(letters);
  if (letter == std::string_view::npos) throw rejection();
  FieldFormat format{1, 0};
  if (letter > 0 && !parse(inside.substr(0, letter), format.per_line)) throw rejection();
  const std::string_view width = inside.substr(letter + 1, inside.find('.', letter) - letter - 1);
  if (!parse(width, format.width) || format.width < 1 || format.width > 80 || format.per_line < 1 ||
      format.per_line > 1000) {
    throw rejection();
  }
  return format;
}

/// Field after field in a fixed format, over as many lines as it takes.
class FieldReader {
 public:
  FieldReader(LineReader& reader, FieldFormat format, std::string_view what)
      : reader_(reader), format_(format), what_(what) {}

  [[nodiscard]] std::string_view next() {
    if (place_ == format_.per_line || place_ < 0) {
      if (!reader_.next()) throw reader_.file_error("the end of the file", what_);
      place_ = 0;
    }
    const auto begin = static_cast<std::size_t>(place_++ * format_.width);
    const std::string_view line = reader_.line();
    const std::string_view field = stripped(
        begin < line.size() ? line.substr(begin, static_cast<std::size_t>(format_.width)) : std::string_view());
    if (field.empty()) throw reader_.error("a line that is too short", what_);
    return field;
  }
  [[nodiscard]] long integer() { return reader_.number<long>(next(), what_); }
  /// Fortran's 1.5D+03 and 1.5-103.
  [[nodiscard]] double real() {
    const std::string_view field = next();
    text_.clear();
    for (std::size_t i = 0; i < field.size(); ++i) {
      const char c = field[i];
      const bool sign = c == '+' || c == '-';
      if (sign && i > 0 && (std::isdigit(static_cast<unsigned char>(field[i - 1])) || field[i - 1] == '.'))
        text_ += 'e';
      text_ += c == 'D' || c == 'd' || c == 'E' ? 'e' : c;
    }
    return reader_.number<double>(text_, what_);
  }

 private:
  LineReader& reader_;
  FieldFormat format_;
  std::string_view what_;
  int place_ = -1;
  std::string text_;
};

struct Header {
  bool symmetric = false;
  long rows = 0, entries = 0;
  FieldFormat pointer, index, value;
};

void next_card(LineReader& reader) {
  if (!reader.next()) throw reader.file_error("the end of the file", "the header of a Harwell-Boeing matrix");
}

std::string_view columns(std::string_view line, std::size_t begin, std::size_t count) {
  return begin < line.size() ? line.substr(begin, count) : std::string_view();
}

Header read_header(LineReader& reader) {
  Header header;
  next_card(reader);  // title and key
  next_card(reader);  // numbers of lines; the right-hand sides are the last of them
  long right_hand_lines = 0;
  const std::string_view counted = stripped(columns(reader.line(), 56, 14));
  if (!counted.empty()) right_hand_lines = reader.number<long>(counted, "the lines of right-hand sides");
  next_card(reader);
  const std::string type = upper_case(columns(reader.line(), 0, 3));
  if (type != "RSA" && type != "RUA") {
    throw reader.error(fmt::format("matrix type '{}'", type), "RSA or RUA: real, symmetric or not, assembled");
  }
  header.symmetric = type == "RSA";
  header.rows = reader.number<long>(stripped(columns(reader.line(), 14, 14)), "the number of rows");
  const long width = reader.number<long>(stripped(columns(reader.line(), 28, 14)), "the number of columns");
  header.entries = reader.number<long>(stripped(columns(reader.line(), 42, 14)), "the number of entries");
  if (width != header.rows) throw reader.error(fmt::format("{} x {}", header.rows, width), "a square matrix");
  require_possible_size(reader, header.rows, width, header.entries, 2);
  next_card(reader);
  header.pointer = field_format(reader, columns(reader.line(), 0, 16), "I");
  header.index = field_format(reader, columns(reader.line(), 16, 16), "I");
  header.value = field_format(reader, columns(reader.line(), 32, 20), "EDFG");
  if (right_hand_lines > 0) next_card(reader);
  return header;
}

std::vector<long> read_pointers(LineReader& reader, const Header& header) {
  FieldReader fields(reader, header.pointer, "the places at which columns begin");
  std::vector<long> begin;
  for (long j = 0; j <= header.rows; ++j) {
    begin.push_back(fields.integer());
    const long least = j == 0 ? 1 : begin[static_cast<std::size_t>(j - 1)];
    const long most = j == 0 ? 1 : header.entries + 1;
    if (begin.back() < least || begin.back() > most) {
      throw reader.error(fmt::format("column {} at place {}", j + 1, begin.back()),
                         fmt::format("{} to {}", least, most));
    }
  }
  if (begin.back() != header.entries + 1) {
    throw reader.error(fmt::format("{} entries in the columns", begin.back() - 1), fmt::format("{}", header.entries));
  }
  return begin;
}

}  // namespace

Eigen::SparseMatrix<double> read_harwell_boeing(const std::filesystem::path& file) {
  LineReader reader(file, "a Harwell-Boeing matrix");
  const Header header = read_header(reader);
  const std::vector<long> begin = read_pointers(reader, header);
  std::vector<Eigen::Triplet<double>> triplets;
  triplets.reserve(static_cast<std::size_t>(header.symmetric ? 2 * header.entries : header.entries));
  FieldReader indices(reader, header.index, "a row number");
  bool above = false, below = false;
  for (int j = 0; j < header.rows; ++j) {
    for (long p = begin[static_cast<std::size_t>(j)]; p < begin[static_cast<std::size_t>(j) + 1]; ++p) {
      const long row = indices.integer();
      if (row < 1 || row > header.rows) {
        throw reader.error(fmt::format("row {}", row), fmt::format("1 to {}", header.rows));
      }
      const long i = row - 1;
      above = above || i < j;
      below = below || i > j;
      if (header.symmetric && above && below) {
        throw reader.error("entries on both sides of the diagonal", "one triangle of a symmetric matrix (RSA)");
      }
      triplets.emplace_back(static_cast<int>(i), j, 0.0);
    }
  }
  FieldReader values(reader, header.value, "a finite number");
  for (std::size_t p = 0; p < static_cast<std::size_t>(header.entries); ++p) {
    const Eigen::Triplet<double> entry(triplets[p].row(), triplets[p].col(), values.real());
    triplets[p] = entry;
    if (header.symmetric && entry.row() != entry.col()) triplets.emplace_back(entry.col(), entry.row(), entry.value());
  }
  Eigen::SparseMatrix<double> matrix(header.rows, header.rows);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return matrix;
}

}  // namespace railtab
