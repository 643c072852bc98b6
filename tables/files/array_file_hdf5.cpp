#include "railtab/tables/files/array_file_hdf5.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <system_error>
#include <type_traits>
#include <utility>

#include "railtab/runtime/base/text_file.hpp"
#include "railtab/tables/files/array_file_seal.hpp"

namespace railtab::hdf5 {
namespace {

// Files are little-endian; the checksum and the superblock are read as the bytes stand.
static_assert(std::endian::native == std::endian::little);

std::mutex& library_mutex() {
  static std::mutex mutex;
  return mutex;
}

herr_t keep_innermost(unsigned, const H5E_error2_t* error, void* text) {
  if (error->desc != nullptr && *error->desc != '\0') *static_cast<std::string*>(text) = error->desc;
  return 0;
}

std::string innermost_error() {
  std::string text;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, keep_innermost, &text);
  return text;
}

// HDF5 before 1.14.5 loses memory where an object's header is damaged, although nothing of it is open, and says at the
// end of the process that it cannot close itself (HDFGroup/hdf5, issue 3790) unless it may not print errors.
void let_process_end_quietly() {
  static std::once_flag asked;
  std::call_once(asked, [] { std::atexit([] { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }); });
}

}  // namespace

Section::Section() : lock_(library_mutex()) {
  H5Eget_auto2(H5E_DEFAULT, &print_, &print_data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  H5PLget_loading_state(&plugins_);
  H5PLset_loading_state(0);
}

Section::~Section() {
  H5PLset_loading_state(plugins_);
  H5Eset_auto2(H5E_DEFAULT, print_, print_data_);
}

InputError failure(const std::string& place, std::string_view expected) {
  let_process_end_quietly();
  const std::string text = innermost_error();
  return input_error(place, text.empty() ? "an error of HDF5" : fmt::format("\"{}\"", text), expected);
}

ComputationError write_failure(const std::string& place) {
  const std::string text = innermost_error();
  return ComputationError(fmt::format("{}: could not be written: {}", place, text.empty() ? "an error of HDF5" : text));
}

std::string place(const std::filesystem::path& file, std::string_view path) {
  return path.empty() ? file.string() : fmt::format("{}: {}", file.string(), path);
}

std::string place(const std::filesystem::path& file, std::string_view path, std::string_view attribute) {
  return fmt::format("{}, attribute {}", place(file, path), attribute);
}

bool contains(hid_t file, const std::filesystem::path& name, std::string_view path) {
  for (std::size_t end = 0; end != std::string_view::npos;) {
    end = path.find('/', end + 1);
    const std::string prefix(path.substr(0, end));
    if (H5Lexists(file, prefix.c_str(), H5P_DEFAULT) <= 0) return false;
    H5L_info_t link{};
    require(H5Lget_info(file, prefix.c_str(), &link, H5P_DEFAULT) >= 0, place(name, prefix), "a readable link");
    if (link.type == H5L_TYPE_HARD) continue;
    throw input_error(place(name, prefix),
                      link.type == H5L_TYPE_EXTERNAL ? "a link to another file" : "a link to another place",
                      "a dataset or group of this file, without links");
  }
  return true;
}

namespace {

void require_plain(hid_t dataset, const std::string& at) {
  const Properties properties(H5Dget_create_plist(dataset));
  require(properties.valid(), at, "a dataset with a layout");
  constexpr const char* expected = "a dataset that lies in this file as it is, without filters";
  if (H5Pget_layout(properties.get()) == H5D_VIRTUAL) throw input_error(at, "a virtual dataset", expected);
  if (H5Pget_external_count(properties.get()) != 0) throw input_error(at, "values in other files", expected);
  if (H5Pget_nfilters(properties.get()) == 0) return;
  std::array<char, 64> filter{};
  std::size_t values = 0;
  unsigned flags = 0;
  const H5Z_filter_t id =
      H5Pget_filter2(properties.get(), 0, &flags, &values, nullptr, filter.size() - 1, filter.data(), nullptr);
  throw input_error(at, fmt::format("values behind the filter {} ({})", id, filter.data()), expected);
}

}  // namespace

Object open_object(hid_t file, const std::filesystem::path& name, std::string_view path) {
  const std::string at = place(name, path);
  if (!path.empty() && !contains(file, name, path)) {
    throw input_error(at, "no such dataset or group", "one of that name");
  }
  Object object(H5Oopen(file, path.empty() ? "/" : std::string(path).c_str(), H5P_DEFAULT));
  require(object.valid(), at, "a readable dataset or group");
  if (H5Iget_type(object.get()) == H5I_DATASET) require_plain(object.get(), at);
  return object;
}

namespace {

Attribute open_attribute(hid_t object, const std::string& at, const char* name) {
  if (H5Aexists(object, name) <= 0) throw input_error(at, "no such attribute", "one of that name");
  Attribute attribute(H5Aopen(object, name, H5P_DEFAULT));
  require(attribute.valid(), at, "a readable attribute");
  const Space space(H5Aget_space(attribute.get()));
  if (!space.valid() || H5Sget_simple_extent_npoints(space.get()) != 1) {
    throw input_error(at, "an array", "a single value");
  }
  return attribute;
}

}  // namespace

namespace {

/// Of an integer; where `Number` is floating-point, also of a floating-point attribute.
template <typename Number>
Number scalar_attribute(hid_t object, const std::string& at, std::string_view name) {
  constexpr bool integer = std::is_integral_v<Number>;
  const Attribute attribute = open_attribute(object, at, std::string(name).c_str());
  const Type type(H5Aget_type(attribute.get()));
  const H5T_class_t found = type.valid() ? H5Tget_class(type.get()) : H5T_NO_CLASS;
  if (found != H5T_INTEGER && (integer || found != H5T_FLOAT)) {
    throw input_error(at, integer ? "no integer" : "no number", integer ? "an integer" : "a number");
  }
  Number value{};
  require(H5Aread(attribute.get(), integer ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE, &value) >= 0, at, "readable");
  return value;
}

}  // namespace

std::int64_t integer_attribute(hid_t object, const std::string& at, std::string_view name) {
  return scalar_attribute<std::int64_t>(object, at, name);
}

double number_attribute(hid_t object, const std::string& at, std::string_view name) {
  return scalar_attribute<double>(object, at, name);
}

std::string text_attribute(hid_t object, const std::string& at, std::string_view name) {
  const Attribute attribute = open_attribute(object, at, std::string(name).c_str());
  const Type type(H5Aget_type(attribute.get()));
  if (!type.valid() || H5Tget_class(type.get()) != H5T_STRING || H5Tis_variable_str(type.get()) != 0) {
    throw input_error(at, "no text of fixed length", "a text of fixed length");
  }
  constexpr std::size_t longest = 1U << 20U;  // a header of an object, where railtab keeps them, has 64 KiB
  if (H5Tget_size(type.get()) > longest) {
    throw input_error(at, fmt::format("a text of {} bytes", H5Tget_size(type.get())),
                      fmt::format("{} bytes at most", longest));
  }
  std::string value(H5Tget_size(type.get()), '\0');
  require(H5Aread(attribute.get(), type.get(), value.data()) >= 0, at, "a readable text");
  value.resize(value.find_last_not_of('\0') + 1);
  return value;
}

FileState inspect_file(const std::filesystem::path& file) {
  std::error_code error;
  if (!is_file(file)) throw input_error(file.string(), std::string(what_is_at(file)), "an HDF5 file");
  FileState state;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw input_error(file.string(), std::strerror(errno), "a readable file");
  if (is_sealed(file)) {
    check_seal(file);
    stream.seekg(seal_bytes);
  }
  std::array<char, 36> head{};
  stream.read(head.data(), head.size());
  // after the superblock: a writer that ends between the two has extended the file to what the superblock says
  state.bytes = std::filesystem::file_size(file, error);
  if (std::string_view(head.data(), signature.size()) != signature) {
    throw input_error(file.string(), state.bytes == 0 ? "an empty file" : "no HDF5 signature", "an HDF5 file");
  }
  constexpr unsigned char written_format = 3, eight_byte_offsets = 8;
  if (static_cast<unsigned char>(head[8]) != written_format || head[9] != eight_byte_offsets) {
    throw input_error(file.string(),
                      fmt::format("an HDF5 superblock of version {}", static_cast<unsigned char>(head[8])),
                      fmt::format("version {} with 8-byte offsets, as railtab writes it", written_format));
  }
  constexpr unsigned open_for_writing = 1;
  state.being_written = (static_cast<unsigned char>(head[11]) & open_for_writing) != 0;
  std::uint64_t end_of_file = 0;
  std::memcpy(&end_of_file, head.data() + 28, sizeof end_of_file);
  // While a file is written, its end runs ahead of the superblock or behind it; reading then checks dataset by dataset.
  if (!state.being_written && state.bytes < end_of_file) {
    throw input_error(file.string(), fmt::format("{} bytes", state.bytes),
                      fmt::format("{} bytes: the file is cut short", end_of_file));
  }
  return state;
}

Type text_type(std::size_t length) {
  Type type(H5Tcopy(H5T_C_S1));
  const bool done = H5Tset_size(type.get(), length) >= 0 && H5Tset_strpad(type.get(), H5T_STR_NULLPAD) >= 0 &&
                    H5Tset_cset(type.get(), H5T_CSET_UTF8) >= 0;
  require(done, "HDF5 text", "its type");
  return type;
}

Properties group_properties(hid_t kind) {
  Properties properties(H5Pcreate(kind));
  constexpr unsigned always_compact = 65535;
  const bool done = H5Pset_attr_creation_order(properties.get(), H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED) >= 0 &&
                    H5Pset_attr_phase_change(properties.get(), always_compact, 0) >= 0;
  require(done, "HDF5 group creation", "its properties");
  return properties;
}

File open_file(const std::filesystem::path& file, Access access) {
  const Properties properties(H5Pcreate(H5P_FILE_ACCESS));
  const hid_t id = properties.get();
  // Where a checksum of metadata fails, HDF5 reads again, each pause twice the one before: from 1 ns, these many come
  // to 4 ms, which a running writer takes. Its own 100 attempts would wait for ever on a damaged file.
  constexpr unsigned attempts = 22;
  // Checksummed metadata, and no lock of HDF5's own, which many file systems lack.
  bool done = H5Pset_driver(id, file_driver(), nullptr) >= 0 && H5Pset_metadata_read_attempts(id, attempts) >= 0 &&
              H5Pset_libver_bounds(id, H5F_LIBVER_V110, H5F_LIBVER_V110) >= 0 &&
              H5Pset_file_locking(id, false, true) >= 0;
  // Each object of a growing file has pages of its own. A kill can end a write at the edge of a page; an object in one
  // page is written wholly or not at all.
  constexpr hsize_t page = 4096;
  const bool growing = access == Access::create_growing || access == Access::write_growing;
  done = done && (!growing || H5Pset_alignment(id, 1, page) >= 0);
  // What h5clear does to the file of a killed writer: forget that it is being written, and take its size from the file
  // system, since the superblock, written last, may not know of the newest chunks yet.
  const hbool_t yes = true;
  done = done && (access != Access::write_growing ||
                  (H5Pset(id, "clear_status_flags", &yes) >= 0 && H5Pset(id, "skip_eof_check", &yes) >= 0));
  require(done, file.string(), "HDF5 1.10.7 or later");
  switch (access) {
    case Access::read:
      return File(H5Fopen(file.c_str(), H5F_ACC_RDONLY, id));
    case Access::read_growing:
      return File(H5Fopen(file.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, id));
    case Access::write_growing:
      return File(H5Fopen(file.c_str(), H5F_ACC_RDWR | H5F_ACC_SWMR_WRITE, id));
    default:
      break;
  }
  const Properties creation = group_properties(H5P_FILE_CREATE);
  require(growing || H5Pset_userblock(creation.get(), seal_bytes) >= 0, file.string(), "room for the seal");
  return File(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, creation.get(), id));
}

File open_for_reading(const std::filesystem::path& file, FileState& state) {
  constexpr int most_changes = 100;
  for (int attempt = 0;; ++attempt) {
    File handle = open_file(file, state.being_written ? Access::read_growing : Access::read);
    if (handle.valid()) return handle;
    const InputError refused = failure(file.string(), "a whole HDF5 file");
    const bool was_written = std::exchange(state, inspect_file(file)).being_written;
    if (state.being_written == was_written || attempt == most_changes) throw refused;
  }
}

void check_type(hid_t file, const std::filesystem::path& name, std::string_view filetype, int format_version) {
  const Object root = open_object(file, name, "");
  if (H5Aexists(root.get(), "filetype") <= 0) {
    throw input_error(name.string(), "no attribute filetype", fmt::format("a file of type {}", filetype));
  }
  const std::string found = text_attribute(root.get(), place(name, "", "filetype"), "filetype");
  if (found != filetype) {
    throw input_error(name.string(), fmt::format("a file of type {}", found), fmt::format("type {}", filetype));
  }
  const std::int64_t version = integer_attribute(root.get(), place(name, "", "format_version"), "format_version");
  if (version != format_version) {
    throw input_error(name.string(), fmt::format("format version {} of {}", version, filetype),
                      fmt::format("version {}, the one that this program reads", format_version));
  }
}

}  // namespace railtab::hdf5
