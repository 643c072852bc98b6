#include "railtab/runtime/base/text_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "railtab/runtime/base/file_signatures.hpp"
#include "railtab/runtime/base/text_file.hpp"

namespace railtab {

namespace {
constexpr std::string_view blank = " \t\r";
}

std::string_view stripped(std::string_view text) noexcept {
  const std::size_t first = text.find_first_not_of(blank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

std::string upper_case(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(), [](unsigned char c) { return std::toupper(c); });
  return result;
}

std::size_t split(std::string_view text, std::span<std::string_view> words, std::string_view separators) noexcept {
  const auto cuts = [&](char c) { return blank.find(c) != blank.npos || separators.find(c) != separators.npos; };
  std::size_t count = 0;
  for (std::size_t i = 0; i < text.size();) {
    if (cuts(text[i])) {
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < text.size() && !cuts(text[end])) ++end;
    if (count < words.size()) words[count] = text.substr(i, end - i);
    ++count;
    i = end;
  }
  return count;
}

void cut(std::string_view text, char separator, std::vector<std::string_view>& fields) {
  fields.clear();
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    fields.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
}

LineReader::LineReader(const std::filesystem::path& file, std::string_view kind) : file_(file) {
  if (!is_file(file)) throw input_error(file.string(), std::string(what_is_at(file)), kind);
  stream_.open(file);
  std::error_code none;
  bytes_ = std::filesystem::file_size(file, none);
  if (!stream_.is_open() || !stream_) throw input_error(file.string(), "no readable file", kind);
}

bool LineReader::next() {
  if (std::getline(stream_, line_)) {
    if (++count_ == 1 && line_.starts_with(byte_order_mark)) line_.erase(0, byte_order_mark.size());
    return true;
  }
  if (stream_.bad()) throw file_error("a read error", "a readable text file");
  line_.clear();
  return false;
}

std::string LineReader::place() const { return place(count_); }

std::string LineReader::place(long line) const {
  return line > 0 ? fmt::format("{}:{}", file_.string(), line) : file_.string();
}

InputError LineReader::error(std::string_view found, std::string_view expected) const {
  return input_error(place(), found, expected);
}

InputError LineReader::file_error(std::string_view found, std::string_view expected) const {
  return input_error(file_.string(), found, expected);
}

void require_possible_size(const LineReader& reader, long rows, long columns, long entries, int bytes_per_entry) {
  constexpr long most_rows = 20'000'000;  // ten times what a direct solver can factorise on a workstation
  if (rows < 1 || columns < 1 || rows > most_rows || columns > most_rows) {
    throw reader.error(fmt::format("{} rows and {} columns", rows, columns), fmt::format("1 to {} each", most_rows));
  }
  const auto most = static_cast<long>(reader.file_bytes() / static_cast<std::uintmax_t>(bytes_per_entry));
  if (entries < 0 || entries > most) {
    throw reader.error(fmt::format("{} entries", entries),
                       fmt::format("at most {}, what a file of {} bytes can hold", most, reader.file_bytes()));
  }
}

}  // namespace railtab
