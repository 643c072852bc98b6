#pragma once

#include <string>
#include <string_view>

namespace railtab {

/// Before a command begins to work. @param option "-o"
/// @throws InputError where `file` could not be created: its folder does not exist or cannot be written, or something
/// other than a file is there.
void require_writable_place(const std::string& file, const std::string& option);

}  // namespace railtab
