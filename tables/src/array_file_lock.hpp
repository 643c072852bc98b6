#pragma once

#include <filesystem>

namespace railtab {

/// Keeps a second process from writing the same growing file; released by the end of the process, however it ends.
class WriterLock {
 public:
  WriterLock() = default;
  /// @throws InputError where another writer holds the file, or it cannot be opened for writing. Where the file system
  /// has no locks, there is no protection.
  explicit WriterLock(const std::filesystem::path& file);
  WriterLock(WriterLock&& other) noexcept;
  WriterLock& operator=(WriterLock&& other) noexcept;
  ~WriterLock();

 private:
  int descriptor_ = -1;
};

}  // namespace railtab
