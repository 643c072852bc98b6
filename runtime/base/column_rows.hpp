#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "railtab/runtime/base/text_lines.hpp"

namespace railtab {

/// Rows of cells between commas under one header row, the form of all text tables that railtab reads. Empty lines
/// and lines that begin with # are skipped; blanks around a cell do not belong to it.
class ColumnRows {
 public:
  /// Reads the header row. @param kind of file, for messages @throws InputError where there is no readable file
  ColumnRows(const std::filesystem::path& file, std::string_view kind);
  /// @param header names between commas that the header row must have, in this order @throws InputError where it has
  /// not
  ColumnRows(const std::filesystem::path& file, std::string_view kind, std::string_view header);

  /// Names of the columns; none where the file has no row at all.
  [[nodiscard]] const std::vector<std::string>& header() const noexcept { return header_; }
  [[nodiscard]] long header_line() const noexcept { return header_line_; }
  /// @throws InputError where semicolons, tabs or blanks separate the names of the header: some spreadsheets write them
  void require_commas(std::string_view expected) const;
  /// False at the end. @throws InputError where a row has not as many cells as the header
  bool next();
  [[nodiscard]] const std::vector<std::string_view>& cells() const noexcept { return cells_; }
  /// Where it is; errors and numbers with their place.
  [[nodiscard]] const LineReader& reader() const noexcept { return reader_; }

 private:
  bool next_row();

  LineReader reader_;
  std::vector<std::string> header_;
  long header_line_ = 0;
  std::string row_of_header_;  ///< of a header that was asked for, to show in messages
  std::vector<std::string_view> cells_;
};

/// A cell in quotes, and no more of it than a message can take.
[[nodiscard]] std::string quoted(std::string_view cell);

}  // namespace railtab
