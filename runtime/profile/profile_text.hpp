#pragma once

#include <istream>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace railtab {

/// A text file of a profile, line by line, with the place for messages.
struct ProfileText {
  std::istream& in;
  std::string file;
  int line = 0;

  /// The next line without its line end; nothing at the end of the file.
  [[nodiscard]] std::optional<std::string> next();
  /// "<file>:<line>" of the line read last.
  [[nodiscard]] std::string place() const;
};

/// Text without blanks at both ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

[[nodiscard]] bool same_ignoring_case(std::string_view a, std::string_view b);

/// A note that the key on the text's line is ignored, where it is not one of `known` but for its case; empty of others.
[[nodiscard]] std::string note_of_case(const ProfileText& text, std::string_view key,
                                       std::span<const std::string_view> known);

/// Fields between blanks; one comma or semicolon between two fields counts as a blank.
[[nodiscard]] std::vector<std::string_view> fields(std::string_view text);

/// What a line of numbers should be, for messages: `expected`, and the line with decimal points where it has commas.
[[nodiscard]] std::string expected_numbers(std::string_view line, std::string_view expected);

/// A finite decimal number, with optional sign and exponent, that fills the whole field.
/// @throws InputError naming `place` and what was expected
[[nodiscard]] double number(std::string_view field, std::string_view place, std::string_view expected);

}  // namespace railtab
