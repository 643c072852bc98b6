#pragma once

#include <filesystem>

namespace railtab {

/// A name beside `file` that no other process writes under: FILE.part-<host>-<process>-<n>, n counting from 0.
[[nodiscard]] std::filesystem::path temporary_name(const std::filesystem::path& file);

/// Removes what killed processes of this host left of `file` under such names. What a living process writes stays: its
/// number is taken, and its WriterLock, which also tells where a number belongs to another container, is held. So does
/// everything where the file system has no locks.
void remove_abandoned(const std::filesystem::path& file);

}  // namespace railtab
