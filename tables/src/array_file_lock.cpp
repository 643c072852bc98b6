#include "array_file_lock.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "railtab/tables/input_error.hpp"

namespace railtab {

WriterLock::WriterLock(const std::filesystem::path& file) : descriptor_(::open(file.c_str(), O_RDWR | O_CLOEXEC)) {
  if (descriptor_ < 0) throw input_error(file.string(), std::strerror(errno), "a file that can be written");
  // The lock of an open file description: closing another descriptor of the file, as HDF5 does, does not release it.
  struct flock whole {};
  whole.l_type = F_WRLCK;
  whole.l_whence = SEEK_SET;
  if (::fcntl(descriptor_, F_OFD_SETLK, &whole) == 0) return;
  if (errno == EAGAIN || errno == EACCES) {
    ::close(descriptor_);
    throw input_error(file.string(), "a file that another run is writing", "one that no run is writing");
  }
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
