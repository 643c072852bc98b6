#pragma once

#include <array>
#include <cassert>
#include <functional>
#include <map>
#include <numeric>
#include <string>

#include "railtab/runtime/base/file_checksum.hpp"
#include "railtab/runtime/base/writer_lock.hpp"
#include "railtab/tables/files/array_file.hpp"
#include "railtab/tables/files/array_file_hdf5.hpp"

namespace railtab {

/// The number of records as it is stored: a change of either shows, for their sum is -1.
inline std::array<std::int64_t, 2> records_and_complement(std::size_t records) {
  const auto count = static_cast<std::int64_t>(records);
  return {count, -1 - count};
}

/// Number of values.
[[nodiscard]] inline std::size_t size_of(const ArrayFileWriter::Shape& shape) {
  return std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies());
}

/// State of a file being written. Its members call HDF5 without taking a Section: the public functions do.
struct ArrayFileWriter::Impl {
  std::filesystem::path file;       ///< the name at the end
  std::filesystem::path temporary;  ///< the name now; empty once the file has its own
  Mode mode = Mode::whole_or_nothing;
  bool broken = false;  ///< something could not be written: nothing more is, and the file gets no new name
  WriterLock lock;      ///< of the file under its name now
  hdf5::File handle;

  struct Growing {
    hdf5::Object dataset;
    std::vector<hsize_t> extent;  ///< rows that there is room for, then the shape of a row
    std::size_t rows = 0;         ///< rows that are written
    std::size_t row_size = 1;
    std::size_t column = 0;                 ///< in the checksums of blocks
    std::uint64_t sum = word_checksum({});  ///< of the rows since the last block
  };
  std::map<std::string, Growing, std::less<>> growing;
  Growing blocks;  ///< checksums; its rows count blocks, not records
  hdf5::Object records_dataset;
  std::size_t records = 0;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl();

  /// @throws ComputationError where a write failed, after abandon()
  void require_written(bool done, const std::string& place);
  /// Leaves the file as it is on the disk, as a kill would.
  void abandon() noexcept;

  void create(std::string_view filetype, int format_version);
  /// Those before each '/'.
  void create_groups_of(std::string_view path);
  hdf5::Object create_dataset(std::string_view path, hid_t type, hid_t space, hid_t properties);
  void write_dataset(std::string_view path, hid_t file_type, hid_t memory_type, const void* values, const Shape& shape,
                     std::string_view unit, std::string_view description);
  template <typename Number>
  void write_numbers(std::string_view path, hid_t file_type, hid_t memory_type, std::span<const Number> values,
                     const Shape& shape, std::string_view unit, std::string_view description) {
    assert(values.size() == size_of(shape));
    const hdf5::Section section;
    write_dataset(path, file_type, memory_type, values.data(), shape, unit, description);
  }
  /// @param fill of rows that were never written; null: zeros
  hdf5::Object create_extendible(std::string_view path, hid_t file_type, const double* fill,
                                 const std::vector<hsize_t>& extent, std::string_view unit,
                                 std::string_view description);
  void write_attribute(std::string_view path, std::string_view name, hid_t file_type, hid_t memory_type,
                       const void* value);
  void write_text(std::string_view path, std::string_view name, std::string_view value, std::size_t capacity);

  /// Gives a growing file its name and opens it for single-writer-multiple-reader writing.
  void begin_records();
  void open_records();
  void create_blocks();
  [[nodiscard]] Growing open_growing(const std::string& path) const;
  /// Never less than there is: a chunk given back could be used again before the file stops naming its old place, and
  /// a process that ends in between leaves two owners of one place.
  void make_room(const std::string& path, Growing& dataset, std::size_t rows);
  void append_rows(const std::string& path, Growing& dataset, hid_t memory_type, const void* values, std::size_t rows);
  /// The checksums of what came since the last block.
  void append_block();
  /// Forget the blocks beyond the one that ends at `rows`. @throws InputError where none does.
  void cut_blocks(std::size_t rows);
  /// Gives back what a shorter history left over; only before closing, when nothing more is allocated.
  void cut_to_rows();
  void commit();
  void publish();
};

}  // namespace railtab
