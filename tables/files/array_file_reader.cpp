#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <system_error>

#include "railtab/runtime/base/file_checksum.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/tables/files/array_file.hpp"
#include "railtab/tables/files/array_file_hdf5.hpp"
#include "railtab/tables/files/array_file_seal.hpp"

namespace railtab {

using hdf5::place;
using hdf5::require;
using hdf5::Section;

namespace {

/// An open dataset and the part of it that is to be read.
struct Source {
  hdf5::Object dataset;
  std::vector<hsize_t> extent;
  std::size_t value_bytes = 0;
  std::size_t count = 1;
};

const char* class_name(H5T_class_t type) {
  switch (type) {
    case H5T_INTEGER:
      return "integers";
    case H5T_FLOAT:
      return "floating-point numbers";
    case H5T_STRING:
      return "text";
    default:
      return "data of another type";
  }
}

/// Number of values, counted so that it cannot overflow: no shape is believed that is larger than the file.
std::size_t count_values(const Source& source, std::uint64_t file_bytes, const std::string& at) {
  for (const hsize_t extent : source.extent) {
    if (extent == 0) return 0;
  }
  std::uint64_t room = file_bytes / source.value_bytes;
  std::size_t count = 1;
  for (const hsize_t extent : source.extent) {
    room /= extent;
    if (room == 0) {
      throw input_error(at, fmt::format("the shape ({})", fmt::join(source.extent, ", ")),
                        fmt::format("no more than the {} bytes of the file", file_bytes));
    }
    count *= extent;
  }
  return count;
}

void read_values(const Source& source, hid_t memory_type, void* values, const std::string& at) {
  if (source.count == 0) return;
  const hid_t dataset = source.dataset.get();
  const hdf5::Space file_space(H5Dget_space(dataset));
  const bool scalar = source.extent.empty();
  const std::vector<hsize_t> start(source.extent.size(), 0);
  const hdf5::Space memory_space(
      scalar ? H5Screate(H5S_SCALAR)
             : H5Screate_simple(static_cast<int>(source.extent.size()), source.extent.data(), nullptr));
  herr_t status = scalar ? 0
                         : H5Sselect_hyperslab(file_space.get(), H5S_SELECT_SET, start.data(), nullptr,
                                               source.extent.data(), nullptr);
  if (status >= 0) status = H5Dread(dataset, memory_type, memory_space.get(), file_space.get(), H5P_DEFAULT, values);
  require(status >= 0, at, "readable values");
}

}  // namespace

struct ArrayFileReader::Impl {
  std::filesystem::path file;
  hdf5::FileState state;
  hdf5::File handle;
  std::size_t records = 0;
  /// Records by the end of each block, and the checksums of its rows by column; of growing files.
  std::vector<std::size_t> block_ends;
  std::vector<std::uint64_t> block_sums;
  std::size_t block_width = 0;  ///< columns

  /// Of the datasets that were read: all together have room in the file.
  mutable std::map<std::string, std::uint64_t> bytes_of;
  mutable std::uint64_t all_bytes = 0;

  /// Size of the file; of one that is being written, now.
  [[nodiscard]] std::uint64_t bytes() const {
    std::error_code error;
    const std::uint64_t now = state.being_written ? std::filesystem::file_size(file, error) : state.bytes;
    return error ? state.bytes : now;
  }
  /// Type and shape are checked before any value is read.
  [[nodiscard]] Source open(std::string_view path, H5T_class_t expected) const {
    const std::string at = place(file, path);
    Source source;
    source.dataset = hdf5::open_object(handle.get(), file, path);
    if (H5Iget_type(source.dataset.get()) != H5I_DATASET) throw input_error(at, "a group", "a dataset");
    const hdf5::Type type(H5Dget_type(source.dataset.get()));
    require(type.valid(), at, "a dataset with a type");
    const H5T_class_t found = H5Tget_class(type.get());
    if (found != expected || (found == H5T_STRING && H5Tis_variable_str(type.get()) != 0)) {
      throw input_error(at, class_name(found), fmt::format("{} of fixed length", class_name(expected)));
    }
    source.value_bytes = H5Tget_size(type.get());
    if (found != H5T_STRING && source.value_bytes != sizeof(double) && source.value_bytes != sizeof(float)) {
      throw input_error(at, fmt::format("numbers of {} bytes", source.value_bytes), "numbers of 4 or 8 bytes");
    }
    const hdf5::Space space(H5Dget_space(source.dataset.get()));
    const int rank = space.valid() ? H5Sget_simple_extent_ndims(space.get()) : -1;
    require(rank >= 0 && source.value_bytes > 0, at, "a dataset with a shape");
    source.extent.resize(static_cast<std::size_t>(rank));
    H5Sget_simple_extent_dims(space.get(), source.extent.data(), nullptr);
    limit_rows(source, at);
    source.count = count_values(source, bytes(), at);
    std::uint64_t& own = bytes_of[std::string(path)];
    const std::uint64_t now = source.count * source.value_bytes, together = all_bytes - own + now;
    if (together > bytes()) {
      throw input_error(at, fmt::format("{} bytes of values up to this dataset", together),
                        fmt::format("no more than the {} bytes of the file", bytes()));
    }
    all_bytes = together;
    own = now;
    return source;
  }

  void limit_rows(Source& source, const std::string& at) const {
    if (source.extent.empty() || H5Aexists(source.dataset.get(), hdf5::rows_attribute) <= 0) return;
    if (source.extent[0] < records) {
      throw input_error(at, fmt::format("{} rows", source.extent[0]),
                        fmt::format("{}, the number in {}", records, hdf5::records_dataset));
    }
    source.extent[0] = records;
  }

  /// "records" and the blocks that make them up.
  void read_records();
  void read_blocks();
  /// Compares what was read with the checksums of a growing file.
  void check_rows(const Source& source, std::span<const double> values, const std::string& at) const;
  void check_whole(const Source& source, const std::string& at) const;
};

namespace {

InputError damaged(const std::string& at) {
  return input_error(at, "values that do not agree with their checksum", "undamaged ones");
}

}  // namespace

void ArrayFileReader::Impl::read_records() {
  const std::string at = place(file, hdf5::records_dataset);
  const Source source = open(hdf5::records_dataset, H5T_INTEGER);
  std::vector<std::int64_t> found(source.count);
  read_values(source, H5T_NATIVE_INT64, found.data(), at);
  if (found.size() != 2 || found[0] < 0 || found[1] != -1 - found[0]) {
    throw input_error(at, fmt::format("{}", fmt::join(found, ", ")), "a number N, not negative, and -1 - N");
  }
  if (static_cast<std::uint64_t>(found[0]) > bytes() / sizeof(double)) {  // of one growing dataset at least
    throw input_error(at, fmt::format("{} records", found[0]),
                      fmt::format("what a file of {} bytes can hold", bytes()));
  }
  records = static_cast<std::size_t>(found[0]);
  if (records > 0) read_blocks();
}

void ArrayFileReader::Impl::read_blocks() {
  const std::string at = place(file, hdf5::blocks_dataset);
  const Source source = open(hdf5::blocks_dataset, H5T_INTEGER);
  if (source.extent.size() != 2 || source.extent[1] < 2) {
    throw input_error(at, fmt::format("the shape ({})", fmt::join(source.extent, ", ")), "rows of checksums");
  }
  block_sums.resize(source.count);
  read_values(source, H5T_NATIVE_UINT64, block_sums.data(), at);
  block_width = source.extent[1];
  std::size_t end = 0;
  for (std::size_t row = 0; end < records && row < source.extent[0]; ++row) {
    const std::uint64_t next = block_sums[row * block_width];
    if (next <= end || next > records) break;
    end = next;
    block_ends.push_back(end);
  }
  if (end != records) {
    throw input_error(at, fmt::format("blocks that end at record {}", end), fmt::format("the {} records", records));
  }
}

void ArrayFileReader::Impl::check_rows(const Source& source, std::span<const double> values,
                                       const std::string& at) const {
  if (source.extent.empty() || records == 0 || H5Aexists(source.dataset.get(), hdf5::rows_attribute) <= 0) {
    check_whole(source, at);
    return;
  }
  const std::int64_t column = hdf5::integer_attribute(source.dataset.get(), at, hdf5::column_attribute);
  if (column < 1 || static_cast<std::size_t>(column) >= block_width) {
    throw input_error(at, fmt::format("{} {}", hdf5::column_attribute, column),
                      fmt::format("1 to {}", block_width - 1));
  }
  const std::size_t row_size = source.count / records;
  std::size_t begin = 0;
  for (std::size_t block = 0; block < block_ends.size(); begin = block_ends[block++]) {
    const auto rows = values.subspan(begin * row_size, (block_ends[block] - begin) * row_size);
    if (word_checksum(std::as_bytes(rows)) != block_sums[block * block_width + static_cast<std::size_t>(column)]) {
      throw damaged(fmt::format("{}, records {} to {}", at, begin, block_ends[block] - 1));
    }
  }
}

void ArrayFileReader::Impl::check_whole(const Source& source, const std::string& at) const {
  const hid_t dataset = source.dataset.get();
  if (H5Aexists(dataset, hdf5::checksum_attribute) <= 0) return;
  const auto expected = static_cast<std::uint64_t>(hdf5::integer_attribute(dataset, at, hdf5::checksum_attribute));
  const hdf5::Type type(H5Dget_type(dataset));
  std::vector<std::byte> bytes(source.count * source.value_bytes);
  read_values(source, type.get(), bytes.data(), at);
  if (word_checksum(bytes) != expected) throw damaged(at);
}

ArrayFileReader::ArrayFileReader(std::filesystem::path file, std::string_view filetype, int format_version)
    : impl_(std::make_unique<Impl>()) {
  impl_->file = std::move(file);
  const Section section;
  impl_->state = hdf5::inspect_file(impl_->file);
  impl_->handle = hdf5::open_for_reading(impl_->file, impl_->state);
  hdf5::check_type(impl_->handle.get(), impl_->file, filetype, format_version);
  if (hdf5::contains(impl_->handle.get(), impl_->file, hdf5::records_dataset)) impl_->read_records();
}

ArrayFileReader::~ArrayFileReader() {
  if (!impl_) return;
  const Section section;
  impl_.reset();
}

ArrayFileReader::ArrayFileReader(ArrayFileReader&&) noexcept = default;

bool ArrayFileReader::contains(std::string_view path) const {
  const Section section;
  return hdf5::contains(impl_->handle.get(), impl_->file, path);
}

Array ArrayFileReader::read(std::string_view path) const {
  const Section section;
  const Source source = impl_->open(path, H5T_FLOAT);
  Array array{{source.extent.begin(), source.extent.end()}, std::vector<double>(source.count)};
  const std::string at = place(impl_->file, path);
  read_values(source, H5T_NATIVE_DOUBLE, array.values.data(), at);
  impl_->check_rows(source, array.values, at);
  return array;
}

std::vector<double> ArrayFileReader::read(std::string_view path, const std::vector<long>& expected_shape) const {
  Array array = read(path);
  bool agrees = array.shape.size() == expected_shape.size();
  for (std::size_t i = 0; agrees && i < expected_shape.size(); ++i) {
    agrees = expected_shape[i] == -1 || static_cast<std::size_t>(expected_shape[i]) == array.shape[i];
  }
  if (!agrees) {
    throw input_error(place(impl_->file, path), fmt::format("the shape ({})", fmt::join(array.shape, ", ")),
                      fmt::format("({}), where -1 is any extent", fmt::join(expected_shape, ", ")));
  }
  return std::move(array.values);
}

std::vector<std::int64_t> ArrayFileReader::read_integers(std::string_view path) const {
  const Section section;
  const Source source = impl_->open(path, H5T_INTEGER);
  std::vector<std::int64_t> values(source.count);
  read_values(source, H5T_NATIVE_INT64, values.data(), place(impl_->file, path));
  impl_->check_whole(source, place(impl_->file, path));
  return values;
}

std::vector<std::string> ArrayFileReader::read_strings(std::string_view path) const {
  const Section section;
  const Source source = impl_->open(path, H5T_STRING);
  const hdf5::Type type(H5Dget_type(source.dataset.get()));
  constexpr std::size_t most_texts = 1'000'000;  // each takes far more room in memory than in the file
  if (source.count > most_texts) {
    throw input_error(place(impl_->file, path), fmt::format("{} texts", source.count),
                      fmt::format("{} at most", most_texts));
  }
  std::string bytes(source.count * source.value_bytes, '\0');
  read_values(source, type.get(), bytes.data(), place(impl_->file, path));
  impl_->check_whole(source, place(impl_->file, path));
  std::vector<std::string> values(source.count);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = bytes.substr(i * source.value_bytes, source.value_bytes);
    values[i].resize(values[i].find_last_not_of('\0') + 1);
  }
  return values;
}

double ArrayFileReader::number(std::string_view path, std::string_view name) const {
  const Section section;
  const hdf5::Object object = hdf5::open_object(impl_->handle.get(), impl_->file, path);
  return hdf5::number_attribute(object.get(), place(impl_->file, path, name), name);
}

std::int64_t ArrayFileReader::whole_number(std::string_view path, std::string_view name, std::int64_t low,
                                           std::int64_t high) const {
  const double value = number(path, name);
  if (!(value >= static_cast<double>(low) && value <= static_cast<double>(high) && value == std::floor(value))) {
    throw input_error(place(impl_->file, path, name), fmt::format("{}", value),
                      fmt::format("a whole number, {} to {}", low, high));
  }
  return static_cast<std::int64_t>(value);
}

std::string ArrayFileReader::text(std::string_view path, std::string_view name) const {
  const Section section;
  const hdf5::Object object = hdf5::open_object(impl_->handle.get(), impl_->file, path);
  return hdf5::text_attribute(object.get(), place(impl_->file, path, name), name);
}

std::vector<std::string> ArrayFileReader::attribute_names(std::string_view path) const {
  const Section section;
  const hdf5::Object object = hdf5::open_object(impl_->handle.get(), impl_->file, path);
  std::vector<std::string> names;
  const auto keep = [](hid_t, const char* name, const H5A_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  hsize_t next = 0;
  herr_t status = H5Aiterate2(object.get(), H5_INDEX_CRT_ORDER, H5_ITER_INC, &next, keep, &names);
  if (status < 0) {  // a dataset, which does not keep the order
    names.clear();
    next = 0;
    status = H5Aiterate2(object.get(), H5_INDEX_NAME, H5_ITER_INC, &next, keep, &names);
  }
  require(status >= 0, place(impl_->file, path), "readable attributes");
  return names;
}

const std::filesystem::path& ArrayFileReader::file() const noexcept { return impl_->file; }

std::size_t ArrayFileReader::records() const noexcept { return impl_->records; }

namespace {

std::string root_text(const std::filesystem::path& file, const char* attribute) {
  const Section section;
  hdf5::FileState state = hdf5::inspect_file(file);
  const hdf5::File handle = hdf5::open_for_reading(file, state);
  const hdf5::Object root = hdf5::open_object(handle.get(), file, "");
  return hdf5::text_attribute(root.get(), place(file, "", attribute), attribute);
}

}  // namespace

bool is_array_file(const std::filesystem::path& file) {
  if (is_sealed(file)) return true;
  std::ifstream stream(file, std::ios::binary);
  std::string head(hdf5::signature.size(), '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  return stream && head == hdf5::signature;
}

void require_replaceable(const std::filesystem::path& named, std::initializer_list<std::string_view> filetypes) {
  const std::filesystem::path file = output_file(named);
  std::error_code failed;
  if (!std::filesystem::is_regular_file(file, failed) || std::filesystem::file_size(file, failed) == 0) return;
  std::string found = "a file of another kind";
  if (is_array_file(file)) {
    try {
      found = array_file_type(file);
      if (std::find(filetypes.begin(), filetypes.end(), found) != filetypes.end()) return;
      found = "a file of type " + found;
    } catch (const InputError&) {
      found = "a damaged file";
    }
  }
  throw input_error("-o " + named.string(), found,
                    fmt::format("a new name, or a file of type {} to replace", fmt::join(filetypes, " or ")));
}

std::string array_file_type(const std::filesystem::path& file) { return root_text(file, "filetype"); }

std::string array_file_checksum(const std::filesystem::path& file) { return root_text(file, "checksum"); }

}  // namespace railtab
