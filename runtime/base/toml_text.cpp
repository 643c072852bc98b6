#include "railtab/runtime/base/toml_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "railtab/runtime/base/file_signatures.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/text_file.hpp"

namespace railtab {

namespace {

/// Goes through a text character by character. It follows strings and comments, whose dots and brackets are none, and
/// leaves it to the parser to reject what is no TOML.
class BoundsCheck {
 public:
  BoundsCheck(std::string_view text, const std::filesystem::path& file) : text_(text), file_(file) {}

  void run() {
    for (; at_ < text_.size(); ++at_) {
      switch (text_[at_]) {
        case '#':
          at_ = std::min(text_.find('\n', at_), text_.size()) - 1;
          break;
        case '"':
        case '\'':
          skip_string(text_[at_]);
          break;
        case '.':
          ++parts_;
          break;
        case '\n':
          end_key();
          ++line_;
          break;
        case '[':
        case '{':
          end_key();
          check(++depth_, TomlBounds::depth, "arrays and inline tables within each other");
          break;
        case ']':
        case '}':
          end_key();
          depth_ = std::max(0, depth_ - 1);
          break;
        case '=':
        case ',':
          end_key();
          break;
        default:
          break;
      }
    }
    end_key();
  }

 private:
  // Numbers and dates have a dot too, and never more than one.
  void end_key() {
    check(parts_, TomlBounds::key_parts, "parts of a key, separated by dots");
    parts_ = 1;
  }

  void check(int found, int most, std::string_view what) const {
    if (found <= most) return;
    throw input_error(fmt::format("{}:{}", file_.string(), line_), fmt::format("{} {}", found, what),
                      fmt::format("at most {}", most));
  }

  // From the opening quote to the closing one; a string on one line ends with its line in any case.
  void skip_string(char quote) {
    const std::string three(3, quote);
    const bool many_lines = text_.substr(at_, 3) == three;
    std::size_t end = at_ + (many_lines ? 3 : 1);
    for (; end < text_.size(); ++end) {
      if (many_lines && text_[end] == '\n') ++line_;
      if (text_[end] == '\\' && quote == '"' && text_.substr(end + 1, 1) != "\n") {
        ++end;
        continue;
      }
      if (!many_lines && (text_[end] == quote || text_[end] == '\n')) break;
      if (many_lines && text_.substr(end, 3) == three) break;
    }
    end = std::min(end, text_.size());  // of a string without an end
    if (many_lines) end += 2;
    at_ = !many_lines && text_.substr(end, 1) == "\n" ? end - 1 : end;  // the end of the line ends the key too
  }

  std::string_view text_;
  const std::filesystem::path& file_;
  std::size_t at_ = 0;
  int line_ = 1, parts_ = 1, depth_ = 0;
};

/// What a file is that begins so and has no text; empty: it may be text.
std::string_view binary_kind(std::string_view begin) {
  if (begin.starts_with(hdf5_signature)) return "an HDF5 file";
  if (begin.starts_with(sealed_file_signature)) return "a table or results of railtab";
  if (begin.starts_with(zip_signature)) return "a ZIP archive";
  return begin.substr(0, 512).find('\0') != std::string_view::npos ? "a binary file" : "";
}

}  // namespace

std::string toml_fault(std::string_view text, std::size_t line, std::string_view parser_words) {
  for (; line > 1 && text.find('\n') != std::string_view::npos; --line) text.remove_prefix(text.find('\n') + 1);
  text = text.substr(0, text.find_first_of("#\n"));
  text.remove_prefix(std::min(text.find('=') + 1, text.size()));  // npos + 1 = 0
  const auto trim = [](std::string_view value) {
    const std::size_t first = std::min(value.find_first_not_of(" \t\r"), value.size());
    return value.substr(first, value.find_last_not_of(" \t\r") + 1 - first);
  };
  std::string number(trim(text));
  const std::size_t comma = number.find(',');
  constexpr std::string_view digits = "0123456789";
  const auto digit = [&](std::size_t at) { return at < number.size() && digits.find(number[at]) != digits.npos; };
  if (comma == std::string::npos || comma == 0 || !digit(comma - 1) || !digit(comma + 1) ||
      number.find_first_not_of("0123456789+-eE,") != std::string::npos || number.find(',', comma + 1) != number.npos) {
    return std::string(parser_words);
  }
  const std::string found = number;
  number[comma] = '.';
  return fmt::format("found {}, expected a number with a decimal point: {}", found, number);
}

void check_toml_bounds(std::string_view text, const std::filesystem::path& file) { BoundsCheck(text, file).run(); }

std::string read_toml_text(const std::filesystem::path& file, std::string_view what) {
  if (!is_file(file)) throw input_error(file.string(), what_is_at(file), what);
  std::ifstream stream(file, std::ios::binary);
  std::string text(TomlBounds::bytes + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!stream && !stream.eof()) throw input_error(file.string(), "a file that cannot be read", what);
  text.resize(static_cast<std::size_t>(stream.gcount()));
  text.shrink_to_fit();
  if (const std::string_view kind = binary_kind(text); !kind.empty()) throw input_error(file.string(), kind, what);
  if (file.extension() == ".csv") throw input_error(file.string(), "a file of columns (.csv)", what);
  if (text.size() > TomlBounds::bytes) {
    throw input_error(file.string(), fmt::format("more than {} MB", TomlBounds::bytes >> 20),
                      fmt::format("{} of at most that size", what));
  }
  return text;
}

}  // namespace railtab
