#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <limits>
#include <system_error>

#include "array_file_seal.hpp"
#include "array_file_writer.hpp"
#include "railtab/tables/text_file.hpp"

namespace railtab {

using hdf5::place;
using hdf5::require;

namespace {

/// Groups that keep their attributes in the order of creation, and in the object header, whose checksum covers them.
hdf5::Properties group_properties(hid_t kind) {
  hdf5::Properties properties(H5Pcreate(kind));
  constexpr unsigned always_compact = 65535;
  const bool done = H5Pset_attr_creation_order(properties.get(), H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED) >= 0 &&
                    H5Pset_attr_phase_change(properties.get(), always_compact, 0) >= 0;
  require(done, "HDF5 group creation", "its properties");
  return properties;
}

/// Rows of a chunk: about 16 KiB, so that short runs stay small files; at least 8, so that the index of a long run
/// stays small too (up to 8180 chunks each of its blocks fits in a page).
hsize_t chunk_rows(std::size_t row_size) {
  constexpr std::size_t chunk_values = 2048, fewest = 8;
  return std::max(fewest, chunk_values / row_size);
}

std::filesystem::path temporary_name(const std::filesystem::path& file) {
  static std::atomic<unsigned> count{0};
  std::filesystem::path name = file;
  name += fmt::format(".part-{}-{}", ::getpid(), count++);
  return name;
}

/// To the disk itself, so that the new name never stands for a file that a power failure emptied.
void synchronise(const std::filesystem::path& path, int flags) {
  const int descriptor = ::open(path.c_str(), flags | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

ArrayFileWriter::Impl::~Impl() {
  if (temporary.empty()) return;
  growing.clear();
  records_dataset = {};
  static_cast<void>(handle.reset());
  std::error_code ignored;
  std::filesystem::remove(temporary, ignored);
}

void ArrayFileWriter::Impl::create(std::string_view filetype, int format_version) {
  file = output_file(file);
  if (mode == Mode::growing && std::filesystem::exists(file)) static_cast<void>(WriterLock(file));
  temporary = temporary_name(file);
  const hdf5::Properties access = hdf5::file_access();
  const hdf5::Properties creation = group_properties(H5P_FILE_CREATE);
  if (mode == Mode::growing) {
    hdf5::set_page_alignment(access, file);
  } else {
    require(H5Pset_userblock(creation.get(), seal_bytes) >= 0, file.string(), "room for the seal");
  }
  handle = hdf5::File(H5Fcreate(temporary.c_str(), H5F_ACC_EXCL, creation.get(), access.get()));
  if (!handle.valid()) {
    temporary.clear();
    throw hdf5::failure(file.string(), "a file that can be created");
  }
  write_text("", "filetype", filetype, 0);
  const std::int64_t version = format_version;
  write_attribute("", "format_version", H5T_STD_I64LE, H5T_NATIVE_INT64, &version);
  if (mode == Mode::whole_or_nothing) return;
  const std::int64_t none = 0;
  write_dataset(hdf5::records_dataset, H5T_STD_I64LE, H5T_NATIVE_INT64, &none, {}, "1",
                "rows of the growing datasets that are valid");
}

void ArrayFileWriter::Impl::create_groups_of(std::string_view path) {
  for (std::size_t end = path.find('/'); end != std::string_view::npos; end = path.find('/', end + 1)) {
    create_group(std::string(path.substr(0, end)));
  }
}

void ArrayFileWriter::Impl::create_group(const std::string& path) {
  if (H5Lexists(handle.get(), path.c_str(), H5P_DEFAULT) > 0) return;
  const hdf5::Properties properties = group_properties(H5P_GROUP_CREATE);
  const hdf5::Group group(H5Gcreate2(handle.get(), path.c_str(), H5P_DEFAULT, properties.get(), H5P_DEFAULT));
  require(group.valid(), place(file, path), "a group that can be created");
}

hdf5::Dataset ArrayFileWriter::Impl::create_dataset(std::string_view path, hid_t type, hid_t space, hid_t properties) {
  assert(!temporary.empty() && "nothing can be created once records have begun");
  create_groups_of(path);
  hdf5::Dataset dataset(
      H5Dcreate2(handle.get(), std::string(path).c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT));
  require(dataset.valid(), place(file, path), "a dataset that can be created");
  return dataset;
}

void ArrayFileWriter::Impl::write_dataset(std::string_view path, hid_t file_type, hid_t memory_type, const void* values,
                                          const std::vector<std::size_t>& shape, std::string_view unit,
                                          std::string_view description) {
  const std::vector<hsize_t> extent(shape.begin(), shape.end());
  const hdf5::Space space(shape.empty() ? H5Screate(H5S_SCALAR)
                                        : H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr));
  const hdf5::Dataset dataset = create_dataset(path, file_type, space.get(), H5P_DEFAULT);
  if (std::find(shape.begin(), shape.end(), 0U) == shape.end()) {
    require(H5Dwrite(dataset.get(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0, place(file, path),
            "room for the values");
  }
  write_text(path, "unit", unit, 0);
  write_text(path, "description", description, 0);
}

hdf5::Dataset ArrayFileWriter::Impl::create_extendible(std::string_view path, const std::vector<hsize_t>& extent,
                                                       std::string_view unit, std::string_view description) {
  std::vector<hsize_t> limit = extent;
  limit[0] = H5S_UNLIMITED;
  std::vector<hsize_t> chunk = extent;
  std::size_t row_size = 1;
  for (std::size_t i = 1; i < extent.size(); ++i) row_size *= extent[i];
  chunk[0] = chunk_rows(row_size);
  const int rank = static_cast<int>(extent.size());
  const hdf5::Space space(H5Screate_simple(rank, extent.data(), limit.data()));
  const hdf5::Properties properties(H5Pcreate(H5P_DATASET_CREATE));
  const double missing = std::numeric_limits<double>::quiet_NaN();
  const bool done = H5Pset_chunk(properties.get(), rank, chunk.data()) >= 0 &&
                    H5Pset_fill_value(properties.get(), H5T_NATIVE_DOUBLE, &missing) >= 0;
  require(done, place(file, path), "chunks");
  hdf5::Dataset dataset = create_dataset(path, H5T_IEEE_F64LE, space.get(), properties.get());
  write_text(path, "unit", unit, 0);
  write_text(path, "description", description, 0);
  return dataset;
}

void ArrayFileWriter::Impl::write_attribute(std::string_view path, std::string_view name, hid_t file_type,
                                            hid_t memory_type, const void* value) {
  const std::string at = place(file, path, name);
  const std::string key(name);
  create_groups_of(path);
  if (!path.empty()) create_group(std::string(path));
  const hdf5::Object object = hdf5::open_object(handle.get(), file, path);
  hdf5::Attribute attribute;
  if (H5Aexists(object.get(), key.c_str()) > 0) {
    attribute = hdf5::Attribute(H5Aopen(object.get(), key.c_str(), H5P_DEFAULT));
  } else {
    assert(!temporary.empty() && "nothing can be created once records have begun");
    const hdf5::Space space(H5Screate(H5S_SCALAR));
    attribute =
        hdf5::Attribute(H5Acreate2(object.get(), key.c_str(), file_type, space.get(), H5P_DEFAULT, H5P_DEFAULT));
  }
  require(attribute.valid() && H5Awrite(attribute.get(), memory_type, value) >= 0, at,
          "an attribute that can be written");
}

void ArrayFileWriter::Impl::write_text(std::string_view path, std::string_view name, std::string_view value,
                                       std::size_t capacity) {
  const std::string key(name);
  std::size_t room = std::max({value.size(), capacity, std::size_t{1}});
  if (path.empty() || hdf5::contains(handle.get(), path)) {
    const hdf5::Object object = hdf5::open_object(handle.get(), file, path);
    if (H5Aexists(object.get(), key.c_str()) > 0) {
      const hdf5::Attribute present(H5Aopen(object.get(), key.c_str(), H5P_DEFAULT));
      const hdf5::Type type(H5Aget_type(present.get()));
      room = H5Tget_size(type.get());
    }
  }
  std::string bytes(value);
  constexpr std::string_view cut = "...";
  if (bytes.size() > room) bytes.replace(room - std::min(room, cut.size()), std::string::npos, cut);
  bytes.resize(room, '\0');
  const hdf5::Type type(H5Tcopy(H5T_C_S1));
  const bool done = H5Tset_size(type.get(), room) >= 0 && H5Tset_strpad(type.get(), H5T_STR_NULLPAD) >= 0 &&
                    H5Tset_cset(type.get(), H5T_CSET_UTF8) >= 0;
  require(done, place(file, path, name), "a text type");
  write_attribute(path, name, type.get(), type.get(), bytes.data());
}

void ArrayFileWriter::Impl::begin_records() {
  assert(mode == Mode::growing);
  if (temporary.empty()) return;
  growing.clear();
  require(handle.reset(), file.string(), "a file that can be written");
  if (std::filesystem::exists(file)) static_cast<void>(WriterLock(file));
  lock = WriterLock(temporary);
  publish();
  open_records();
}

namespace {

herr_t keep_growing(hid_t group, const char* name, const H5L_info_t* link, void* paths) {
  if (link->type != H5L_TYPE_HARD) return 0;
  if (H5Aexists_by_name(group, name, hdf5::rows_attribute, H5P_DEFAULT) > 0) {
    static_cast<std::vector<std::string>*>(paths)->emplace_back(name);
  }
  return 0;
}

}  // namespace

void ArrayFileWriter::Impl::open_for_writing() {
  const hdf5::Properties access = hdf5::file_access();
  hdf5::set_page_alignment(access, file);
  // What h5clear does to the file of a killed writer: forget that it is being written, and take its size from the file
  // system, since the superblock, written last, may not know of the newest chunks yet.
  const hbool_t yes = true;
  const bool set =
      H5Pset(access.get(), "clear_status_flags", &yes) >= 0 && H5Pset(access.get(), "skip_eof_check", &yes) >= 0;
  require(set, file.string(), "HDF5 1.10 or later");
  handle = hdf5::File(H5Fopen(file.c_str(), H5F_ACC_RDWR | H5F_ACC_SWMR_WRITE, access.get()));
  require(handle.valid() && H5Fincrement_filesize(handle.get(), 0) >= 0, file.string(), "a file that can be written");
}

void ArrayFileWriter::Impl::open_records() {
  open_for_writing();
  records_dataset = hdf5::Dataset(H5Dopen2(handle.get(), hdf5::records_dataset, H5P_DEFAULT));
  std::int64_t count = -1;
  const bool read = records_dataset.valid() &&
                    H5Dread(records_dataset.get(), H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &count) >= 0;
  require(read && count >= 0, place(file, hdf5::records_dataset), "the number of records");
  records = static_cast<std::size_t>(count);

  std::vector<std::string> paths;
  require(H5Lvisit(handle.get(), H5_INDEX_NAME, H5_ITER_INC, keep_growing, &paths) >= 0, file.string(), "its datasets");
  for (const std::string& path : paths) {
    Growing entry;
    entry.dataset = hdf5::Dataset(H5Dopen2(handle.get(), path.c_str(), H5P_DEFAULT));
    const hdf5::Space space(entry.dataset.valid() ? H5Dget_space(entry.dataset.get()) : -1);
    const int rank = space.valid() ? H5Sget_simple_extent_ndims(space.get()) : 0;
    require(rank > 0, place(file, path), "a growing dataset");
    entry.extent.resize(static_cast<std::size_t>(rank));
    H5Sget_simple_extent_dims(space.get(), entry.extent.data(), nullptr);
    for (std::size_t i = 1; i < entry.extent.size(); ++i) entry.row_size *= entry.extent[i];
    if (entry.extent[0] < records) {
      throw input_error(place(file, path), fmt::format("{} rows", entry.extent[0]), fmt::format("{} rows", records));
    }
    entry.rows = records;
    growing.emplace(path, std::move(entry));
  }
}

void ArrayFileWriter::Impl::make_room(const std::string& path, Growing& dataset, std::size_t rows) const {
  if (dataset.extent[0] >= rows) return;
  dataset.extent[0] = rows;
  require(H5Dset_extent(dataset.dataset.get(), dataset.extent.data()) >= 0, place(file, path), "room for more rows");
}

void ArrayFileWriter::Impl::cut_to_rows() {
  for (auto& [path, entry] : growing) {
    if (entry.extent[0] == entry.rows) continue;
    entry.extent[0] = entry.rows;
    require(H5Dset_extent(entry.dataset.get(), entry.extent.data()) >= 0, place(file, path),
            "rows that can be cut off");
  }
}

void ArrayFileWriter::Impl::commit() {
  const std::int64_t count = static_cast<std::int64_t>(records);
  const bool done = H5Dwrite(records_dataset.get(), H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &count) >= 0 &&
                    H5Fflush(handle.get(), H5F_SCOPE_LOCAL) >= 0;
  require(done, place(file, hdf5::records_dataset), "a file that can be written");
}

void ArrayFileWriter::Impl::publish() {
  if (mode == Mode::whole_or_nothing) seal_file(temporary);
  synchronise(temporary, O_RDWR);
  std::error_code error;
  std::filesystem::rename(temporary, file, error);
  if (error) throw input_error(file.string(), error.message(), "a file that can be replaced");
  temporary.clear();
  synchronise(file.has_parent_path() ? file.parent_path() : std::filesystem::path("."), O_RDONLY | O_DIRECTORY);
}

}  // namespace railtab
