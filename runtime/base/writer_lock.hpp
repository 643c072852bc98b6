#pragma once

#include <filesystem>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

/// Another process is writing the file.
class FileInUse : public InputError {
 public:
  using InputError::InputError;
};

/// Keeps a second process from writing the same growing file, and one from removing another's; released by the end of
/// the process, however it ends.
class WriterLock {
 public:
  WriterLock() = default;
  /// @throws FileInUse where another writer holds the file, InputError where it cannot be opened for writing. Where the
  /// file system has no locks, there is no protection.
  explicit WriterLock(const std::filesystem::path& file);
  /// Not held where another writer holds the file, it cannot be opened for writing, or the file system has no locks.
  [[nodiscard]] static WriterLock if_free(const std::filesystem::path& file) noexcept;
  /// Of an open file, whose descriptor it takes over. Not held where another writer holds the file; where the file
  /// system has no locks, there is no protection.
  [[nodiscard]] static WriterLock of_descriptor(int descriptor) noexcept;
  [[nodiscard]] bool held() const noexcept { return descriptor_ >= 0; }
  /// Whether this is the file of the lock; true where the lock is not held.
  [[nodiscard]] bool is_of(const std::filesystem::path& file) const noexcept;
  /// Of the file, open for writing; -1 where the lock is not held.
  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }
  WriterLock(WriterLock&& other) noexcept;
  WriterLock& operator=(WriterLock&& other) noexcept;
  ~WriterLock();

 private:
  int descriptor_ = -1;
};

}  // namespace railtab
