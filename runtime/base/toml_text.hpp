#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace railtab {

/// Bounds of a TOML text. The parser, and every walk through what it made, calls itself once per level, and looks a
/// dotted key up part by part: without bounds a short file can end the process or occupy it for minutes.
struct TomlBounds {
  static constexpr std::size_t bytes = 4u << 20;  ///< of a file: some 40 000 sections
  static constexpr int key_parts = 16;            ///< of a key or heading, "a.b.c" has 3
  static constexpr int depth = 16;                ///< arrays and inline tables within each other
};

/// The text of a TOML file within TomlBounds::bytes; check_toml_bounds() checks the other bounds before it is parsed.
/// @param what  the file is, for messages ("a TOML scene")
/// @throws InputError naming the file where it is larger, is no text, or does not exist
[[nodiscard]] std::string read_toml_text(const std::filesystem::path& file, std::string_view what);

/// @throws InputError naming `file` and the line at which `text` exceeds TomlBounds::key_parts or depth
void check_toml_bounds(std::string_view text, const std::filesystem::path& file);

/// What is wrong on a line (from 1) that the parser has rejected: its own words, or that a number has a decimal comma.
[[nodiscard]] std::string toml_fault(std::string_view text, std::size_t line, std::string_view parser_words);

}  // namespace railtab
