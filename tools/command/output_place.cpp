#include "command/output_place.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/text_file.hpp"

namespace railtab {

void require_writable_place(const std::string& file, const std::string& option) {
  if (file.empty()) throw input_error(option, "an empty name", "the name of a file");
  const std::filesystem::path path = output_file(file);
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  const std::string place = fmt::format("{} {}", option, file);
  std::error_code rejected;
  if (!std::filesystem::is_directory(folder, rejected)) {
    throw input_error(place, fmt::format("no folder {}", folder.string()), "a file in an existing folder");
  }
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    throw input_error(place, fmt::format("no right to write in {}", folder.string()), "a folder that can be written");
  }
  static_cast<void>(std::filesystem::status(path, rejected));
  if (rejected && rejected != std::errc::no_such_file_or_directory) {
    throw input_error(place, rejected.message(), "a name that a file can have");
  }
}

void require_fitting_name(const std::string& file, const std::string& option, std::string_view content,
                          std::initializer_list<std::string_view> endings) {
  constexpr std::array known{".html", ".htm",  ".pdf", ".png",  ".jpg", ".jpeg", ".svg", ".csv", ".h5",
                             ".hdf5", ".toml", ".txt", ".json", ".md",  ".xlsx", ".xls", ".doc", ".docx",
                             ".vtu",  ".zip",  ".fmu", ".xml",  ".vtk", ".pvd",  ".mat"};
  std::string ending = std::filesystem::path(file).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  if (std::find(endings.begin(), endings.end(), ending) != endings.end()) return;
  if (std::find(known.begin(), known.end(), ending) == known.end()) return;
  throw input_error(fmt::format("{} {}", option, file), fmt::format("the ending {}", ending),
                    fmt::format("{}, for the output is {}", *endings.begin(), content));
}

}  // namespace railtab
