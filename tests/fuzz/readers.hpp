#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace railtab::fuzz {

/// A reader of files from outside and what takes its answer, for fuzzing: whatever the bytes, it returns or throws
/// InputError.
struct Reader {
  std::string name;       ///< of its folder of seeds and of its fuzzing program
  std::string extension;  ///< that the reader goes by
  void (*read)(const std::filesystem::path& file);
  /// Writes the seed of a binary format; null where the seeds are committed in tests/fuzz/seeds.
  void (*write_seed)(const std::filesystem::path& file) = nullptr;
  /// Lines that a mutation may put in; null: none but those of the seeds.
  std::string (*vocabulary)() = nullptr;
};

[[nodiscard]] const std::vector<Reader>& readers();
/// @throws InputError where there is none of that name.
[[nodiscard]] const Reader& reader(const std::string& name);

/// Writes the bytes to a file of this process, in a folder with the files that a scene may name
/// (tests/fuzz/companions), and reads it. False where it was rejected; anything but an InputError goes on to the
/// caller.
bool accepts(const Reader& reader, const std::string& bytes);

}  // namespace railtab::fuzz
