#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

#include "railtab/tables/files/array_file_writer.hpp"

// The rows of growing files, and the checksums that go with them.

namespace railtab {

using hdf5::place;
using hdf5::require;

void ArrayFileWriter::Impl::begin_records() {
  assert(mode == Mode::growing);
  if (broken) throw ComputationError(fmt::format("{}: could not be written before", file.string()));
  if (temporary.empty()) return;
  if (!growing.empty()) create_blocks();
  growing.clear();
  require_written(H5Fflush(handle.get(), H5F_SCOPE_LOCAL) >= 0, file.string());
  require_written(handle.reset(), file.string());
  if (std::filesystem::exists(file)) static_cast<void>(WriterLock(file));
  // Readers find the file by its name only when it says that it is being written.
  open_records();
  publish();
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
  entry.dataset = hdf5::open_object(handle.get(), file, path);
  const hdf5::Space space(H5Dget_space(entry.dataset.get()));
  const int rank = space.valid() ? H5Sget_simple_extent_ndims(space.get()) : 0;
  require(rank > 0, place(file, path), "a growing dataset");
  entry.extent.resize(static_cast<std::size_t>(rank));
  H5Sget_simple_extent_dims(space.get(), entry.extent.data(), nullptr);
  for (std::size_t i = 1; i < entry.extent.size(); ++i) entry.row_size *= entry.extent[i];
  if (entry.row_size == 0) throw input_error(place(file, path), "rows without values", "a growing dataset");
  return entry;
}

void ArrayFileWriter::Impl::open_records() {
  handle = hdf5::open_file(temporary.empty() ? file : temporary, hdf5::Access::write_growing);
  require(handle.valid() && H5Fincrement_filesize(handle.get(), 0) >= 0, file.string(), "a file that can be written");
  records_dataset = hdf5::open_object(handle.get(), file, hdf5::records_dataset);
  std::array<std::int64_t, 2> count{-1, -1};
  const bool read = H5Dread(records_dataset.get(), H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, count.data()) >= 0;
  require(read && count[0] >= 0, place(file, hdf5::records_dataset), "the number of records");
  records = static_cast<std::size_t>(count[0]);

  std::vector<std::string> paths;
  require(H5Lvisit(handle.get(), H5_INDEX_NAME, H5_ITER_INC, keep_growing, &paths) >= 0, file.string(), "its datasets");
  for (const std::string& path : paths) {
    Growing entry = open_growing(path);
    if (entry.extent[0] < records) {
      throw input_error(place(file, path), fmt::format("{} rows", entry.extent[0]), fmt::format("{} rows", records));
    }
    entry.rows = records;
    entry.column = static_cast<std::size_t>(hdf5::integer_attribute(
        entry.dataset.get(), place(file, path, hdf5::column_attribute), hdf5::column_attribute));
    growing.emplace(path, std::move(entry));
  }
  if (growing.empty()) return;
  blocks = open_growing(hdf5::blocks_dataset);
  if (blocks.extent.size() != 2 || blocks.row_size != 1 + growing.size()) {
    throw input_error(place(file, hdf5::blocks_dataset), fmt::format("{} columns", blocks.row_size),
                      fmt::format("{}, one for each growing dataset and one more", 1 + growing.size()));
  }
  for (const auto& [path, entry] : growing) {
    if (entry.column < blocks.row_size && entry.column > 0) continue;
    throw input_error(place(file, path, hdf5::column_attribute), fmt::format("{}", entry.column),
                      fmt::format("1 to {}", growing.size()));
  }
  blocks.rows = blocks.extent[0];
  cut_blocks(records);
}

void ArrayFileWriter::Impl::make_room(const std::string& path, Growing& dataset, std::size_t rows) {
  if (dataset.extent[0] >= rows) return;
  dataset.extent[0] = rows;
  require_written(H5Dset_extent(dataset.dataset.get(), dataset.extent.data()) >= 0, place(file, path));
}

void ArrayFileWriter::Impl::append_rows(const std::string& path, Growing& dataset, hid_t memory_type,
                                        const void* values, std::size_t rows) {
  std::vector<hsize_t> start(dataset.extent.size(), 0);
  start[0] = dataset.rows;
  std::vector<hsize_t> count = dataset.extent;
  count[0] = rows;
  make_room(path, dataset, dataset.rows + rows);
  const hdf5::Space target(H5Dget_space(dataset.dataset.get()));
  const hdf5::Space source(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr));
  const bool done =
      H5Sselect_hyperslab(target.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr) >= 0 &&
      H5Dwrite(dataset.dataset.get(), memory_type, source.get(), target.get(), H5P_DEFAULT, values) >= 0;
  require_written(done, place(file, path));
  dataset.rows += rows;
}

void ArrayFileWriter::Impl::cut_to_rows() {
  const auto cut = [this](const std::string& path, Growing& entry) {
    if (!entry.dataset.valid() || entry.extent[0] == entry.rows) return;
    entry.extent[0] = entry.rows;
    require_written(H5Dset_extent(entry.dataset.get(), entry.extent.data()) >= 0, place(file, path));
  };
  for (auto& [path, entry] : growing) cut(path, entry);
  cut(hdf5::blocks_dataset, blocks);
}

void ArrayFileWriter::Impl::create_blocks() {
  static_cast<void>(
      create_extendible(hdf5::blocks_dataset, H5T_STD_U64LE, nullptr, {0, 1 + growing.size()}, "1",
                        "records by the end of each block of rows, then the checksum of its rows in each growing "
                        "dataset, in the column that its attribute checksum_column names"));
}

void ArrayFileWriter::Impl::append_block() {
  if (growing.empty()) return;
  const std::size_t rows = growing.begin()->second.rows;
  for ([[maybe_unused]] const auto& [path, entry] : growing) assert(entry.rows == rows);
  if (rows == records) return;
  records = rows;
  std::vector<std::uint64_t> block(1 + growing.size());
  block[0] = rows;
  for (auto& [path, entry] : growing) block[entry.column] = std::exchange(entry.sum, word_checksum({}));
  append_rows(hdf5::blocks_dataset, blocks, H5T_NATIVE_UINT64, block.data(), 1);
}

void ArrayFileWriter::Impl::cut_blocks(std::size_t rows) {
  if (growing.empty()) return;
  std::vector<std::uint64_t> values(blocks.extent[0] * blocks.row_size);
  if (!values.empty()) {
    require(H5Dread(blocks.dataset.get(), H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0,
            place(file, hdf5::blocks_dataset), "readable checksums");
  }
  std::size_t kept = 0;
  std::uint64_t end = 0;
  while (end < rows && kept < blocks.rows) end = values[kept++ * blocks.row_size];
  if (end != rows) {
    throw input_error(place(file, hdf5::blocks_dataset), fmt::format("no block that ends at record {}", rows),
                      "one: the file is damaged");
  }
  blocks.rows = kept;
}

void ArrayFileWriter::Impl::commit() {
  const std::array<std::int64_t, 2> count = records_and_complement(records);
  const bool done =
      H5Dwrite(records_dataset.get(), H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, count.data()) >= 0 &&
      H5Fflush(handle.get(), H5F_SCOPE_LOCAL) >= 0;
  require_written(done, place(file, hdf5::records_dataset));
}

}  // namespace railtab
