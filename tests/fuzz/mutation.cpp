#include "mutation.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace railtab::fuzz {
namespace {

using Random = std::mt19937_64;

std::size_t below(std::size_t count, Random& random) {
  return count == 0 ? 0 : std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
}

struct Piece {
  std::size_t begin, length;
};

Piece any_piece(const std::string& bytes, Random& random) {
  const std::size_t begin = below(bytes.size(), random);
  constexpr std::size_t longest = 64;
  return {begin, 1 + below(std::min(longest, bytes.size() - begin), random)};
}

Piece any_line(const std::string& bytes, Random& random) {
  const std::size_t at = below(bytes.size(), random);
  const std::size_t before = at == 0 ? std::string::npos : bytes.rfind('\n', at - 1);
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  const std::size_t end = bytes.find('\n', begin);
  return {begin, (end == std::string::npos ? bytes.size() : end + 1) - begin};
}

void replace_number(std::string& bytes, Random& random) {
  static constexpr std::array<std::string_view, 18> extremes{
      "0",          "-0",         "-1",   "1e308",      "-1e308",
      "1e-320",     "nan",        "inf",  "1e400",      "9e99",
      "1:0",        "0.0001",     "-273", "1000000000", "99999999999999999999",
      "4294967296", "2147483648", ""};
  const std::size_t from = below(bytes.size(), random);
  const std::size_t begin = bytes.find_first_of("0123456789", from);
  if (begin == std::string::npos) return;
  const std::size_t end = std::min(bytes.find_first_not_of("0123456789.eE+-", begin), bytes.size());
  bytes.replace(begin, end - begin, extremes[below(extremes.size(), random)]);
}

void change(std::string& bytes, const std::string& other, Random& random) {
  enum Kind : std::size_t {
    flip,
    cut,
    repeat,
    splice,
    drop_line,
    repeat_line,
    other_line,
    swap_lines,
    number,
    end_here,
    kinds
  };
  if (bytes.empty()) {
    bytes = other;
    return;
  }
  switch (below(kinds, random)) {
    case flip:
      bytes[below(bytes.size(), random)] ^= static_cast<char>(1 + below(255, random));
      return;
    case cut: {
      const Piece piece = any_piece(bytes, random);
      bytes.erase(piece.begin, piece.length);
      return;
    }
    case repeat: {
      const Piece piece = any_piece(bytes, random);
      bytes.insert(below(bytes.size(), random), bytes.substr(piece.begin, piece.length));
      return;
    }
    case splice: {
      if (other.empty()) return;
      const Piece piece = any_piece(other, random);
      bytes.insert(below(bytes.size(), random), other, piece.begin, piece.length);
      return;
    }
    case drop_line: {
      const Piece line = any_line(bytes, random);
      bytes.erase(line.begin, line.length);
      return;
    }
    case repeat_line: {
      const Piece line = any_line(bytes, random);
      bytes.insert(line.begin, bytes.substr(line.begin, line.length));
      return;
    }
    case other_line: {
      if (other.empty()) return;
      const Piece line = any_line(other, random);
      bytes.insert(any_line(bytes, random).begin, other, line.begin, line.length);
      return;
    }
    case swap_lines: {
      const Piece line = any_line(bytes, random);
      const std::string text = bytes.substr(line.begin, line.length);
      bytes.erase(line.begin, line.length);
      bytes.insert(any_line(bytes, random).begin, text);
      return;
    }
    case number:
      replace_number(bytes, random);
      return;
    default:
      bytes.resize(below(bytes.size(), random));
  }
}

}  // namespace

std::string mutated(std::string bytes, const std::string& other, std::mt19937_64& random) {
  constexpr std::size_t most = 4;
  for (std::size_t n = 1 + below(most, random); n > 0; --n) change(bytes, other, random);
  return bytes;
}

}  // namespace railtab::fuzz
