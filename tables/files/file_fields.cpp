#include "railtab/tables/files/file_fields.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cctype>
#include <cmath>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {
namespace {

std::string place(const ArrayFileReader& file, std::string_view path) {
  return fmt::format("{}: {}", file.file().string(), path);
}

bool is_number(const std::string& dimension) {
  return std::isdigit(static_cast<unsigned char>(dimension.front())) != 0;
}

ComputationError not_finite(const ArrayFileWriter& file, std::string_view path, const std::string& found) {
  return ComputationError(
      fmt::format("{}: {}: {}, not a finite number; the file is not written", file.file().string(), path, found));
}

template <class Value>
void check_values(const ArrayFileReader& file, const Field& field, const std::vector<Value>& values) {
  if (field.values == Field::Values::any) return;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) {
      throw input_error(place(file, field.path), fmt::format("{} as value {}", values[i], i), "a finite number");
    }
    if (field.values == Field::Values::increasing && i > 0 && values[i] <= values[i - 1]) {
      throw input_error(place(file, field.path), fmt::format("{} as value {}, after {}", values[i], i, values[i - 1]),
                        "strictly increasing values");
    }
  }
}

}  // namespace

const FileDimensions::Known* FileDimensions::known(const std::string& dimension) const {
  const auto found = known_.find(dimension);
  return found == known_.end() ? nullptr : &found->second;
}

void FileDimensions::set(std::string_view dimension, std::size_t extent, std::string_view path) {
  known_.insert_or_assign(std::string(dimension), Known{extent, std::string(path)});
}

void FileDimensions::require(const std::filesystem::path& file, const Field& field,
                             const std::vector<std::size_t>& shape) {
  bool agrees = shape.size() == field.shape.size();
  std::vector<std::string> expected;
  for (std::size_t i = 0; i < field.shape.size(); ++i) {
    const std::string& name = field.shape[i];
    if (is_number(name)) {
      expected.push_back(name);
      agrees = agrees && shape[i] == std::stoul(name);
    } else if (const Known* extent = known(name)) {
      expected.push_back(fmt::format("{} {}{}", extent->extent, name,
                                     extent->path.empty() ? "" : fmt::format(" as in {}", extent->path)));
      agrees = agrees && shape[i] == extent->extent;
    } else {
      expected.push_back(fmt::format("any number of {}", name));
    }
  }
  if (!agrees) {
    throw input_error(fmt::format("{}: {}", file.string(), field.path),
                      fmt::format("the shape ({})", fmt::join(shape, ", ")),
                      fmt::format("({})", fmt::join(expected, ", ")));
  }
  for (std::size_t i = 0; i < shape.size(); ++i) {
    if (!is_number(field.shape[i])) known_.try_emplace(field.shape[i], Known{shape[i], field.path});
  }
}

std::vector<std::size_t> FileDimensions::shape(const Field& field, std::size_t count) {
  std::vector<std::size_t> shape;
  std::size_t unknown = field.shape.size(), rest = count;
  for (const std::string& name : field.shape) {
    const Known* extent = is_number(name) ? nullptr : known(name);
    const bool open = !is_number(name) && extent == nullptr;
    assert(!open || unknown == field.shape.size());
    if (open) unknown = shape.size();
    shape.push_back(open ? 1 : extent != nullptr ? extent->extent : std::stoul(name));
    if (shape.back() > 0) rest /= shape.back();
  }
  if (unknown < shape.size()) {
    shape[unknown] = rest;
    set(field.shape[unknown], rest, field.path);
  }
  return shape;
}

std::vector<double> FieldReader::numbers(const Field& field) { return checked(field, file_.read(field.path)); }

std::vector<float> FieldReader::floats(const Field& field) { return checked(field, file_.read_floats(field.path)); }

template <class Value>
std::vector<Value> FieldReader::checked(const Field& field, ArrayOf<Value> array) {
  dimensions_.require(file_.file(), field, array.shape);
  check_values(file_, field, array.values);
  return std::move(array.values);
}

std::vector<std::uint32_t> FieldReader::counts(const Field& field) {
  const std::vector<std::int64_t> values = file_.read_integers(field.path);
  dimensions_.require(file_.file(), field, {values.size()});
  std::vector<std::uint32_t> result;
  result.reserve(values.size());
  for (const std::int64_t value : values) {
    if (value < 0 || value > std::numeric_limits<std::uint32_t>::max()) {
      throw input_error(place(file_, field.path), fmt::format("{}", value), "a number of 32 bits");
    }
    result.push_back(static_cast<std::uint32_t>(value));
  }
  return result;
}

std::vector<std::string> FieldReader::texts(const Field& field) {
  std::vector<std::string> values = file_.read_strings(field.path);
  dimensions_.require(file_.file(), field, {values.size()});
  return values;
}

double FieldReader::number(std::string_view group, std::string_view name, double low, double high) const {
  const double value = file_.number(group, name);
  if (value >= low && value <= high) return value;
  const bool any = low == std::numeric_limits<double>::lowest() && high == std::numeric_limits<double>::max();
  throw input_error(fmt::format("{}: {}, attribute {}", file_.file().string(), group, name), fmt::format("{}", value),
                    any ? "a finite number" : fmt::format("{} to {}", low, high));
}

void FieldWriter::number(std::string_view group, std::string_view name, double value) {
  if (!std::isfinite(value)) throw not_finite(file_, group, fmt::format("attribute {} is {}", name, value));
  file_.attribute(group, name, value);
}

void FieldWriter::create_growing(const Field& field) {
  const std::vector<std::size_t> shape = dimensions_.shape(field, 0);
  file_.create_growing(field.path, {shape.begin() + 1, shape.end()}, field.unit, field.description);
}

template <class Value>
void FieldWriter::require_finite(const Field& field, std::span<const Value> values) const {
  if (field.values == Field::Values::any) return;
  const auto wrong = std::find_if_not(values.begin(), values.end(), [](Value value) { return std::isfinite(value); });
  if (wrong == values.end()) return;
  throw not_finite(file_, field.path, fmt::format("value {} is {}", wrong - values.begin(), *wrong));
}
template void FieldWriter::require_finite(const Field&, std::span<const double>) const;
template void FieldWriter::require_finite(const Field&, std::span<const float>) const;

}  // namespace railtab
