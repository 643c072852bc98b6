#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "railtab/tables/files/array_file.hpp"

namespace railtab {

/// One dataset of a kind of file: what its writer writes and its reader requires.
struct Field {
  enum class Values { any, finite, increasing };  ///< increasing: finite and strictly increasing
  std::string path;
  std::vector<std::string> shape;  ///< names of dimensions, or numbers: {"records", "wheels", "6"}; empty: a scalar
  std::string unit, description;
  Values values = Values::finite;
};

/// The extents of the named dimensions of one file: the first dataset that has a dimension sets it, the others agree.
class FileDimensions {
 public:
  void set(std::string_view dimension, std::size_t extent, std::string_view path);
  /// @throws InputError at `file`: `field.path` with the shape found and the one expected.
  void require(const std::filesystem::path& file, const Field& field, const std::vector<std::size_t>& shape);
  /// Of `count` values: a dimension that is not yet known, one at most, has what the others leave.
  [[nodiscard]] std::vector<std::size_t> shape(const Field& field, std::size_t count);

 private:
  struct Known {
    std::size_t extent;
    std::string path;
  };
  [[nodiscard]] const Known* known(const std::string& dimension) const;
  std::map<std::string, Known, std::less<>> known_;
};

/// Reads the datasets of a file as their fields describe them. @throws InputError with file, dataset, found, expected
class FieldReader {
 public:
  explicit FieldReader(const ArrayFileReader& file) : file_(file) {}

  void set(std::string_view dimension, std::size_t extent, std::string_view path) {
    dimensions_.set(dimension, extent, path);
  }
  [[nodiscard]] std::vector<double> numbers(const Field& field);
  [[nodiscard]] std::vector<float> floats(const Field& field);
  [[nodiscard]] std::vector<std::uint32_t> counts(const Field& field);
  [[nodiscard]] std::vector<std::string> texts(const Field& field);
  /// A number among the attributes of a group, finite and low to high.
  [[nodiscard]] double number(std::string_view group, std::string_view name,
                              double low = std::numeric_limits<double>::lowest(),
                              double high = std::numeric_limits<double>::max()) const;

 private:
  template <class Value>
  [[nodiscard]] std::vector<Value> checked(const Field& field, ArrayOf<Value> array);

  const ArrayFileReader& file_;
  FileDimensions dimensions_;
};

/// Writes datasets as their fields describe them.
class FieldWriter {
 public:
  explicit FieldWriter(ArrayFileWriter& file) : file_(file) {}

  void set(std::string_view dimension, std::size_t extent) { dimensions_.set(dimension, extent, {}); }
  /// @throws ComputationError where values that a reader wants finite are not: the file is not replaced
  template <typename Values>
  void write(const Field& field, const Values& values) {
    if constexpr (std::is_floating_point_v<typename Values::value_type>) {
      require_finite(field, std::span<const typename Values::value_type>(values));
    }
    file_.write(field.path, std::span(values), dimensions_.shape(field, values.size()), field.unit, field.description);
  }
  void write(const Field& field, const std::vector<std::string>& texts) {
    file_.write(field.path, texts, field.description);
  }
  /// An attribute that FieldReader::number() reads. @throws ComputationError where it is not finite
  void number(std::string_view group, std::string_view name, double value);
  /// A history: its first dimension, records, grows.
  void create_growing(const Field& field);

 private:
  template <class Value>
  void require_finite(const Field& field, std::span<const Value> values) const;

  ArrayFileWriter& file_;
  FileDimensions dimensions_;
};

}  // namespace railtab
