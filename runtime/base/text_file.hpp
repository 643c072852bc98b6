#pragma once

#include <filesystem>
#include <initializer_list>
#include <string_view>
#include <system_error>

namespace railtab {

/// Whether there is a regular file of that name. False too where the system takes no such name or rejects the way to
/// it.
[[nodiscard]] bool is_file(const std::filesystem::path& file) noexcept;

/// What there is where a regular file should be, for messages: "no such file", "a folder", "a device", "a pipe",
/// "a socket", "no regular file".
[[nodiscard]] std::string_view what_is_at(const std::filesystem::path& file) noexcept;

/// Whether the system rejected a name, not an operation: too long, links in a circle, no right to the folder, none
/// there.
[[nodiscard]] bool is_wrong_name(const std::error_code& rejected) noexcept;

/// The file that an output named `file` becomes: where `file` is a symbolic link, what it points to, there or not.
/// @throws InputError where there is something other than a regular file: a folder, a device, a pipe, links in a circle
[[nodiscard]] std::filesystem::path output_file(const std::filesystem::path& file);

/// A text output may replace an empty file and an earlier one of its own kind, which begins with the same `mark`: the
/// header of a CSV, the first line of a page. Another file is somebody's. @throws InputError
void require_replaceable_text(const std::filesystem::path& file, std::string_view mark);

/// Write a text file whole or not at all: to a temporary file beside `file`, then renamed.
/// @param mark what its kind begins with, see require_replaceable_text(); the first line of `text` where it is empty
/// @throws InputError where the folder cannot be written, and where `file` is there and of another kind.
/// @throws ComputationError where the disk is full.
void write_text_file(const std::filesystem::path& file, std::string_view text, std::string_view mark = {});

/// An output must not destroy what is read. @throws InputError where `output` is one of the files `inputs` (names that
/// are no files do not count).
void require_no_input(const std::filesystem::path& output, std::initializer_list<std::filesystem::path> inputs);

}  // namespace railtab
