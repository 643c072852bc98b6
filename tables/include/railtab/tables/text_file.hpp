#pragma once

#include <filesystem>
#include <string_view>

namespace railtab {

/// Write a text file whole or not at all: to a temporary name beside `file`, then renamed.
/// @throws InputError where the folder cannot be written.
void write_text_file(const std::filesystem::path& file, std::string_view text);

}  // namespace railtab
