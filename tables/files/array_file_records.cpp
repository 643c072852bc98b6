#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <limits>

#include "railtab/tables/files/array_file_writer.hpp"

// The rows of growing files, and the checksums that go with them.

namespace railtab {

using hdf5::Section;

void ArrayFileWriter::Impl::begin_records() {
  assert(mode == Mode::growing);
  if (!file.valid()) throw ComputationError(fmt::format("{}: could not be written before", file.place("")));
  if (temporary.name.empty()) return;
  if (histories > 0) {
    static_cast<void>(create_dataset(
        hdf5::blocks_dataset, type_of<std::uint64_t>(), {0, 1 + histories}, history_chunk,
        {"1",
         "records by the end of each block of rows, then the checksum of its rows in each growing dataset, in the "
         "column that its attribute checksum_column names"}));
  }
  require_written(H5Fflush(file.get(), H5F_SCOPE_LOCAL) >= 0, file.place(""));
  require_written(file.close(), file.place(""));
  const std::filesystem::path name = file.name();
  if (std::filesystem::exists(name)) static_cast<void>(WriterLock(name));
  // Readers find the file by its name only when it says that it is being written.
  open_records(name, temporary.name);
  temporary.publish(name);
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

ArrayFileWriter::Impl::Growing ArrayFileWriter::Impl::open_growing(const std::string& path) const {
  Growing entry;
  entry.dataset = file.object(path);
  entry.extent = hdf5::extent_of(entry.dataset.get(), file.place(path));
  for (std::size_t i = 1; i < entry.extent.size(); ++i) entry.row_size *= entry.extent[i];
  return entry;
}

void ArrayFileWriter::Impl::open_records(const std::filesystem::path& name, const std::filesystem::path& now) {
  file = hdf5::OpenFile(name, now, hdf5::Access::write_growing);
  std::vector<std::string> paths;
  hdf5::require(H5Lvisit(file.get(), H5_INDEX_NAME, H5_ITER_INC, keep_growing, &paths) >= 0, name.string(),
                "its datasets");
  for (const std::string& path : paths) {
    Growing entry = open_growing(path);
    const std::int64_t column = file.number<std::int64_t>(path, hdf5::column_attribute);
    if (entry.extent.empty() || entry.extent[0] < records() || entry.row_size == 0 || column < 1 ||
        static_cast<std::size_t>(column) > paths.size()) {
      throw input_error(
          file.place(path),
          fmt::format("the shape ({}) and {} {}", fmt::join(entry.extent, ", "), hdf5::column_attribute, column),
          fmt::format("at least {} rows, and a column from 1 to {}", records(), paths.size()));
    }
    entry.rows = records();
    entry.column = static_cast<std::size_t>(column);
    growing.emplace(path, std::move(entry));
  }
  if (growing.empty()) return;
  blocks = open_growing(hdf5::blocks_dataset);
  if (blocks.extent.size() != 2 || blocks.row_size != 1 + growing.size() || blocks.extent[0] < flushes.size()) {
    throw input_error(file.place(hdf5::blocks_dataset), fmt::format("the shape ({})", fmt::join(blocks.extent, ", ")),
                      fmt::format("{} columns, one for each growing dataset and one more", 1 + growing.size()));
  }
  blocks.rows = flushes.size();
}

void ArrayFileWriter::Impl::append_rows(const std::string& path, Growing& dataset, hid_t type, const void* values,
                                        std::size_t rows) {
  bool done = true;
  if (dataset.extent[0] < dataset.rows + rows) {
    dataset.extent[0] = dataset.rows + rows;
    done = H5Dset_extent(dataset.dataset.get(), dataset.extent.data()) >= 0;
  }
  std::vector<hsize_t> extent = dataset.extent;
  extent[0] = rows;
  const hdf5::Rows place(dataset.dataset.get(), extent, dataset.rows);
  done = done && H5Dwrite(dataset.dataset.get(), type, place.memory.get(), place.file.get(), H5P_DEFAULT, values) >= 0;
  require_written(done, file.place(path));
  dataset.rows += rows;
}

void ArrayFileWriter::Impl::cut_to_rows(const std::string& path, Growing& dataset) {
  if (!dataset.dataset.valid() || dataset.extent[0] == dataset.rows) return;
  dataset.extent[0] = dataset.rows;
  require_written(H5Dset_extent(dataset.dataset.get(), dataset.extent.data()) >= 0, file.place(path));
}

void ArrayFileWriter::Impl::cut() {
  for (auto& [path, entry] : growing) cut_to_rows(path, entry);
  for (auto& [path, entry] : late) cut_to_rows(path, entry);
  cut_to_rows(hdf5::blocks_dataset, blocks);
}

void ArrayFileWriter::Impl::append_block() {
  if (growing.empty()) return;
  const std::size_t rows = growing.begin()->second.rows;
  for ([[maybe_unused]] const auto& [path, entry] : growing) assert(entry.rows == rows);
  if (rows == records()) return;
  std::vector<std::uint64_t> block(1 + growing.size());
  block[0] = rows;
  for (auto& [path, entry] : growing) block[entry.column] = std::exchange(entry.sum, word_checksum({}));
  append_rows(hdf5::blocks_dataset, blocks, type_of<std::uint64_t>(), block.data(), 1);
  flushes.push_back(rows);
}

/// The number of records as it is stored: a change of either shows, for their sum is -1.
void ArrayFileWriter::Impl::commit() {
  const auto count = static_cast<std::int64_t>(records());
  const std::array<std::int64_t, 2> stored{count, -1 - count};
  const hdf5::Object dataset = file.object(hdf5::records_dataset);
  const bool done = H5Dwrite(dataset.get(), H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, stored.data()) >= 0 &&
                    H5Fflush(file.get(), H5F_SCOPE_LOCAL) >= 0;
  require_written(done, file.place(hdf5::records_dataset));
}

ArrayFileWriter ArrayFileWriter::reopen(const std::filesystem::path& file, std::string_view filetype,
                                        int format_version) {
  ArrayFileWriter writer(std::make_unique<Impl>(Mode::growing));
  writer.impl_->temporary.lock = WriterLock(file);
  // The reader's checks first: what is not a whole file of this type must not be opened for writing.
  writer.impl_->flushes = ArrayFileReader(file, filetype, format_version).flushes();
  const Section section;
  writer.impl_->open_records(file, file);
  return writer;
}

void ArrayFileWriter::create_growing(std::string_view path, const Shape& row_shape, std::string_view unit,
                                     std::string_view description) {
  assert(impl_->mode == Mode::growing && product(row_shape) > 0);
  const Section section;
  Shape shape{0};
  shape.insert(shape.end(), row_shape.begin(), row_shape.end());
  const hdf5::Object dataset =
      impl_->create_dataset(path, type_of<double>(), shape, history_chunk, {unit, description});
  impl_->write_text({dataset.get(), path}, hdf5::rows_attribute, hdf5::records_dataset);
  impl_->write_attribute({dataset.get(), path}, hdf5::column_attribute, static_cast<std::int64_t>(++impl_->histories));
}

void ArrayFileWriter::append(std::string_view path, std::span<const double> values) {
  const Section section;
  impl_->begin_records();
  const auto found = impl_->growing.find(path);
  if (found == impl_->growing.end() || values.size() % found->second.row_size != 0) {  // of a file that was reopened
    throw input_error(impl_->file.place(path), "no growing dataset with rows of that size", "one to go on with");
  }
  auto& [name, entry] = *found;
  if (values.empty()) return;
  impl_->append_rows(name, entry, type_of<double>(), values.data(), values.size() / entry.row_size);
  entry.sum = word_checksum(std::as_bytes(values), entry.sum);
}

void ArrayFileWriter::truncate(std::size_t rows) {
  assert(impl_->mode == Mode::growing);
  const Section section;
  impl_->begin_records();
  std::vector<std::size_t>& flushes = impl_->flushes;
  const auto end = std::ranges::find(flushes, rows);
  if (rows > 0 && end == flushes.end()) {
    throw input_error(impl_->file.place(hdf5::blocks_dataset), fmt::format("no block that ends at record {}", rows),
                      "one: the file is damaged");
  }
  flushes.erase(rows > 0 ? end + 1 : flushes.begin(), flushes.end());
  impl_->blocks.rows = flushes.size();
  for (auto& [path, entry] : impl_->growing) {
    entry.rows = rows;
    entry.sum = word_checksum({});
  }
  impl_->commit();
}

std::size_t ArrayFileWriter::records() const { return impl_->records(); }

const std::filesystem::path& ArrayFileWriter::file() const noexcept { return impl_->file.name(); }

void ArrayFileWriter::create_slot(std::string_view path, std::string_view unit, std::string_view description) {
  assert(impl_->mode == Mode::growing);
  const Section section;
  static_cast<void>(impl_->create_dataset(path, type_of<double>(), {0}, history_chunk, {unit, description}));
}

void ArrayFileWriter::replace(std::string_view path, std::span<const double> values) {
  const Section section;
  impl_->begin_records();
  const std::string at = impl_->file.place(path);
  const hdf5::Object dataset = impl_->file.object(path);
  hsize_t extent = hdf5::extent_of(dataset.get(), at).at(0);
  std::vector<double> content(values.begin(), values.end());
  content.resize(std::max<std::size_t>(content.size(), extent), std::numeric_limits<double>::quiet_NaN());
  extent = content.size();
  impl_->require_written(
      H5Dset_extent(dataset.get(), &extent) >= 0 &&
          H5Dwrite(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, content.data()) >= 0,
      at);
}

void ArrayFileWriter::create_late(std::string_view path, const Numbers& none, const Shape& row_shape,
                                  std::string_view unit, std::string_view description) {
  assert(impl_->mode == Mode::growing && product(row_shape) > 0);
  const Section section;
  Shape shape{0};
  shape.insert(shape.end(), row_shape.begin(), row_shape.end());
  const std::size_t chunk = product(row_shape) == 1 ? page : history_chunk;
  const hdf5::Object dataset = std::visit(
      [&]<typename Number>(std::span<const Number>) {
        return impl_->create_dataset(path, type_of<Number>(), shape, chunk, {unit, description});
      },
      none);
  impl_->write_attribute({dataset.get(), path}, hdf5::checksum_attribute, static_cast<std::int64_t>(word_checksum({})));
}

void ArrayFileWriter::write_late(std::string_view path, const Numbers& numbers) {
  const Section section;
  impl_->begin_records();
  const std::string name(path);
  Impl::Growing& entry = impl_->late[name];
  entry = impl_->open_growing(name);
  std::visit(
      [&]<typename Number>(std::span<const Number> values) {
        const std::size_t rows = values.size() / entry.row_size;
        impl_->append_rows(name, entry, type_of<Number>(), values.data(), rows);
        impl_->write_attribute({entry.dataset.get(), path}, hdf5::checksum_attribute,
                               static_cast<std::int64_t>(word_checksum(std::as_bytes(values))));
      },
      numbers);
}

void ArrayFileWriter::cut() {
  const Section section;
  impl_->cut();
}

void ArrayFileWriter::flush() {
  const Section section;
  impl_->begin_records();
  impl_->append_block();
  impl_->require_written(H5Fflush(impl_->file.get(), H5F_SCOPE_LOCAL) >= 0, impl_->file.place(""));
  impl_->commit();
}

}  // namespace railtab
