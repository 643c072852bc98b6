#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

namespace railtab {

/// Before a command begins to work. @param option "-o"
/// @throws InputError where `file` could not be created: its folder does not exist or cannot be written, or something
/// other than a file is there.
void require_writable_place(const std::string& file, const std::string& option);

/// An output whose name ends as files of another kind do would be opened by the wrong program.
/// @param content what the file will be, "an HTML page"
/// @param endings of such files, the first is proposed. @throws InputError where the name has the ending of a widely
/// used other kind of file
void require_fitting_name(const std::string& file, const std::string& option, std::string_view content,
                          std::initializer_list<std::string_view> endings);

}  // namespace railtab
