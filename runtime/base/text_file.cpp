#include "railtab/runtime/base/text_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>

#include "railtab/runtime/base/column_rows.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/printable_text.hpp"
#include "railtab/runtime/base/temporary_file.hpp"

namespace railtab {

bool is_file(const std::filesystem::path& file) noexcept {
  std::error_code rejected;
  return std::filesystem::is_regular_file(file, rejected);
}

std::string_view what_is_at(const std::filesystem::path& file) noexcept {
  std::error_code rejected;
  switch (std::filesystem::status(file, rejected).type()) {
    case std::filesystem::file_type::none:
    case std::filesystem::file_type::not_found:
      return "no such file";
    case std::filesystem::file_type::directory:
      return "a folder";
    case std::filesystem::file_type::block:
    case std::filesystem::file_type::character:
      return "a device";
    case std::filesystem::file_type::fifo:
      return "a pipe";
    case std::filesystem::file_type::socket:
      return "a socket";
    default:
      return "no regular file";
  }
}

bool is_wrong_name(const std::error_code& rejected) noexcept {
  return rejected == std::errc::filename_too_long || rejected == std::errc::too_many_symbolic_link_levels ||
         rejected == std::errc::permission_denied || rejected == std::errc::not_a_directory ||
         rejected == std::errc::no_such_file_or_directory;
}

std::filesystem::path output_file(const std::filesystem::path& file) {
  std::error_code failed;
  std::filesystem::path target = file;
  constexpr int most_links = 40;  // as Linux follows
  for (int i = 0; std::filesystem::is_symlink(target, failed); ++i) {
    if (i == most_links) throw input_error(file.string(), "links in a circle", "the name of a file");
    target = target.parent_path() / std::filesystem::read_symlink(target, failed);
  }
  if (std::filesystem::exists(target, failed) && !std::filesystem::is_regular_file(target, failed)) {
    throw input_error(file.string(), std::string(what_is_at(target)), "the name of a file");
  }
  return target;
}

namespace {

/// The first bytes of a file, line ends as railtab writes them.
std::string beginning(const std::filesystem::path& file, std::size_t bytes) {
  std::ifstream stream(file, std::ios::binary);
  std::string head(2 * bytes, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(stream.gcount()));
  std::erase(head, '\r');
  head.resize(std::min(head.size(), bytes));
  return head;
}

std::string_view first_line(std::string_view text) { return text.substr(0, text.find('\n')); }

void write_all(int descriptor, std::string_view text, const std::filesystem::path& file) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno != EINTR) {
      throw ComputationError(fmt::format("{}: could not be written: {}", file.string(), std::strerror(errno)));
    }
    if (written > 0) text.remove_prefix(static_cast<std::size_t>(written));
  }
}

}  // namespace

void require_replaceable_text(const std::filesystem::path& file, std::string_view mark) {
  const std::filesystem::path target = output_file(file);
  std::error_code failed;
  if (!is_file(target) || std::filesystem::file_size(target, failed) == 0) return;
  constexpr std::size_t enough = 512;  // no text has a zero among them, tables and results have
  const std::string head = beginning(target, std::max(mark.size(), enough));
  if (head.starts_with(mark)) return;
  const bool binary = head.find('\0') != std::string::npos;
  // texts in JSON differ after their first line
  const bool begins_alike = first_line(head) == first_line(mark);
  const auto shown = [&](std::string_view text) {
    std::string begin((begins_alike ? text.substr(0, mark.size()) : first_line(text)).substr(0, 140));
    std::ranges::replace(begin, '\n', ' ');
    return begin;
  };
  const std::string found =
      binary ? "a table or results of railtab, or HDF5" : "a file that begins with " + railtab::quoted(shown(head));
  throw input_error(file.string(), found,
                    fmt::format("a new name, or an earlier output of this kind to replace, which begins with '{}'",
                                printable(shown(mark))));
}

void write_text_file(const std::filesystem::path& file, std::string_view text, std::string_view mark) {
  require_replaceable_text(file, mark.empty() ? text.substr(0, first_line(text).size() + 1) : mark);
  const std::filesystem::path target = output_file(file);
  TemporaryFile temporary = create_temporary(target);
  write_all(temporary.lock.descriptor(), text, target);
  temporary.publish(target);
}

void require_no_input(const std::filesystem::path& output, std::initializer_list<std::filesystem::path> inputs) {
  for (const std::filesystem::path& input : inputs) {
    std::error_code no_file;
    if (std::filesystem::equivalent(output, input, no_file)) {
      throw input_error("-o " + output.string(), "a file that this command reads", "another file");
    }
  }
}

}  // namespace railtab
