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
  // HDF5 quotes the system's message between file names and addresses.
  constexpr std::string_view before = "error message = '";
  const std::size_t begin = text.find(before);
  if (begin != std::string::npos) {
    text.erase(0, begin + before.size());
    text.erase(std::min(text.find('\''), text.size()));
  }
  return text;
}

}  // namespace

Section::Section() : lock_(library_mutex()) {
  H5Eget_auto2(H5E_DEFAULT, &print_, &print_data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Section::~Section() { H5Eset_auto2(H5E_DEFAULT, print_, print_data_); }

namespace {

// HDF5 before 1.14.5 loses memory where an object's header is damaged, although nothing of it is open, and says at the
// end of the process that it cannot close itself (HDFGroup/hdf5, issue 3790) unless it may not print errors.
void let_process_end_quietly() {
  static std::once_flag asked;
  std::call_once(asked, [] { std::atexit([] { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }); });
}

}  // namespace

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

Properties file_access() {
  Properties access(H5Pcreate(H5P_FILE_ACCESS));
  const bool done = access.valid() && H5Pset_libver_bounds(access.get(), H5F_LIBVER_V110, H5F_LIBVER_V110) >= 0 &&
                    H5Pset_file_locking(access.get(), false, true) >= 0;
  require(done, "HDF5 file access", "its properties");
  return access;
}

void set_page_alignment(const Properties& access, const std::filesystem::path& file) {
  constexpr hsize_t page = 4096;
  require(H5Pset_alignment(access.get(), 1, page) >= 0, file.string(), "HDF5 objects in pages of their own");
}

bool contains(hid_t file, std::string_view path) {
  for (std::size_t end = 0; end != std::string_view::npos;) {
    end = path.find('/', end + 1);
    const std::string prefix(path.substr(0, end));
    if (H5Lexists(file, prefix.c_str(), H5P_DEFAULT) <= 0) return false;
  }
  return H5Oexists_by_name(file, std::string(path).c_str(), H5P_DEFAULT) > 0;
}

Object open_object(hid_t file, const std::filesystem::path& name, std::string_view path) {
  if (!path.empty() && !contains(file, path)) {
    throw input_error(place(name, path), "no such dataset or group", "one of that name");
  }
  Object object(H5Oopen(file, path.empty() ? "/" : std::string(path).c_str(), H5P_DEFAULT));
  require(object.valid(), place(name, path), "a readable dataset or group");
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

std::int64_t integer_attribute(hid_t object, const std::string& at, std::string_view name) {
  const Attribute attribute = open_attribute(object, at, std::string(name).c_str());
  const Type type(H5Aget_type(attribute.get()));
  if (!type.valid() || H5Tget_class(type.get()) != H5T_INTEGER) throw input_error(at, "no integer", "an integer");
  std::int64_t value = 0;
  require(H5Aread(attribute.get(), H5T_NATIVE_INT64, &value) >= 0, at, "a readable integer");
  return value;
}

double number_attribute(hid_t object, const std::string& at, std::string_view name) {
  const Attribute attribute = open_attribute(object, at, std::string(name).c_str());
  const Type type(H5Aget_type(attribute.get()));
  const H5T_class_t found = type.valid() ? H5Tget_class(type.get()) : H5T_NO_CLASS;
  if (found != H5T_INTEGER && found != H5T_FLOAT) throw input_error(at, "no number", "a number");
  double value = 0;
  require(H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, &value) >= 0, at, "a readable number");
  return value;
}

std::string text_attribute(hid_t object, const std::string& at, std::string_view name) {
  const Attribute attribute = open_attribute(object, at, std::string(name).c_str());
  const Type type(H5Aget_type(attribute.get()));
  if (!type.valid() || H5Tget_class(type.get()) != H5T_STRING || H5Tis_variable_str(type.get()) != 0) {
    throw input_error(at, "no text of fixed length", "a text of fixed length");
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
  state.bytes = std::filesystem::file_size(file, error);

  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw input_error(file.string(), std::strerror(errno), "a readable file");
  if (is_sealed(file)) {
    check_seal(file);
    stream.seekg(seal_bytes);
  }
  std::array<char, 36> head{};
  stream.read(head.data(), head.size());
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

File open_for_reading(const std::filesystem::path& file, FileState& state) {
  const Properties access = file_access();
  // Beside a running writer HDF5 repeats a read whose checksum fails, each pause twice the one before: from 1 ns, these
  // many come to 4 ms. Its own 100 attempts would wait for ever on a damaged file.
  constexpr unsigned attempts = 22;
  require(H5Pset_metadata_read_attempts(access.get(), attempts) >= 0, file.string(), "HDF5 1.10 or later");
  while (true) {
    const unsigned flags = H5F_ACC_RDONLY | (state.being_written ? H5F_ACC_SWMR_READ : 0U);
    File handle(H5Fopen(file.c_str(), flags, access.get()));
    if (handle.valid()) return handle;
    const InputError refused = failure(file.string(), "a whole HDF5 file");
    const bool was_written = std::exchange(state, inspect_file(file)).being_written;
    if (state.being_written == was_written) throw refused;
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
