#include "railtab/runtime/base/column_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace railtab {

namespace {

void cut_cells(std::string_view text, std::vector<std::string_view>& cells) {
  cut(text, ',', cells);
  for (std::string_view& cell : cells) cell = stripped(cell);
}

}  // namespace

ColumnRows::ColumnRows(const std::filesystem::path& file, std::string_view kind) : reader_(file, kind) {
  if (!next_row()) return;
  header_.assign(cells_.begin(), cells_.end());
  header_line_ = reader_.line_number();
}

ColumnRows::ColumnRows(const std::filesystem::path& file, std::string_view kind, std::string_view header)
    : ColumnRows(file, kind) {
  if (header_.empty()) throw reader_.file_error("no line", header);
  std::vector<std::string_view> names;
  cut_cells(header, names);
  if (!std::equal(header_.begin(), header_.end(), names.begin(), names.end())) {
    throw reader_.error(fmt::format("'{}'", stripped(reader_.line()).substr(0, 80)), header);
  }
  row_of_header_ = header;
}

void ColumnRows::require_commas(std::string_view expected) const {
  if (header_.size() != 1) return;
  const std::string& name = header_.front();
  for (const auto& [separator, word] : {std::pair{';', "semicolons"}, {'\t', "tabs"}, {' ', "blanks"}}) {
    if (name.find(separator) == std::string::npos) continue;
    if (separator == ' ' && name.find('[') != std::string::npos) continue;  // "t [s]"
    throw reader_.error(fmt::format("columns separated by {}", word), expected);
  }
}

bool ColumnRows::next() {
  if (header_.empty() || !next_row()) return false;
  if (cells_.size() == header_.size()) return true;
  throw reader_.error(fmt::format("{} columns", cells_.size()),
                      row_of_header_.empty() ? fmt::format("{}, as in the header", header_.size())
                                             : fmt::format("{}: {}", header_.size(), row_of_header_));
}

bool ColumnRows::next_row() {
  while (reader_.next()) {
    const std::string_view text = stripped(reader_.line());
    if (text.empty() || text.front() == '#') continue;
    cut_cells(text, cells_);
    return true;
  }
  return false;
}

std::string quoted(std::string_view cell) {
  constexpr std::size_t longest = 40;
  std::size_t end = std::min(cell.size(), longest);
  while (end + 4 > longest && end < cell.size() && (static_cast<unsigned char>(cell[end]) & 0xC0U) == 0x80U)
    --end;  // of UTF-8
  return fmt::format("'{}{}'", cell.substr(0, end), end < cell.size() ? "…" : "");
}

}  // namespace railtab
