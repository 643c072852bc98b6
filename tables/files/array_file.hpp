#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace railtab {

/// The one door to HDF5: files of named arrays with attributes. Paths are "group/dataset"; groups are created as
/// needed; "" is the root group. Every error is an InputError that names the file and the dataset or attribute, except
/// that what cannot be written once a file is begun (a full disk) is a ComputationError. The writer is then of no more
/// use; a growing file stays as its last flush left it.
/// Two threads may use two files; one object belongs to one thread at a time.
///
/// An array of any rank in C order; `shape` empty means a scalar.
template <class Value>
struct ArrayOf {
  std::vector<std::size_t> shape;
  std::vector<Value> values;
};
using Array = ArrayOf<double>;

/// Writes a file of named arrays.
///
/// A growing file is a table of records: all its growing datasets have the same number of rows at each flush(), and
/// that number is written to the dataset "records" only after the rows themselves. So whatever ends the process, the
/// file holds the records of the last flush, and a reader takes no row beyond them. Each flush adds a checksum of the
/// new rows of every dataset, and what does not grow has one of its own, so that a reader finds every changed byte of
/// what it reads. Slots are left to their owner.
class ArrayFileWriter {
 public:
  enum class Mode { whole_or_nothing, growing };

  /// `whole_or_nothing`: writes to a temporary name beside `file`, renamed by close(); discarded by the destructor if
  /// close() was not called; sealed with a checksum of the whole file. `growing`: likewise until the first append(),
  /// replace() or flush(), which gives the file its name; from then on nothing more can be created, only appended and
  /// overwritten. Writes the attributes "filetype" and "format_version" on the root group.
  /// @throws InputError where the file cannot be created, or another process is writing the growing file of that name.
  ArrayFileWriter(const std::filesystem::path& file, std::string_view filetype, int format_version,
                  Mode mode = Mode::whole_or_nothing);
  /// Open an existing growing file again, to continue it after its last flushed record, also where its writer was
  /// killed. @throws InputError as ArrayFileReader, and where another process is writing it.
  static ArrayFileWriter reopen(const std::filesystem::path& file, std::string_view filetype, int format_version);
  ~ArrayFileWriter();
  ArrayFileWriter(ArrayFileWriter&&) noexcept;
  ArrayFileWriter& operator=(ArrayFileWriter&&) noexcept;

  using Shape = std::vector<std::size_t>;
  /// 32-bit numbers are for large tables; read() and read_integers() read them as any others.
  using Numbers = std::variant<std::span<const double>, std::span<const float>, std::span<const std::int64_t>,
                               std::span<const std::uint32_t>, std::span<const std::uint8_t>>;
  /// @param unit written as attribute "unit" ("m", "rad", "1" for dimensionless); @param description as "description".
  void write(std::string_view path, const Numbers& numbers, const Shape& shape, std::string_view unit,
             std::string_view description);
  void write(std::string_view path, const std::vector<std::string>& values, std::string_view description);

  /// Create or overwrite an attribute of a group or dataset. Room is kept for `capacity` bytes of a text. One that
  /// overwrites another with less room is cut to it and ends in "...".
  void attribute(std::string_view path, std::string_view name,
                 const std::variant<double, std::int64_t, std::string_view>& value, std::size_t capacity = 0);
  /// The same as other programs want them: a text in ASCII without room for a longer one, a row of whole numbers.
  void ascii_attribute(std::string_view path, std::string_view name, std::string_view value);
  void attribute(std::string_view path, std::string_view name, std::span<const std::int64_t> values);

  /// A dataset that grows along its first dimension; `row_shape` is the rest, no extent zero. Chunked.
  void create_growing(std::string_view path, const Shape& row_shape, std::string_view unit,
                      std::string_view description);
  /// Append whole rows: values.size() is a multiple of the row size.
  void append(std::string_view path, std::span<const double> values);
  /// Cut every growing dataset of a growing file back to `rows`, the records() after one of its flushes (resuming from
  /// a checkpoint). @throws InputError where none ended there.
  void truncate(std::size_t rows);
  /// Records of the last flush.
  [[nodiscard]] std::size_t records() const;
  /// The name at the end.
  [[nodiscard]] const std::filesystem::path& file() const noexcept;

  /// A one-dimensional dataset of any length, empty at first, that replace() overwrites as a whole.
  void create_slot(std::string_view path, std::string_view unit, std::string_view description);
  /// Never becomes shorter: what is left of longer content is NaN.
  /// Not atomic: a process that ends midway leaves a mixture, so what matters needs two slots and a checksum.
  void replace(std::string_view path, std::span<const double> values);

  /// A dataset of rows of `row_shape` and of the type of `none`, empty until write_late() gives it its content, any
  /// number of rows, with a checksum. As slots, it is whole once nothing else was written after it: a process that
  /// ends before leaves a mixture, so that its owner marks what is true afterwards, and takes the mark away before.
  void create_late(std::string_view path, const Numbers& none, const Shape& row_shape, std::string_view unit,
                   std::string_view description);
  void write_late(std::string_view path, const Numbers& numbers);
  /// Gives back the room of rows that are valid no more; nothing can be appended or written late after it.
  void cut();

  /// Hand everything to the operating system and count the appended rows as records (growing files).
  void flush();
  /// Finish the file. A growing file is flushed.
  void close();

 private:
  struct Impl;
  explicit ArrayFileWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Reads a file of named arrays, also one that is being written or whose writer was killed. What lies in other files,
/// behind links or filters is rejected; sizes are held against that of the file before anything is read.
class ArrayFileReader {
 public:
  /// Checks that the file exists, is HDF5 and whole, then its filetype, then its format version.
  ArrayFileReader(const std::filesystem::path& file, std::string_view filetype, int format_version);
  ~ArrayFileReader();
  ArrayFileReader(ArrayFileReader&&) noexcept;

  [[nodiscard]] const std::filesystem::path& file() const noexcept;
  [[nodiscard]] bool contains(std::string_view path) const;
  /// Of a growing dataset, the rows that were flushed.
  [[nodiscard]] Array read(std::string_view path) const;
  /// The same rounded to 32 bits, where they are not stored so.
  [[nodiscard]] ArrayOf<float> read_floats(std::string_view path) const;
  [[nodiscard]] std::vector<std::int64_t> read_integers(std::string_view path) const;
  /// Of a dataset of numbers, as read() and read_integers() return them.
  [[nodiscard]] std::vector<std::size_t> shape(std::string_view path) const;
  [[nodiscard]] std::vector<std::string> read_strings(std::string_view path) const;
  [[nodiscard]] double number(std::string_view path, std::string_view name) const;
  /// An attribute that is a whole number, low to high.
  [[nodiscard]] std::int64_t whole_number(std::string_view path, std::string_view name, std::int64_t low,
                                          std::int64_t high) const;
  /// An attribute that is a row of whole numbers.
  [[nodiscard]] std::vector<std::int64_t> whole_numbers(std::string_view path, std::string_view name) const;
  [[nodiscard]] std::string text(std::string_view path, std::string_view name) const;
  /// In the order of their creation.
  [[nodiscard]] std::vector<std::string> attribute_names(std::string_view path) const;
  /// Flushed records of a growing file, 0 of any other.
  [[nodiscard]] std::size_t records() const noexcept;
  /// The number of records by the end of each flush.
  [[nodiscard]] const std::vector<std::size_t>& flushes() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Whether the file begins as HDF5 or as a sealed file does, whatever follows. False where there is none.
[[nodiscard]] bool is_array_file(const std::filesystem::path& file);

/// An output must replace nothing but its like. @throws InputError where `file` exists, is not empty and is of none of
/// these types.
void require_replaceable(const std::filesystem::path& file, std::initializer_list<std::string_view> filetypes);

/// The filetype attribute of a railtab file, to tell tables from results. @throws InputError if it is none.
[[nodiscard]] std::string array_file_type(const std::filesystem::path& file);

/// The attribute "checksum" that a table's writer stored: two tables with one checksum hold the same numbers, whenever
/// they were made. @throws InputError where there is none.
[[nodiscard]] std::string array_file_checksum(const std::filesystem::path& file);

/// 64-bit FNV-1a over the little-endian bytes: the checksum of what a table stores.
inline constexpr std::uint64_t checksum_seed = 14695981039346656037ULL;
[[nodiscard]] std::uint64_t checksum_of_bytes(std::span<const std::byte> bytes, std::uint64_t seed) noexcept;
[[nodiscard]] inline std::uint64_t checksum(std::span<const double> values,
                                            std::uint64_t seed = checksum_seed) noexcept {
  return checksum_of_bytes(std::as_bytes(values), seed);
}
[[nodiscard]] inline std::uint64_t checksum(std::span<const float> values, std::uint64_t seed) noexcept {
  return checksum_of_bytes(std::as_bytes(values), seed);
}
[[nodiscard]] inline std::uint64_t checksum(std::span<const std::uint32_t> values, std::uint64_t seed) noexcept {
  return checksum_of_bytes(std::as_bytes(values), seed);
}
/// Of an array after its length.
template <class T>
[[nodiscard]] std::uint64_t counted_checksum(std::span<const T> values, std::uint64_t seed) noexcept {
  const double length = static_cast<double>(values.size());
  return checksum(values, checksum({&length, 1}, seed));
}

}  // namespace railtab
