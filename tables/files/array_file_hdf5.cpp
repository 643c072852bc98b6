#include "railtab/tables/files/array_file_hdf5.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstdlib>
#include <type_traits>

#include "railtab/tables/files/array_file_seal.hpp"

namespace railtab::hdf5 {
namespace {

// Files are little-endian; numbers, the checksum and the superblock are read and written as the bytes stand.
static_assert(std::endian::native == std::endian::little);

std::mutex& library_mutex() {
  static std::mutex mutex;
  return mutex;
}

herr_t keep_innermost(unsigned, const H5E_error2_t* error, void* text) {
  if (error->desc != nullptr && *error->desc != '\0') *static_cast<std::string*>(text) = error->desc;
  return 0;
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

std::string last_error() {
  let_process_end_quietly();
  std::string text;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, keep_innermost, &text);
  // Of a file that cannot be written or read, HDF5 quotes the system among addresses and times.
  constexpr std::string_view quote = "error message = '";
  if (const std::size_t begin = text.find(quote); begin != std::string::npos) {
    text = text.substr(begin + quote.size(), text.find('\'', begin + quote.size()) - begin - quote.size());
  }
  return text.empty() ? "an error of HDF5" : text;
}

void require(bool done, const std::string& place, std::string_view expected) {
  if (!done) throw input_error(place, fmt::format("\"{}\"", last_error()), expected);
}

std::vector<hsize_t> extent_of(hid_t dataset, const std::string& place) {
  const Space space(H5Dget_space(dataset));
  const int rank = space.valid() ? H5Sget_simple_extent_ndims(space.get()) : -1;
  require(rank >= 0, place, "a dataset with a shape");
  std::vector<hsize_t> extent(static_cast<std::size_t>(rank));
  H5Sget_simple_extent_dims(space.get(), extent.data(), nullptr);
  return extent;
}

Rows::Rows(hid_t dataset, const std::vector<hsize_t>& extent, hsize_t first)
    : file(H5Dget_space(dataset)),
      memory(extent.empty() ? H5Screate(H5S_SCALAR)
                            : H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr)) {
  if (extent.empty()) return;
  std::vector<hsize_t> start(extent.size(), 0);
  start[0] = first;
  if (H5Sselect_hyperslab(file.get(), H5S_SELECT_SET, start.data(), nullptr, extent.data(), nullptr) < 0) file = {};
}

namespace {

Properties access_properties(const std::filesystem::path& file, Access access) {
  Properties properties(H5Pcreate(H5P_FILE_ACCESS));
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
  return properties;
}

}  // namespace

OpenFile::OpenFile(std::filesystem::path name, const std::filesystem::path& file, Access access)
    : name_(std::move(name)) {
  const Properties properties = access_properties(name_, access);
  if (access == Access::read) {  // as one that a writer may have open; others can be read so too
    handle_ = File(H5Fopen(file.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, properties.get()));
    require(valid(), name_.string(), "a whole HDF5 file");
  } else if (access == Access::write_growing) {
    handle_ = File(H5Fopen(file.c_str(), H5F_ACC_RDWR | H5F_ACC_SWMR_WRITE, properties.get()));
    require(valid() && H5Fincrement_filesize(get(), 0) >= 0, name_.string(), "a file that can be written");
  } else {
    const Properties creation = group_properties(H5P_FILE_CREATE);
    const bool room = access == Access::create_growing || H5Pset_userblock(creation.get(), seal_bytes) >= 0;
    if (room) handle_ = File(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, creation.get(), properties.get()));
    // The file is there already (TemporaryFile): what fails is the disk, not the name.
    if (!valid()) throw ComputationError(fmt::format("{}: could not be written: {}", name_.string(), last_error()));
  }
}

std::string OpenFile::place(std::string_view path) const {
  return path.empty() ? name_.string() : fmt::format("{}: {}", name_.string(), path);
}

std::string OpenFile::place(std::string_view path, std::string_view attribute) const {
  return fmt::format("{}, attribute {}", place(path), attribute);
}

bool OpenFile::contains(std::string_view path) const {
  for (std::size_t end = 0; end != std::string_view::npos;) {
    end = path.find('/', end + 1);
    const std::string prefix(path.substr(0, end));
    if (H5Lexists(get(), prefix.c_str(), H5P_DEFAULT) <= 0) return false;
    H5L_info_t link{};
    require(H5Lget_info(get(), prefix.c_str(), &link, H5P_DEFAULT) >= 0, place(prefix), "a readable link");
    if (link.type == H5L_TYPE_HARD) continue;
    throw input_error(place(prefix),
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
  const H5Z_filter_t id =
      H5Pget_filter2(properties.get(), 0, nullptr, &values, nullptr, filter.size() - 1, filter.data(), nullptr);
  throw input_error(at, fmt::format("values behind the filter {} ({})", id, filter.data()), expected);
}

}  // namespace

Object OpenFile::object(std::string_view path) const {
  const std::string at = place(path);
  if (!path.empty() && !contains(path)) throw input_error(at, "no such dataset or group", "one of that name");
  Object object(H5Oopen(get(), path.empty() ? "/" : std::string(path).c_str(), H5P_DEFAULT));
  require(object.valid(), at, "a readable dataset or group");
  if (H5Iget_type(object.get()) == H5I_DATASET) require_plain(object.get(), at);
  return object;
}

bool OpenFile::has(std::string_view path, const char* attribute) const {
  return H5Aexists(object(path).get(), attribute) > 0;
}

Attribute OpenFile::open_attribute(std::string_view path, const char* name, hssize_t most) const {
  const std::string at = place(path, name);
  if (!has(path, name)) throw input_error(at, "no such attribute", "one of that name");
  Attribute attribute(H5Aopen(object(path).get(), name, H5P_DEFAULT));
  require(attribute.valid(), at, "a readable attribute");
  const Space space(H5Aget_space(attribute.get()));
  const hssize_t values = space.valid() ? H5Sget_simple_extent_npoints(space.get()) : 0;
  if (values >= 1 && values <= most) return attribute;
  throw input_error(at, "an array", most == 1 ? "a single value" : fmt::format("a row of {} values at most", most));
}

template <typename Number>
Number OpenFile::number(std::string_view path, const char* name) const {
  constexpr bool integer = std::is_integral_v<Number>;
  const Attribute attribute = open_attribute(path, name);
  const Type type(H5Aget_type(attribute.get()));
  const H5T_class_t found = type.valid() ? H5Tget_class(type.get()) : H5T_NO_CLASS;
  if (found != H5T_INTEGER && (integer || found != H5T_FLOAT)) {
    throw input_error(place(path, name), integer ? "no integer" : "no number", integer ? "an integer" : "a number");
  }
  Number value{};
  const hid_t memory = integer ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE;
  require(H5Aread(attribute.get(), memory, &value) >= 0, place(path, name), "a readable attribute");
  return value;
}

std::vector<std::int64_t> OpenFile::integers(std::string_view path, const char* name) const {
  constexpr hssize_t most = 16;
  const Attribute attribute = open_attribute(path, name, most);
  const Type type(H5Aget_type(attribute.get()));
  const Space space(H5Aget_space(attribute.get()));
  if (!type.valid() || H5Tget_class(type.get()) != H5T_INTEGER) {
    throw input_error(place(path, name), "no integers", "integers");
  }
  std::vector<std::int64_t> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.get())));
  require(H5Aread(attribute.get(), H5T_NATIVE_INT64, values.data()) >= 0, place(path, name), "a readable attribute");
  return values;
}

template std::int64_t OpenFile::number(std::string_view path, const char* name) const;
template double OpenFile::number(std::string_view path, const char* name) const;

std::string OpenFile::text(std::string_view path, const char* name) const {
  const Attribute attribute = open_attribute(path, name);
  const std::string at = place(path, name);
  const Type type(H5Aget_type(attribute.get()));
  if (!type.valid() || H5Tget_class(type.get()) != H5T_STRING || H5Tis_variable_str(type.get()) != 0) {
    throw input_error(at, "no text of fixed length", "a text of fixed length");
  }
  constexpr std::size_t longest = 1U << 20U;  // a header of an object, where railtab keeps them, has 64 KiB
  const std::size_t bytes = H5Tget_size(type.get());
  if (bytes > longest) {
    throw input_error(at, fmt::format("a text of {} bytes", bytes), fmt::format("{} bytes at most", longest));
  }
  std::string value(bytes, '\0');
  require(H5Aread(attribute.get(), type.get(), value.data()) >= 0, at, "a readable text");
  value.resize(value.find_last_not_of('\0') + 1);
  return value;
}

Type text_type(std::size_t length, H5T_cset_t letters) {
  Type type(H5Tcopy(H5T_C_S1));
  const bool done = H5Tset_size(type.get(), length) >= 0 && H5Tset_strpad(type.get(), H5T_STR_NULLPAD) >= 0 &&
                    H5Tset_cset(type.get(), letters) >= 0;
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

}  // namespace railtab::hdf5
