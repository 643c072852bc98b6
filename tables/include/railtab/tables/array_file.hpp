#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace railtab {

/// The one door to HDF5: files of named arrays with attributes. Paths are "group/dataset"; groups are created as
/// needed. Every error is an InputError that names the file and the dataset or attribute.
///
/// An array of any rank in C order; `shape` empty means a scalar.
struct Array {
  std::vector<std::size_t> shape;
  std::vector<double> values;
};

class ArrayFileWriter {
 public:
  enum class Mode { whole_or_nothing, growing };

  /// `whole_or_nothing`: writes to a temporary name beside `file`, renamed by close(); discarded by the destructor if
  /// close() was not called. `growing`: writes in place, readable after each flush().
  /// Writes the attributes "filetype" and "format_version" on the root group.
  ArrayFileWriter(std::filesystem::path file, std::string_view filetype, int format_version,
                  Mode mode = Mode::whole_or_nothing);
  /// Open an existing growing file again, to continue it. @throws InputError as ArrayFileReader.
  static ArrayFileWriter reopen(std::filesystem::path file, std::string_view filetype, int format_version);
  ~ArrayFileWriter();
  ArrayFileWriter(ArrayFileWriter&&) noexcept;
  ArrayFileWriter& operator=(ArrayFileWriter&&) noexcept;

  /// @param unit written as attribute "unit" ("m", "rad", "1" for dimensionless); @param description as "description".
  void write(std::string_view path, std::span<const double> values, std::vector<std::size_t> shape,
             std::string_view unit, std::string_view description);
  void write(std::string_view path, std::span<const std::int64_t> values, std::vector<std::size_t> shape,
             std::string_view unit, std::string_view description);
  void write(std::string_view path, const std::vector<std::string>& values, std::string_view description);

  void attribute(std::string_view path, std::string_view name, double value);
  void attribute(std::string_view path, std::string_view name, std::int64_t value);
  void attribute(std::string_view path, std::string_view name, std::string_view value);

  /// A dataset that grows along its first dimension; `row_shape` is the rest. Chunked.
  void create_growing(std::string_view path, std::vector<std::size_t> row_shape, std::string_view unit,
                      std::string_view description);
  /// Append whole rows: values.size() is a multiple of the row size.
  void append(std::string_view path, std::span<const double> values);
  /// Cut every growing dataset back to `rows` (resuming from a checkpoint).
  void truncate(std::string_view path, std::size_t rows);
  /// Overwrite a dataset of the same shape, or create it.
  void replace(std::string_view path, std::span<const double> values, std::vector<std::size_t> shape,
               std::string_view unit, std::string_view description);

  void flush();
  void close();

 private:
  struct Impl;
  explicit ArrayFileWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

class ArrayFileReader {
 public:
  /// Checks that the file exists, is HDF5 and whole, then its filetype, then its format version.
  ArrayFileReader(std::filesystem::path file, std::string_view filetype, int format_version);
  ~ArrayFileReader();
  ArrayFileReader(ArrayFileReader&&) noexcept;

  [[nodiscard]] bool contains(std::string_view path) const;
  [[nodiscard]] Array read(std::string_view path) const;
  /// As read, and checks the shape; -1 stands for any extent.
  [[nodiscard]] std::vector<double> read(std::string_view path, std::vector<long> expected_shape) const;
  [[nodiscard]] std::vector<std::int64_t> read_integers(std::string_view path) const;
  [[nodiscard]] std::vector<std::string> read_strings(std::string_view path) const;
  [[nodiscard]] double number(std::string_view path, std::string_view name) const;
  [[nodiscard]] std::string text(std::string_view path, std::string_view name) const;
  [[nodiscard]] std::vector<std::string> attribute_names(std::string_view path) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The filetype attribute of a railtab file, to tell tables from results. @throws InputError if it is none.
[[nodiscard]] std::string array_file_type(const std::filesystem::path& file);

/// 64-bit FNV-1a over bytes: the checksum of what a table stores.
[[nodiscard]] std::uint64_t checksum(std::span<const double> values, std::uint64_t seed = 14695981039346656037ULL) noexcept;

}  // namespace railtab
