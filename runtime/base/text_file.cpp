#include "railtab/runtime/base/text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <system_error>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

bool is_file(const std::filesystem::path& file) noexcept {
  std::error_code refused;
  return std::filesystem::is_regular_file(file, refused);
}

std::string_view what_is_at(const std::filesystem::path& file) noexcept {
  std::error_code refused;
  switch (std::filesystem::status(file, refused).type()) {
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

bool is_wrong_name(const std::error_code& refused) noexcept {
  return refused == std::errc::filename_too_long || refused == std::errc::too_many_symbolic_link_levels ||
         refused == std::errc::permission_denied || refused == std::errc::not_a_directory ||
         refused == std::errc::no_such_file_or_directory;
}

std::filesystem::path output_file(const std::filesystem::path& named) {
  std::error_code failed;
  std::filesystem::path file = named;
  constexpr int most_links = 40;  // as Linux follows
  for (int i = 0; std::filesystem::is_symlink(file, failed); ++i) {
    if (i == most_links) throw input_error(named.string(), "links in a circle", "the name of a file");
    file = file.parent_path() / std::filesystem::read_symlink(file, failed);
  }
  if (std::filesystem::exists(file, failed) && !std::filesystem::is_regular_file(file, failed)) {
    throw input_error(named.string(), std::string(what_is_at(file)), "the name of a file");
  }
  return file;
}

namespace {

/// Whether a file is there whose first bytes no text has: a table, results, any other binary file.
bool is_binary(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::array<char, 512> head{};
  stream.read(head.data(), head.size());
  const auto end = head.begin() + stream.gcount();
  return std::find(head.begin(), end, '\0') != end;
}

}  // namespace

void write_text_file(const std::filesystem::path& named, std::string_view text) {
  const std::filesystem::path file = output_file(named);
  if (is_binary(file)) throw input_error(named.string(), "a table or results of railtab, or HDF5", "another name");
  std::filesystem::path unfinished = file;
  unfinished += ".part";
  std::ofstream stream(unfinished, std::ios::binary);
  if (!stream) {
    throw input_error(file.string(), "a place that cannot be written", "a file name in an existing folder");
  }
  stream << text;
  stream.close();
  std::error_code failed(stream ? 0 : errno, std::generic_category());
  if (stream) std::filesystem::rename(unfinished, file, failed);
  if (!stream || failed) {
    std::error_code ignored;
    std::filesystem::remove(unfinished, ignored);
    throw ComputationError(fmt::format("{}: could not be written: {}", file.string(), failed.message()));
  }
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
