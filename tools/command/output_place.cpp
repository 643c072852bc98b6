#include "command/output_place.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/text_file.hpp"

namespace railtab {

void require_writable_place(const std::string& file, const std::string& option) {
  const std::filesystem::path path = output_file(file);
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  const std::string place = fmt::format("{} {}", option, file);
  std::error_code refused;
  if (!std::filesystem::is_directory(folder, refused)) {
    throw input_error(place, fmt::format("no folder {}", folder.string()), "a file in an existing folder");
  }
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    throw input_error(place, fmt::format("no right to write in {}", folder.string()), "a folder that can be written");
  }
  static_cast<void>(std::filesystem::status(path, refused));
  if (refused && refused != std::errc::no_such_file_or_directory) {
    throw input_error(place, refused.message(), "a name that a file can have");
  }
}

}  // namespace railtab
