#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "railtab/runtime/base/temporary_file.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/tables/files/array_file_seal.hpp"
#include "railtab/tables/files/array_file_writer.hpp"

namespace railtab {

using hdf5::place;
using hdf5::require;

namespace {

/// Rows of a chunk: about 16 KiB, so that short runs stay small files; at least 8, so that the index of a long run
/// stays small too (up to 8180 chunks each of its blocks fits in a page).
hsize_t chunk_rows(std::size_t row_size) {
  constexpr std::size_t chunk_values = 2048, fewest = 8;
  return std::max(fewest, chunk_values / row_size);
}

/// To the disk itself, so that the new name never stands for a file that a power failure emptied. @return 0, or the
/// error: some file systems find only here that they are full
int synchronise(const std::filesystem::path& path, int flags) {
  const int descriptor = ::open(path.c_str(), flags | O_CLOEXEC);
  if (descriptor < 0) return 0;
  const int error = ::fsync(descriptor) == 0 ? 0 : errno;
  ::close(descriptor);
  return error == EIO || error == ENOSPC || error == EDQUOT ? error : 0;
}

}  // namespace

ArrayFileWriter::Impl::~Impl() {
  if (temporary.empty()) {
    if (handle.valid() && H5Fflush(handle.get(), H5F_SCOPE_LOCAL) < 0) abandon();
    return;
  }
  abandon();
  std::error_code ignored;
  std::filesystem::remove(temporary, ignored);
}

void ArrayFileWriter::Impl::require_written(bool done, const std::string& place) {
  if (done) return;
  const ComputationError failure = hdf5::write_failure(place);
  abandon();
  throw failure;
}

void ArrayFileWriter::Impl::abandon() noexcept {
  broken = true;
  if (handle.valid()) hdf5::stop_writing(handle.get());
  growing.clear();
  blocks = {};
  records_dataset = {};
  static_cast<void>(handle.reset());
  lock = {};
}

void ArrayFileWriter::Impl::create(std::string_view filetype, int format_version) {
  file = output_file(file);
  if (mode == Mode::growing && std::filesystem::exists(file)) static_cast<void>(WriterLock(file));
  TemporaryFile made = create_temporary(file);
  temporary = made.name;
  lock = std::move(made.lock);
  const bool whole = mode == Mode::whole_or_nothing;
  handle = hdf5::open_file(temporary, whole ? hdf5::Access::create_whole : hdf5::Access::create_growing);
  if (!handle.valid()) throw hdf5::failure(file.string(), "a file that can be created");
  write_text("", "filetype", filetype, 0);
  const std::int64_t version = format_version;
  write_attribute("", "format_version", H5T_STD_I64LE, H5T_NATIVE_INT64, &version);
  if (whole) return;
  const std::array<std::int64_t, 2> none = records_and_complement(0);
  write_dataset(hdf5::records_dataset, H5T_STD_I64LE, H5T_NATIVE_INT64, none.data(), {none.size()}, "1",
                "rows of the growing datasets that are valid; minus one minus that number");
}

void ArrayFileWriter::Impl::create_groups_of(std::string_view path) {
  const hdf5::Properties properties = hdf5::group_properties(H5P_GROUP_CREATE);
  for (std::size_t end = path.find('/'); end != std::string_view::npos; end = path.find('/', end + 1)) {
    const std::string group(path.substr(0, end));
    if (H5Lexists(handle.get(), group.c_str(), H5P_DEFAULT) > 0) continue;
    const hdf5::Object created(H5Gcreate2(handle.get(), group.c_str(), H5P_DEFAULT, properties.get(), H5P_DEFAULT));
    require_written(created.valid(), place(file, group));
  }
}

hdf5::Object ArrayFileWriter::Impl::create_dataset(std::string_view path, hid_t type, hid_t space, hid_t properties) {
  assert(!temporary.empty() && "nothing can be created once records have begun");
  create_groups_of(path);
  hdf5::Object dataset(
      H5Dcreate2(handle.get(), std::string(path).c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT));
  require_written(dataset.valid(), place(file, path));
  return dataset;
}

void ArrayFileWriter::Impl::write_dataset(std::string_view path, hid_t file_type, hid_t memory_type, const void* values,
                                          const Shape& shape, std::string_view unit, std::string_view description) {
  const std::vector<hsize_t> extent(shape.begin(), shape.end());
  const hdf5::Space space(shape.empty() ? H5Screate(H5S_SCALAR)
                                        : H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr));
  const hdf5::Object dataset = create_dataset(path, file_type, space.get(), H5P_DEFAULT);
  if (std::find(shape.begin(), shape.end(), 0U) == shape.end()) {
    require_written(H5Dwrite(dataset.get(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0,
                    place(file, path));
  }
  write_text(path, "unit", unit, 0);
  write_text(path, "description", description, 0);
  if (mode != Mode::growing || path == hdf5::records_dataset) return;
  const std::size_t bytes = H5Tget_size(memory_type) * size_of(shape);
  const auto sum = static_cast<std::int64_t>(word_checksum({static_cast<const std::byte*>(values), bytes}));
  write_attribute(path, hdf5::checksum_attribute, H5T_STD_I64LE, H5T_NATIVE_INT64, &sum);
}

hdf5::Object ArrayFileWriter::Impl::create_extendible(std::string_view path, hid_t file_type, const double* fill,
                                                      const std::vector<hsize_t>& extent, std::string_view unit,
                                                      std::string_view description) {
  std::vector<hsize_t> limit = extent;
  limit[0] = H5S_UNLIMITED;
  std::vector<hsize_t> chunk = extent;
  std::size_t row_size = 1;
  for (std::size_t i = 1; i < extent.size(); ++i) row_size *= extent[i];
  chunk[0] = chunk_rows(row_size);
  const int rank = static_cast<int>(extent.size());
  const hdf5::Space space(H5Screate_simple(rank, extent.data(), limit.data()));
  const hdf5::Properties properties(H5Pcreate(H5P_DATASET_CREATE));
  const bool done = H5Pset_chunk(properties.get(), rank, chunk.data()) >= 0 &&
                    (fill == nullptr || H5Pset_fill_value(properties.get(), H5T_NATIVE_DOUBLE, fill) >= 0);
  require(done, place(file, path), "chunks");
  hdf5::Object dataset = create_dataset(path, file_type, space.get(), properties.get());
  write_text(path, "unit", unit, 0);
  write_text(path, "description", description, 0);
  return dataset;
}

void ArrayFileWriter::Impl::write_attribute(std::string_view path, std::string_view name, hid_t file_type,
                                            hid_t memory_type, const void* value) {
  const std::string at = place(file, path, name);
  const std::string key(name);
  if (!path.empty() && H5Lexists(handle.get(), std::string(path).c_str(), H5P_DEFAULT) <= 0) {
    create_groups_of(std::string(path) + "/");
  }
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
  require_written(attribute.valid() && H5Awrite(attribute.get(), memory_type, value) >= 0, at);
}

void ArrayFileWriter::Impl::write_text(std::string_view path, std::string_view name, std::string_view value,
                                       std::size_t capacity) {
  const std::string key(name);
  std::size_t room = std::max({value.size(), capacity, std::size_t{1}});
  if (path.empty() || hdf5::contains(handle.get(), file, path)) {
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
  const hdf5::Type type = hdf5::text_type(room);
  write_attribute(path, name, type.get(), type.get(), bytes.data());
}

void ArrayFileWriter::Impl::publish() {
  if (mode == Mode::whole_or_nothing) seal_file(temporary);
  if (const int failed = synchronise(temporary, O_RDWR)) {
    throw ComputationError(fmt::format("{}: could not be written: {}", file.string(), std::strerror(failed)));
  }
  std::error_code error;
  std::filesystem::rename(temporary, file, error);
  if (error) throw input_error(file.string(), error.message(), "a file that can be replaced");
  temporary.clear();
  synchronise(file.has_parent_path() ? file.parent_path() : std::filesystem::path("."), O_RDONLY | O_DIRECTORY);
}

}  // namespace railtab
