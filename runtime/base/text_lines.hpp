#pragma once

#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

/// Text without the blanks around it.
[[nodiscard]] std::string_view stripped(std::string_view text) noexcept;
[[nodiscard]] std::string upper_case(std::string_view text);

/// Cuts text into words at blanks and at the characters of `separators`; words beyond those that fit are counted only.
std::size_t split(std::string_view text, std::span<std::string_view> words, std::string_view separators = "") noexcept;

/// Cuts text at every separator: fields may be empty, there is one at least. Replaces what `fields` held.
void cut(std::string_view text, char separator, std::vector<std::string_view>& fields);

/// The whole word as a number; floating-point numbers must be finite.
template <class Number>
[[nodiscard]] bool parse(std::string_view word, Number& value) noexcept {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if constexpr (std::is_floating_point_v<Number>) {
    if (!std::isfinite(value)) return false;
  }
  return error == std::errc{} && stop == word.data() + word.size();
}

/// A text file, line by line, that knows where it is. A byte order mark before the first line is skipped.
class LineReader {
 public:
  /// @throws InputError where there is no readable file
  LineReader(const std::filesystem::path& file, std::string_view kind);

  /// False at the end. @throws InputError where reading fails
  bool next();
  [[nodiscard]] std::string_view line() const noexcept { return line_; }
  [[nodiscard]] std::uintmax_t file_bytes() const noexcept { return bytes_; }
  [[nodiscard]] std::string place() const;  ///< "file:line", the file alone before its first line
  [[nodiscard]] std::string place(long line) const;
  [[nodiscard]] long line_number() const noexcept { return count_; }
  /// An error at this line: "file:line: found …, expected …".
  [[nodiscard]] InputError error(std::string_view found, std::string_view expected) const;
  /// An error of the file as a whole.
  [[nodiscard]] InputError file_error(std::string_view found, std::string_view expected) const;

  template <class Number>
  [[nodiscard]] Number number(std::string_view word, std::string_view expected) const {
    Number value{};
    if (!parse(word, value)) throw error("'" + std::string(word.substr(0, 40)) + "'", expected);
    return value;
  }

 private:
  std::filesystem::path file_;
  std::ifstream stream_;
  std::uintmax_t bytes_ = 0;
  std::string line_;
  long count_ = 0;
};

/// Sizes that no file of so many bytes can hold, or no memory, are rejected before anything is allocated.
/// @param bytes_per_entry at least, in the file
void require_possible_size(const LineReader& reader, long rows, long columns, long entries, int bytes_per_entry);

}  // namespace railtab
