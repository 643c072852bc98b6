#pragma once

#include <filesystem>
#include <initializer_list>
#include <string_view>
#include <system_error>

namespace railtab {

/// Whether there is a regular file of that name. False too where the system takes no such name or refuses the way to
/// it.
[[nodiscard]] bool is_file(const std::filesystem::path& file) noexcept;

/// What there is where a regular file should be, for messages: "no such file", "a folder", "a device", "a pipe",
/// "a socket", "no regular file".
[[nodiscard]] std::string_view what_is_at(const std::filesystem::path& file) noexcept;

/// Whether the system refused a name, not an operation: too long, links in a circle, no right to the folder, none
/// there.
[[nodiscard]] bool is_wrong_name(const std::error_code& refused) noexcept;

/// The file that an output named `file` becomes: where `file` is a symbolic link, what it points to, there or not.
/// @throws InputError where there is something other than a regular file: a folder, a device, a pipe, links in a circle
[[nodiscard]] std::filesystem::path output_file(const std::filesystem::path& file);

/// Write a text file whole or not at all: to a temporary name beside `file`, then renamed.
/// @throws InputError where the folder cannot be written, and where `file` is an HDF5 file: no text is meant to replace
/// a table or results. @throws ComputationError where the disk is full.
void write_text_file(const std::filesystem::path& file, std::string_view text);

/// An output must not destroy what is read. @throws InputError where `output` is one of the files `inputs` (names that
/// are no files do not count).
void require_no_input(const std::filesystem::path& output, std::initializer_list<std::filesystem::path> inputs);

}  // namespace railtab
