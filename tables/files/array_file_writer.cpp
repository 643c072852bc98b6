#include "railtab/tables/files/array_file_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <limits>

namespace railtab {

using hdf5::place;
using hdf5::require;
using hdf5::Section;

ArrayFileWriter::ArrayFileWriter(std::filesystem::path file, std::string_view filetype, int format_version, Mode mode)
    : impl_(std::make_unique<Impl>()) {
  impl_->file = std::move(file);
  impl_->mode = mode;
  const Section section;
  impl_->create(filetype, format_version);
}

ArrayFileWriter::ArrayFileWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

ArrayFileWriter ArrayFileWriter::reopen(std::filesystem::path file, std::string_view filetype, int format_version) {
  // The reader's checks first: what is not a whole file of this type must not be opened for writing.
  static_cast<void>(ArrayFileReader(file, filetype, format_version));
  auto impl = std::make_unique<Impl>();
  impl->file = std::move(file);
  impl->mode = Mode::growing;
  impl->lock = WriterLock(impl->file);
  ArrayFileWriter writer(std::move(impl));
  const Section section;
  writer.impl_->open_records();
  return writer;
}

ArrayFileWriter::~ArrayFileWriter() {
  if (!impl_) return;
  const Section section;
  impl_.reset();
}

ArrayFileWriter::ArrayFileWriter(ArrayFileWriter&&) noexcept = default;

ArrayFileWriter& ArrayFileWriter::operator=(ArrayFileWriter&& other) noexcept {
  std::swap(impl_, other.impl_);
  return *this;
}

void ArrayFileWriter::write(std::string_view path, std::span<const double> values, const Shape& shape,
                            std::string_view unit, std::string_view description) {
  impl_->write_numbers(path, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, values, shape, unit, description);
}

void ArrayFileWriter::write(std::string_view path, std::span<const std::int64_t> values, const Shape& shape,
                            std::string_view unit, std::string_view description) {
  impl_->write_numbers(path, H5T_STD_I64LE, H5T_NATIVE_INT64, values, shape, unit, description);
}

void ArrayFileWriter::write(std::string_view path, std::span<const float> values, const Shape& shape,
                            std::string_view unit, std::string_view description) {
  impl_->write_numbers(path, H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, values, shape, unit, description);
}

void ArrayFileWriter::write(std::string_view path, std::span<const std::uint32_t> values, const Shape& shape,
                            std::string_view unit, std::string_view description) {
  impl_->write_numbers(path, H5T_STD_U32LE, H5T_NATIVE_UINT32, values, shape, unit, description);
}

void ArrayFileWriter::write(std::string_view path, const std::vector<std::string>& values,
                            std::string_view description) {
  std::size_t length = 1;
  for (const std::string& value : values) length = std::max(length, value.size());
  std::string bytes(length * values.size(), '\0');
  for (std::size_t i = 0; i < values.size(); ++i) values[i].copy(bytes.data() + i * length, length);
  const Section section;
  const hdf5::Type type = hdf5::text_type(length);
  impl_->write_dataset(path, type.get(), type.get(), bytes.data(), {values.size()}, "text", description);
}

void ArrayFileWriter::attribute(std::string_view path, std::string_view name, double value) {
  const Section section;
  impl_->write_attribute(path, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &value);
}

void ArrayFileWriter::attribute(std::string_view path, std::string_view name, std::int64_t value) {
  const Section section;
  impl_->write_attribute(path, name, H5T_STD_I64LE, H5T_NATIVE_INT64, &value);
}

void ArrayFileWriter::attribute(std::string_view path, std::string_view name, std::string_view value,
                                std::size_t capacity) {
  const Section section;
  impl_->write_text(path, name, value, capacity);
}

void ArrayFileWriter::create_growing(std::string_view path, const std::vector<std::size_t>& row_shape,
                                     std::string_view unit, std::string_view description) {
  assert(impl_->mode == Mode::growing && size_of(row_shape) > 0);
  const Section section;
  Impl::Growing entry;
  entry.extent.assign(1, 0);
  entry.extent.insert(entry.extent.end(), row_shape.begin(), row_shape.end());
  const double missing = std::numeric_limits<double>::quiet_NaN();
  entry.dataset = impl_->create_extendible(path, H5T_IEEE_F64LE, &missing, entry.extent, unit, description);
  impl_->write_text(path, hdf5::rows_attribute, hdf5::records_dataset, 0);
  const auto column = static_cast<std::int64_t>(1 + impl_->growing.size());
  impl_->write_attribute(path, hdf5::column_attribute, H5T_STD_I64LE, H5T_NATIVE_INT64, &column);
  impl_->growing.emplace(path, std::move(entry));
}

void ArrayFileWriter::append(std::string_view path, std::span<const double> values) {
  const Section section;
  impl_->begin_records();
  const auto found = impl_->growing.find(path);
  if (found == impl_->growing.end() || values.size() % found->second.row_size != 0) {  // of a file that was reopened
    throw input_error(place(impl_->file, path), "no growing dataset with rows of that size", "one to go on with");
  }
  auto& [name, entry] = *found;
  if (values.empty()) return;
  impl_->append_rows(name, entry, H5T_NATIVE_DOUBLE, values.data(), values.size() / entry.row_size);
  entry.sum = word_checksum(std::as_bytes(values), entry.sum);
}

void ArrayFileWriter::truncate(std::size_t rows) {
  assert(impl_->mode == Mode::growing && rows <= impl_->records);
  const Section section;
  impl_->begin_records();
  impl_->cut_blocks(rows);
  impl_->records = rows;
  for (auto& [path, entry] : impl_->growing) {
    entry.rows = rows;
    entry.sum = word_checksum({});
  }
  impl_->commit();
}

std::size_t ArrayFileWriter::records() const { return impl_->records; }

void ArrayFileWriter::create_slot(std::string_view path, std::string_view unit, std::string_view description) {
  assert(impl_->mode == Mode::growing);
  const Section section;
  const double missing = std::numeric_limits<double>::quiet_NaN();
  static_cast<void>(impl_->create_extendible(path, H5T_IEEE_F64LE, &missing, {0}, unit, description));
}

void ArrayFileWriter::replace(std::string_view path, std::span<const double> values) {
  const Section section;
  impl_->begin_records();
  const std::string at = place(impl_->file, path);
  const hdf5::Object dataset = hdf5::open_object(impl_->handle.get(), impl_->file, path);
  hsize_t extent = 0;
  H5Sget_simple_extent_dims(hdf5::Space(H5Dget_space(dataset.get())).get(), &extent, nullptr);
  std::vector<double> content(values.begin(), values.end());
  content.resize(std::max<std::size_t>(content.size(), extent), std::numeric_limits<double>::quiet_NaN());
  extent = content.size();
  const bool done = H5Dset_extent(dataset.get(), &extent) >= 0 &&
                    H5Dwrite(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, content.data()) >= 0;
  impl_->require_written(done, at);
}

void ArrayFileWriter::flush() {
  assert(impl_->mode == Mode::growing);
  const Section section;
  impl_->begin_records();
  impl_->append_block();
  impl_->require_written(H5Fflush(impl_->handle.get(), H5F_SCOPE_LOCAL) >= 0, impl_->file.string());
  impl_->commit();
}

void ArrayFileWriter::close() {
  if (impl_->mode == Mode::growing) flush();
  const Section section;
  impl_->cut_to_rows();
  // All that needs room, while the file can still be abandoned.
  impl_->require_written(H5Fflush(impl_->handle.get(), H5F_SCOPE_LOCAL) >= 0, impl_->file.string());
  impl_->records_dataset = {};
  impl_->growing.clear();
  impl_->blocks = {};
  impl_->require_written(impl_->handle.reset(), impl_->file.string());
  if (!impl_->temporary.empty()) impl_->publish();
  impl_->lock = {};
}

}  // namespace railtab
