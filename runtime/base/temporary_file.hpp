#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "railtab/runtime/base/writer_lock.hpp"

namespace railtab {

/// What follows the name of an output in that of what is written before it gets its name.
inline constexpr std::string_view temporary_mark = ".part-";

/// What an output is written to before it gets its name: an empty file beside it, FILE.part-<12 random characters>.
/// Removed with this object, unless it got its name.
struct TemporaryFile {
  std::filesystem::path name;  ///< empty where there is none, or it has got its name
  WriterLock lock;  ///< of the file, as long as it is written: one without is left over from a process that was ended

  TemporaryFile() = default;
  TemporaryFile(std::filesystem::path file, WriterLock writer) : name(std::move(file)), lock(std::move(writer)) {}
  TemporaryFile(TemporaryFile&& other) noexcept { swap(other); }
  TemporaryFile& operator=(TemporaryFile other) noexcept {
    swap(other);
    return *this;
  }
  ~TemporaryFile();
  /// Hands the contents to the disk and renames the file to `file`; the lock stays.
  /// @throws ComputationError where the disk is full, InputError where `file` cannot be replaced
  void publish(const std::filesystem::path& file);

 private:
  void swap(TemporaryFile& other) noexcept {
    name.swap(other.name);
    std::swap(lock, other.lock);
  }
};

/// Creates the temporary file of an output, anew (nothing under that name is overwritten, and no link followed) and
/// locked, after remove_abandoned(). @param file as output_file() gives it
/// @throws InputError where no file can be created there, ComputationError where the disk is full
[[nodiscard]] TemporaryFile create_temporary(const std::filesystem::path& file);

/// Removes the temporary files of `file` that no writer holds locked: their processes have ended, killed perhaps.
/// Where the file system has no locks, they all stay.
void remove_abandoned(const std::filesystem::path& file);

/// The same for all outputs in a folder whose names `is_output` knows.
void remove_abandoned_in(const std::filesystem::path& folder, const std::function<bool(const std::string&)>& is_output);

}  // namespace railtab
