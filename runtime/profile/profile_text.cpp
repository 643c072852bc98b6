#include "railtab/runtime/profile/profile_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>

#include "railtab/runtime/base/file_signatures.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/text_lines.hpp"

namespace railtab {

namespace {
constexpr std::string_view blanks = " \t\r\f\v";
}  // namespace

std::optional<std::string> ProfileText::next() {
  std::string text;
  if (!std::getline(in, text)) return std::nullopt;
  if (++line == 1 && text.starts_with(byte_order_mark)) text.erase(0, byte_order_mark.size());
  return text;
}

std::string ProfileText::place() const { return fmt::format("{}:{}", file, line); }

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

bool same_ignoring_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

std::string note_of_case(const ProfileText& text, std::string_view key, std::span<const std::string_view> known) {
  if (std::find(known.begin(), known.end(), key) != known.end()) return {};
  const auto like =
      std::find_if(known.begin(), known.end(), [&](std::string_view k) { return same_ignoring_case(k, key); });
  if (like == known.end()) return {};
  return fmt::format("{}: the key {} is ignored; the known key is {}", text.place(), key, *like);
}

std::vector<std::string_view> fields(std::string_view text) {
  std::vector<std::string_view> result;
  text = trimmed(text);
  while (!text.empty()) {
    const std::size_t end = text.find_first_of(" \t\r\f\v,;");
    result.push_back(text.substr(0, end));
    if (end == std::string_view::npos) break;
    text = trimmed(text.substr(end));
    if (!text.empty() && (text.front() == ',' || text.front() == ';')) {
      text = trimmed(text.substr(1));
      if (text.empty()) result.push_back(text);  // "1," has an empty second field
    }
  }
  return result;
}

std::string expected_numbers(std::string_view line, std::string_view expected) {
  constexpr std::string_view digits = "0123456789";
  std::array<std::string_view, 8> words;
  const std::size_t count = split(line, words, ";");
  std::string with_points;
  bool has_comma = false;
  for (std::size_t i = 0; i < std::min(count, words.size()); ++i) {
    std::string word(words[i]);
    const std::size_t comma = word.find(',');
    if (comma != word.npos) {
      const bool between_digits = comma > 0 && comma + 1 < word.size() && digits.find(word[comma - 1]) != digits.npos &&
                                  digits.find(word[comma + 1]) != digits.npos;
      if (!between_digits) return std::string(expected);
      word[comma] = '.';
      has_comma = true;
    }
    double value = 0.0;
    if (!parse(word, value)) return std::string(expected);
    with_points += (i > 0 ? " " : "") + word;
  }
  if (!has_comma || count < 2 || count > words.size()) return std::string(expected);
  return fmt::format("{}, with decimal points: {}", expected, with_points);
}

double number(std::string_view field, std::string_view place, std::string_view expected) {
  const bool plus = field.size() > 1 && field[0] == '+' && field[1] != '-';
  const std::string_view digits = plus ? field.substr(1) : field;  // from_chars knows no leading plus
  double value = 0.0;
  const char* const end = digits.data() + digits.size();
  const std::from_chars_result r = std::from_chars(digits.data(), end, value);
  if (r.ec != std::errc() || r.ptr != end || !std::isfinite(value)) {
    throw input_error(place, fmt::format("\"{}\"", field), expected);
  }
  return value;
}

}  // namespace railtab
