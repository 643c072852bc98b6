#include <algorithm>
#include <cstring>
#include <map>

#include "railtab/tables/files/array_file_hdf5.hpp"
#if H5_VERSION_GE(1, 13, 0)
#include <H5FDdevelop.h>
#endif

namespace railtab::hdf5 {
namespace {

H5FD_class_t posix{};  // HDF5's own driver

struct Failure {
  std::string reason;
  /// What was to be written since, oldest first: HDF5 reads it again until it has closed the file.
  std::vector<std::pair<haddr_t, std::vector<char>>> kept;
};
std::map<const void*, Failure> failures;  // by the handle of the open file; a Section guards it

/// What H5Fget_vfd_handle() gives: HDF5 reads the descriptor from it where the name of a file is a symbolic link.
const void* handle_of(H5FD_t* file) {
  void* handle = nullptr;
  return posix.get_handle(file, H5P_DEFAULT, &handle) < 0 ? nullptr : handle;
}

herr_t stop(H5FD_t* file) {
  failures[handle_of(file)].reason = last_error();
  return -1;
}

herr_t read(H5FD_t* file, H5FD_mem_t kind, hid_t transfer, haddr_t address, std::size_t size, void* bytes) {
  if (posix.read(file, kind, transfer, address, size, bytes) < 0) return -1;
  const auto failure = failures.find(handle_of(file));
  if (failure == failures.end()) return 0;
  for (const auto& [begin, values] : failure->second.kept) {
    const haddr_t first = std::max(begin, address), end = std::min(begin + values.size(), address + size);
    if (first < end) std::memcpy(static_cast<char*>(bytes) + (first - address), &values[first - begin], end - first);
  }
  return 0;
}

herr_t write(H5FD_t* file, H5FD_mem_t kind, hid_t transfer, haddr_t address, std::size_t size, const void* bytes) {
  if (const auto failure = failures.find(handle_of(file)); failure != failures.end()) {
    const char* const begin = static_cast<const char*>(bytes);
    failure->second.kept.emplace_back(address, std::vector<char>(begin, begin + size));
    return 0;
  }
  return posix.write(file, kind, transfer, address, size, bytes) >= 0 ? 0 : stop(file);
}

herr_t truncate(H5FD_t* file, hid_t transfer, hbool_t closing) {
  if (failures.contains(handle_of(file))) return 0;
  return posix.truncate(file, transfer, closing) >= 0 ? 0 : stop(file);
}

herr_t close(H5FD_t* file) {
  failures.erase(handle_of(file));
  return posix.close(file);
}

hid_t register_driver() {
  const Properties access(H5Pcreate(H5P_FILE_ACCESS));
  if (H5Pset_fapl_sec2(access.get()) < 0) return H5I_INVALID_HID;
  H5FD_t* const any_file = H5FDopen("/dev/null", H5F_ACC_RDONLY, access.get(), HADDR_UNDEF);
  if (any_file == nullptr) return H5I_INVALID_HID;
  posix = *any_file->cls;
  H5FDclose(any_file);
  H5FD_class_t rules = posix;
  rules.name = "railtab";
  rules.terminate = nullptr;
#if H5_VERSION_GE(1, 13, 0)
  rules.value = 511;  // of those that HDF5 keeps for private use
#endif
  rules.read = read;
  rules.write = write;
  rules.truncate = truncate;
  rules.close = close;
  return H5FDregister(&rules);
}

}  // namespace

hid_t file_driver() {
  static const hid_t id = register_driver();
  return id;
}

std::string write_failure(hid_t file) {
  void* handle = nullptr;
  if (H5Fget_vfd_handle(file, H5P_DEFAULT, &handle) < 0) return {};
  const auto failure = failures.find(handle);
  return failure == failures.end() ? std::string() : failure->second.reason;
}

}  // namespace railtab::hdf5
