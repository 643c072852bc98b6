#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iterator>
#include <memory>
#include <utility>
#include <vector>

#include "railtab/tables/files/array_file_hdf5.hpp"
#if H5_VERSION_GE(1, 13, 0)
#include <H5FDdevelop.h>
#endif

namespace railtab::hdf5 {
namespace {

/// A file as HDF5's own driver for POSIX has it, but for two rules. After a write that failed, every other one fails
/// too, until what HDF5 still has to write is kept in memory: it tries again when the file is closed, piece by piece,
/// which would leave a mixture. And values beyond the end of a file that is read are an error: HDF5's driver gives
/// zeros.
struct DriverFile {
  H5FD_t base{};  ///< first: HDF5 knows the file by it
  int descriptor = -1;
  struct stat identity {};
  haddr_t end_of_addresses = 0;
  bool writable = false;
  int error = 0;                                            ///< of the write that failed: each later one fails too
  bool stopped = false;                                     ///< what HDF5 writes stays in memory
  std::vector<std::pair<haddr_t, std::vector<char>>> kept;  ///< oldest first
};

DriverFile& of(H5FD_t* file) { return *reinterpret_cast<DriverFile*>(file); }
const DriverFile& of(const H5FD_t* file) { return *reinterpret_cast<const DriverFile*>(file); }

herr_t report(const char* what) {
  H5Epush2(H5E_DEFAULT, __FILE__, __func__, __LINE__, H5E_ERR_CLS, H5E_IO, H5E_SYSERRSTR, "%s", what);
  return -1;
}

herr_t fail(DriverFile& file) {
  if (file.error == 0) file.error = errno;
  return report(std::strerror(file.error));
}

/// What was not written, as HDF5 expects to find it until it has closed the file.
void read_kept(const DriverFile& file, haddr_t address, std::size_t size, char* bytes) {
  for (const auto& [begin, values] : file.kept) {
    const haddr_t first = std::max(begin, address), end = std::min(begin + values.size(), address + size);
    if (first < end) std::memcpy(bytes + (first - address), values.data() + (first - begin), end - first);
  }
}

H5FD_t* open(const char* name, unsigned flags, hid_t, haddr_t) {
  auto file = std::make_unique<DriverFile>();
  file->writable = (flags & H5F_ACC_RDWR) != 0;
  // A new file is there already, empty and locked (create_temporary).
  const int begin = (flags & H5F_ACC_TRUNC) != 0 ? O_TRUNC | O_NOFOLLOW : 0;
  file->descriptor = ::open(name, (file->writable ? O_RDWR : O_RDONLY) | begin | O_CLOEXEC);
  if (file->descriptor < 0 || ::fstat(file->descriptor, &file->identity) != 0) {
    report(std::strerror(errno));
    if (file->descriptor >= 0) ::close(file->descriptor);
    return nullptr;
  }
  return &file.release()->base;
}

herr_t close(H5FD_t* base) {
  const std::unique_ptr<DriverFile> file(&of(base));
  return ::close(file->descriptor) == 0 || file->stopped ? 0 : report(std::strerror(errno));
}

int compare(const H5FD_t* a, const H5FD_t* b) {
  const struct stat &p = of(a).identity, &q = of(b).identity;
  if (p.st_dev != q.st_dev) return p.st_dev < q.st_dev ? -1 : 1;
  return p.st_ino < q.st_ino ? -1 : static_cast<int>(p.st_ino > q.st_ino);
}

herr_t query(const H5FD_t*, unsigned long* features) {
  *features = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
              H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_SUPPORTS_SWMR_IO | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  return 0;
}

haddr_t get_eoa(const H5FD_t* file, H5FD_mem_t) { return of(file).end_of_addresses; }

herr_t set_eoa(H5FD_t* file, H5FD_mem_t, haddr_t address) {
  of(file).end_of_addresses = address;
  return 0;
}

haddr_t get_eof(const H5FD_t* file, H5FD_mem_t) {
  struct stat now {};
  return ::fstat(of(file).descriptor, &now) == 0 ? static_cast<haddr_t>(now.st_size) : HADDR_UNDEF;
}

herr_t get_handle(H5FD_t* file, hid_t, void** stopped) {
  *stopped = &of(file).stopped;
  return 0;
}

herr_t read(H5FD_t* base, H5FD_mem_t type, hid_t, haddr_t address, std::size_t size, void* buffer) {
  const DriverFile& file = of(base);
  auto* const bytes = static_cast<char*>(buffer);
  std::size_t done = 0;
  while (done < size) {
    const ssize_t count = ::pread(file.descriptor, bytes + done, size - done, static_cast<off_t>(address + done));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return report(std::strerror(errno));
    if (count == 0 && type == H5FD_MEM_DRAW && !file.writable) return report("values beyond the end of the file");
    if (count == 0) std::memset(bytes + done, 0, size - done);
    done = count == 0 ? size : done + static_cast<std::size_t>(count);
  }
  read_kept(file, address, size, bytes);
  return 0;
}

herr_t write(H5FD_t* base, H5FD_mem_t, hid_t, haddr_t address, std::size_t size, const void* buffer) {
  DriverFile& file = of(base);
  const auto* bytes = static_cast<const char*>(buffer);
  if (file.stopped) {
    file.kept.emplace_back(address, std::vector<char>(bytes, bytes + size));
    return 0;
  }
  while (size > 0) {
    const ssize_t count = file.error != 0 ? -1 : ::pwrite(file.descriptor, bytes, size, static_cast<off_t>(address));
    if (count < 0 && file.error == 0 && errno == EINTR) continue;
    if (count < 0) return fail(file);
    bytes += count;
    address += static_cast<haddr_t>(count);
    size -= static_cast<std::size_t>(count);
  }
  return 0;
}

herr_t truncate(H5FD_t* base, hid_t, hbool_t) {
  DriverFile& file = of(base);
  if (file.stopped || get_eof(base, H5FD_MEM_DEFAULT) == file.end_of_addresses) return 0;
  if (file.error != 0 || ::ftruncate(file.descriptor, static_cast<off_t>(file.end_of_addresses)) != 0)
    return fail(file);
  return 0;
}

// Writers hold a WriterLock. HDF5 marks a file as being written only where its driver has locks.
herr_t lock(H5FD_t*, hbool_t) { return 0; }
herr_t unlock(H5FD_t*) { return 0; }

H5FD_class_t driver() {
  H5FD_class_t rules{};
#if H5_VERSION_GE(1, 13, 0)
  rules.version = H5FD_CLASS_VERSION;
  rules.value = 511;  // of those that HDF5 keeps for private use
#endif
  rules.name = "railtab";
  rules.maxaddr = (haddr_t{1} << 63U) - 1;
  rules.fc_degree = H5F_CLOSE_WEAK;
  rules.open = open;
  rules.close = close;
  rules.cmp = compare;
  rules.query = query;
  rules.get_eoa = get_eoa;
  rules.set_eoa = set_eoa;
  rules.get_eof = get_eof;
  rules.get_handle = get_handle;
  rules.read = read;
  rules.write = write;
  rules.truncate = truncate;
  rules.lock = lock;
  rules.unlock = unlock;
  constexpr H5FD_mem_t kinds[] = H5FD_FLMAP_DICHOTOMY;  // raw data apart from metadata
  std::copy(std::begin(kinds), std::end(kinds), rules.fl_map);
  return rules;
}

}  // namespace

hid_t file_driver() {
  static const H5FD_class_t rules = driver();
  static const hid_t id = H5FDregister(&rules);
  return id;
}

void stop_writing(hid_t file) {
  void* stopped = nullptr;
  if (H5Fget_vfd_handle(file, H5P_DEFAULT, &stopped) >= 0) *static_cast<bool*>(stopped) = true;
}

}  // namespace railtab::hdf5
