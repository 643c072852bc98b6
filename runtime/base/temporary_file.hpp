#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "railtab/runtime/base/writer_lock.hpp"

namespace railtab {

/// What an output is written to before it gets its name: an empty file beside it, FILE.part-<12 random characters>.
struct TemporaryFile {
  std::filesystem::path name;
  WriterLock lock;  ///< of the file, as long as it is written: one without is left over from a process that was ended
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
