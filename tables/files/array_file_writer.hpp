#pragma once

#include <cassert>
#include <functional>
#include <map>
#include <numeric>
#include <type_traits>

#include "railtab/runtime/base/file_checksum.hpp"
#include "railtab/runtime/base/temporary_file.hpp"
#include "railtab/tables/files/array_file.hpp"
#include "railtab/tables/files/array_file_hdf5.hpp"

namespace railtab {

/// Number of values.
[[nodiscard]] inline std::size_t product(std::span<const std::size_t> extents) {
  return std::accumulate(extents.begin(), extents.end(), std::size_t{1}, std::multiplies());
}

/// As in the file, so that no number changes: array_file_hdf5.cpp asserts a little-endian machine.
template <typename Number>
[[nodiscard]] hid_t type_of() {
  if constexpr (std::is_same_v<Number, double>) return H5T_IEEE_F64LE;
  if constexpr (std::is_same_v<Number, float>) return H5T_IEEE_F32LE;
  if constexpr (std::is_same_v<Number, std::int64_t>) return H5T_STD_I64LE;
  if constexpr (std::is_same_v<Number, std::uint64_t>) return H5T_STD_U64LE;
  if constexpr (std::is_same_v<Number, std::uint32_t>) return H5T_STD_U32LE;
  if constexpr (std::is_same_v<Number, std::uint8_t>) return H5T_STD_U8LE;
}

/// Of chunks of growing datasets: small, so that short runs stay small files.
inline constexpr std::size_t history_chunk = 16384, page = 4096;

/// What is said about a dataset.
struct Statement {
  std::string_view unit, description;
};

/// State of a file being written. Its members call HDF5 without taking a Section: the public functions do, and the
/// destructor.
struct ArrayFileWriter::Impl {
  TemporaryFile temporary;  ///< the name now, empty once the file has its own; the lock stays
  Mode mode = Mode::whole_or_nothing;
  hdf5::OpenFile file;  ///< with the name at the end; not valid after a write that failed

  struct Growing {
    hdf5::Object dataset;
    std::vector<hsize_t> extent;  ///< rows that there is room for, then the shape of a row
    std::size_t rows = 0;         ///< rows that are written
    std::size_t row_size = 1;
    std::size_t column = 0;                 ///< in the checksums of blocks
    std::uint64_t sum = word_checksum({});  ///< of the rows since the last block
  };
  std::map<std::string, Growing, std::less<>> growing;  ///< once records have begun
  std::size_t histories = 0;                            ///< number of growing datasets that were created
  Growing blocks;                                       ///< checksums; its rows count blocks, not records
  std::map<std::string, Growing, std::less<>> late;     ///< those that were written
  std::vector<std::size_t> flushes;                     ///< records by the end of each block

  explicit Impl(Mode how) : mode(how) {}
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl();

  /// @throws ComputationError where a write failed, after abandon()
  void require_written(bool done, const std::string& place);
  /// Leaves the file as it is on the disk, as a kill would.
  void abandon() noexcept;

  /// The groups before each '/'.
  void create_groups_of(std::string_view path);
  /// @param chunk_bytes about so many of a dataset that grows along its first extent; 0: it does not
  hdf5::Object create_dataset(std::string_view path, hid_t type, const Shape& shape, std::size_t chunk_bytes,
                              Statement statement);
  void write_dataset(std::string_view path, hid_t type, std::span<const std::byte> values, const Shape& shape,
                     Statement statement);
  /// An open group or dataset, and its path for errors.
  struct Owner {
    hid_t object;
    std::string_view path;
  };
  /// Groups are created where there are none yet.
  hdf5::Object owner_of_attributes(std::string_view path);
  /// Opens an attribute, created where there is none yet: a row of `values`, one alone a scalar.
  hdf5::Attribute open_attribute(Owner owner, std::string_view name, hid_t type, std::size_t values = 1);
  template <typename Number>
  void write_attribute(Owner owner, std::string_view name, Number value) {
    const hdf5::Attribute attribute = open_attribute(owner, name, type_of<Number>());
    require_written(H5Awrite(attribute.get(), type_of<Number>(), &value) >= 0, file.place(owner.path, name));
  }
  void write_text(Owner owner, std::string_view name, std::string_view value, std::size_t capacity = 0,
                  H5T_cset_t letters = H5T_CSET_UTF8);

  /// Gives a growing file its name and opens it for single-writer-multiple-reader writing.
  void begin_records();
  /// @param now the file's name at present
  void open_records(const std::filesystem::path& name, const std::filesystem::path& now);
  [[nodiscard]] Growing open_growing(const std::string& path) const;
  [[nodiscard]] std::size_t records() const { return flushes.empty() ? 0 : flushes.back(); }
  /// There is never less room than before: a chunk given back could be used again before the file stops naming its old
  /// place, and a process that ends in between leaves two owners of one place.
  void append_rows(const std::string& path, Growing& dataset, hid_t type, const void* values, std::size_t rows);
  /// The checksums of what came since the last block.
  void append_block();
  /// Gives back what shorter content left over; only before closing, when nothing more is allocated.
  void cut_to_rows(const std::string& path, Growing& dataset);
  void cut();
  /// Counts the records of the blocks.
  void commit();
};

}  // namespace railtab
