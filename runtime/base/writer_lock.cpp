#include "railtab/runtime/base/writer_lock.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace railtab {

namespace {

/// The lock of an open file description: closing another descriptor of the file, as HDF5 does, does not release it.
/// @return 0, or the error
int lock_whole(int descriptor) noexcept {
  struct flock whole {};
  whole.l_type = F_WRLCK;
  whole.l_whence = SEEK_SET;
  return ::fcntl(descriptor, F_OFD_SETLK, &whole) == 0 ? 0 : errno;
}

}  // namespace

WriterLock::WriterLock(const std::filesystem::path& file) : descriptor_(::open(file.c_str(), O_RDWR | O_CLOEXEC)) {
  if (descriptor_ < 0) throw input_error(file.string(), std::strerror(errno), "a file that can be written");
  const int error = lock_whole(descriptor_);
  if (error != EAGAIN && error != EACCES) return;
  ::close(descriptor_);
  throw FileInUse(
      input_error(file.string(), "a file that another run is writing", "one that no run is writing").what());
}

WriterLock WriterLock::if_free(const std::filesystem::path& file) noexcept {
  WriterLock lock;
  lock.descriptor_ = ::open(file.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (lock.held() && lock_whole(lock.descriptor_) != 0) ::close(std::exchange(lock.descriptor_, -1));
  return lock;
}

WriterLock WriterLock::of_descriptor(int descriptor) noexcept {
  WriterLock lock;
  lock.descriptor_ = descriptor;
  const int error = lock_whole(descriptor);
  if (error == EAGAIN || error == EACCES) ::close(std::exchange(lock.descriptor_, -1));
  return lock;
}

bool WriterLock::is_of(const std::filesystem::path& file) const noexcept {
  struct stat locked {};
  struct stat named {};
  if (!held() || ::fstat(descriptor_, &locked) != 0) return true;
  return ::stat(file.c_str(), &named) == 0 && named.st_dev == locked.st_dev && named.st_ino == locked.st_ino;
}

WriterLock::WriterLock(WriterLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

WriterLock& WriterLock::operator=(WriterLock&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

WriterLock::~WriterLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace railtab
