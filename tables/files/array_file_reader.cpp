#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <system_error>

#include "railtab/runtime/base/file_checksum.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/tables/files/array_file.hpp"
#include "railtab/tables/files/array_file_hdf5.hpp"
#include "railtab/tables/files/array_file_seal.hpp"

namespace railtab {

using hdf5::require;
using hdf5::Section;

namespace {

/// An open dataset and the part of it that is to be read.
struct Source {
  std::string path, at;  ///< in the file, and for messages
  hdf5::Object dataset;
  hdf5::Type type;
  std::vector<hsize_t> extent;  ///< of a growing dataset, up to the records
  std::size_t value_bytes = 0, count = 0;
  bool grows = false;
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

hdf5::OpenFile open_to_read(const std::filesystem::path& file) { return {file, file, hdf5::Access::read}; }

}  // namespace

struct ArrayFileReader::Impl {
  std::uint64_t bytes;  ///< of the file; first, since it is inspected before HDF5 opens it
  hdf5::OpenFile file;
  std::size_t records = 0;
  /// Records by the end of each block, and the checksums of its rows by column; of growing files.
  std::vector<std::size_t> block_ends;
  std::vector<std::uint64_t> block_sums;
  std::size_t block_width = 0;  ///< columns

  /// Of the datasets that were read: all together have room in the file.
  mutable std::map<std::string, std::uint64_t> bytes_of;
  mutable std::uint64_t all_bytes = 0;

  explicit Impl(const std::filesystem::path& name) : bytes(inspect_file(name)), file(open_to_read(name)) {}
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    const Section section;
    static_cast<void>(file.close());
  }

  /// Type and shape are checked before any value is read.
  [[nodiscard]] Source open(std::string_view path, H5T_class_t expected) const {
    Source source{std::string(path), file.place(path), file.object(path), {}, {}};
    const hid_t dataset = source.dataset.get();
    if (H5Iget_type(dataset) != H5I_DATASET) throw input_error(source.at, "a group", "a dataset");
    source.type = hdf5::Type(H5Dget_type(dataset));
    require(source.type.valid(), source.at, "a dataset with a type");
    const H5T_class_t found = H5Tget_class(source.type.get());
    if (found != expected || (found == H5T_STRING && H5Tis_variable_str(source.type.get()) != 0)) {
      throw input_error(source.at, class_name(found), fmt::format("{} of fixed length", class_name(expected)));
    }
    source.value_bytes = H5Tget_size(source.type.get());
    const bool byte = found == H5T_INTEGER && source.value_bytes == 1;
    if (found != H5T_STRING && !byte && source.value_bytes != sizeof(double) && source.value_bytes != sizeof(float)) {
      throw input_error(source.at, fmt::format("numbers of {} bytes", source.value_bytes),
                        "numbers of 4 or 8 bytes, or whole ones of 1");
    }
    source.extent = hdf5::extent_of(dataset, source.at);
    source.grows = !source.extent.empty() && H5Aexists(dataset, hdf5::rows_attribute) > 0;
    if (source.grows && source.extent[0] < records) {
      throw input_error(source.at, fmt::format("{} rows", source.extent[0]),
                        fmt::format("{}, the number in {}", records, hdf5::records_dataset));
    }
    if (source.grows) source.extent[0] = records;
    require_room(source);
    source.count = 1;
    for (const hsize_t extent : source.extent) source.count *= extent;
    return source;
  }

  /// No shape is believed that is larger than the file, nor more names for the same bytes than it has room for.
  void require_room(const Source& source) const {
    auto wanted = static_cast<double>(source.value_bytes);  // cannot overflow
    for (const hsize_t extent : source.extent) wanted *= static_cast<double>(extent);
    const std::string room = fmt::format("no more than the {} bytes of the file", bytes);
    if (wanted > static_cast<double>(bytes)) {
      throw input_error(source.at, fmt::format("the shape ({})", fmt::join(source.extent, ", ")), room);
    }
    std::uint64_t& own = bytes_of[source.path];
    const std::uint64_t together = all_bytes - own + static_cast<std::uint64_t>(wanted);
    if (together > bytes) {
      throw input_error(source.at, fmt::format("{} bytes of values up to this dataset", together), room);
    }
    all_bytes = together;
    own = static_cast<std::uint64_t>(wanted);
  }

  /// Floating-point numbers.
  template <typename Value>
  [[nodiscard]] ArrayOf<Value> read_array(std::string_view path, hid_t memory) const {
    const Source source = open(path, H5T_FLOAT);
    return {{source.extent.begin(), source.extent.end()}, read<Value>(source, memory)};
  }

  /// The values as `memory` has them; of text, the bytes.
  template <typename Value>
  [[nodiscard]] std::vector<Value> read(const Source& source, hid_t memory) const {
    // As the file has them first, for the checksums, then converted in place.
    const std::size_t in_file = source.count * source.value_bytes;
    std::vector<Value> values(std::max(source.count, (in_file + sizeof(Value) - 1) / sizeof(Value)));
    if (source.count > 0) {
      const hdf5::Rows rows(source.dataset.get(), source.extent);
      require(H5Dread(source.dataset.get(), source.type.get(), rows.memory.get(), rows.file.get(), H5P_DEFAULT,
                      values.data()) >= 0,
              source.at, "readable values");
    }
    check(source, std::as_bytes(std::span(values)).first(in_file));
    if (memory == source.type.get()) return values;
    require(H5Tconvert(source.type.get(), memory, source.count, values.data(), nullptr, H5P_DEFAULT) >= 0, source.at,
            "numbers");
    values.resize(source.count);
    return values;
  }

  /// Compares what was read with the checksums of a growing file.
  void check(const Source& source, std::span<const std::byte> values) const {
    const auto damaged = [](const std::string& at) {
      return input_error(at, "values that do not agree with their checksum", "undamaged ones");
    };
    if (!source.grows || records == 0) {
      if (!file.has(source.path, hdf5::checksum_attribute)) return;
      const std::int64_t sum = file.number<std::int64_t>(source.path, hdf5::checksum_attribute);
      if (word_checksum(values) != static_cast<std::uint64_t>(sum)) throw damaged(source.at);
      return;
    }
    const std::int64_t column = file.number<std::int64_t>(source.path, hdf5::column_attribute);
    if (column < 1 || static_cast<std::size_t>(column) >= block_width) {
      throw input_error(source.at, fmt::format("{} {}", hdf5::column_attribute, column),
                        fmt::format("1 to {}", block_width - 1));
    }
    const std::size_t row_bytes = values.size() / records;
    std::size_t begin = 0;
    for (std::size_t block = 0; block < block_ends.size(); begin = block_ends[block++]) {
      const auto rows = values.subspan(begin * row_bytes, (block_ends[block] - begin) * row_bytes);
      if (word_checksum(rows) != block_sums[block * block_width + static_cast<std::size_t>(column)]) {
        throw damaged(fmt::format("{}, records {} to {}", source.at, begin, block_ends[block] - 1));
      }
    }
  }

  void check_type(std::string_view filetype, int format_version) const {
    const std::string& name = file.name().string();
    const std::string found = file.has("", "filetype") ? file.text("", "filetype") : "";
    if (found != filetype) {
      throw input_error(name, found.empty() ? "no attribute filetype" : fmt::format("a file of type {}", found),
                        fmt::format("type {}", filetype));
    }
    const std::int64_t version = file.number<std::int64_t>("", "format_version");
    if (version == format_version) return;
    throw input_error(name, fmt::format("format version {} of {}", version, filetype),
                      fmt::format("version {}, the one that this program reads", format_version));
  }

  /// "records" and the blocks that make them up.
  void read_records() {
    const Source source = open(hdf5::records_dataset, H5T_INTEGER);
    const auto found = read<std::int64_t>(source, H5T_NATIVE_INT64);
    if (found.size() != 2 || found[0] < 0 || found[1] != -1 - found[0]) {
      throw input_error(source.at, fmt::format("{}", fmt::join(found, ", ")), "a number N, not negative, and -1 - N");
    }
    std::error_code error;  // the file may have grown since it was opened
    const std::uint64_t now = std::filesystem::file_size(file.name(), error);
    if (!error) bytes = std::max(bytes, now);
    if (static_cast<std::uint64_t>(found[0]) > bytes / sizeof(double)) {  // of one growing dataset at least
      throw input_error(source.at, fmt::format("{} records", found[0]),
                        fmt::format("what a file of {} bytes can hold", bytes));
    }
    records = static_cast<std::size_t>(found[0]);
    if (records > 0) read_blocks();
  }

  void read_blocks() {
    const Source source = open(hdf5::blocks_dataset, H5T_INTEGER);
    if (source.extent.size() != 2 || source.extent[1] < 2) {
      throw input_error(source.at, fmt::format("the shape ({})", fmt::join(source.extent, ", ")), "rows of checksums");
    }
    block_sums = read<std::uint64_t>(source, H5T_NATIVE_UINT64);
    block_width = source.extent[1];
    std::size_t end = 0;
    for (std::size_t row = 0; end < records && row < source.extent[0]; ++row) {
      const std::uint64_t next = block_sums[row * block_width];
      if (next <= end || next > records) break;
      end = next;
      block_ends.push_back(end);
    }
    if (end == records) return;
    throw input_error(source.at, fmt::format("blocks that end at record {}", end),
                      fmt::format("the {} records", records));
  }
};

ArrayFileReader::ArrayFileReader(const std::filesystem::path& file, std::string_view filetype, int format_version) {
  const Section section;
  impl_ = std::make_unique<Impl>(file);
  impl_->check_type(filetype, format_version);
  if (impl_->file.contains(hdf5::records_dataset)) impl_->read_records();
}

ArrayFileReader::~ArrayFileReader() = default;
ArrayFileReader::ArrayFileReader(ArrayFileReader&&) noexcept = default;

bool ArrayFileReader::contains(std::string_view path) const {
  const Section section;
  return impl_->file.contains(path);
}

Array ArrayFileReader::read(std::string_view path) const {
  const Section section;
  return impl_->read_array<double>(path, H5T_NATIVE_DOUBLE);
}

ArrayOf<float> ArrayFileReader::read_floats(std::string_view path) const {
  const Section section;
  return impl_->read_array<float>(path, H5T_NATIVE_FLOAT);
}

std::vector<std::int64_t> ArrayFileReader::read_integers(std::string_view path) const {
  const Section section;
  return impl_->read<std::int64_t>(impl_->open(path, H5T_INTEGER), H5T_NATIVE_INT64);
}

std::vector<std::size_t> ArrayFileReader::shape(std::string_view path) const {
  const Section section;
  const hdf5::Object dataset = impl_->file.object(path);
  const std::string at = impl_->file.place(path);
  if (H5Iget_type(dataset.get()) != H5I_DATASET) throw input_error(at, "a group", "a dataset");
  std::vector<hsize_t> extent = hdf5::extent_of(dataset.get(), at);
  if (!extent.empty() && H5Aexists(dataset.get(), hdf5::rows_attribute) > 0) extent[0] = impl_->records;
  return {extent.begin(), extent.end()};
}

std::vector<std::string> ArrayFileReader::read_strings(std::string_view path) const {
  const Section section;
  const Source source = impl_->open(path, H5T_STRING);
  constexpr std::size_t most_texts = 1'000'000;  // each takes far more room in memory than in the file
  if (source.count > most_texts) {
    throw input_error(source.at, fmt::format("{} texts", source.count), fmt::format("{} at most", most_texts));
  }
  const std::vector<char> bytes = impl_->read<char>(source, source.type.get());
  std::vector<std::string> values(source.count);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i].assign(bytes.data() + i * source.value_bytes, source.value_bytes);
    values[i].resize(values[i].find_last_not_of('\0') + 1);
  }
  return values;
}

double ArrayFileReader::number(std::string_view path, std::string_view name) const {
  const Section section;
  return impl_->file.number<double>(path, std::string(name).c_str());
}

std::int64_t ArrayFileReader::whole_number(std::string_view path, std::string_view name, std::int64_t low,
                                           std::int64_t high) const {
  const double value = number(path, name);
  if (value >= static_cast<double>(low) && value <= static_cast<double>(high) && value == std::floor(value)) {
    return static_cast<std::int64_t>(value);
  }
  throw input_error(impl_->file.place(path, name), fmt::format("{}", value),
                    fmt::format("a whole number, {} to {}", low, high));
}

std::vector<std::int64_t> ArrayFileReader::whole_numbers(std::string_view path, std::string_view name) const {
  const Section section;
  return impl_->file.integers(path, std::string(name).c_str());
}

std::string ArrayFileReader::text(std::string_view path, std::string_view name) const {
  const Section section;
  return impl_->file.text(path, std::string(name).c_str());
}

std::vector<std::string> ArrayFileReader::attribute_names(std::string_view path) const {
  const Section section;
  const hdf5::Object object = impl_->file.object(path);
  std::vector<std::string> names;
  const auto keep = [](hid_t, const char* name, const H5A_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  for (const H5_index_t order : {H5_INDEX_CRT_ORDER, H5_INDEX_NAME}) {  // other programs do not keep the first
    hsize_t next = 0;
    names.clear();
    if (H5Aiterate2(object.get(), order, H5_ITER_INC, &next, keep, &names) >= 0) return names;
  }
  throw input_error(impl_->file.place(path), hdf5::last_error(), "readable attributes");
}

const std::filesystem::path& ArrayFileReader::file() const noexcept { return impl_->file.name(); }

std::size_t ArrayFileReader::records() const noexcept { return impl_->records; }

const std::vector<std::size_t>& ArrayFileReader::flushes() const noexcept { return impl_->block_ends; }

namespace {

std::string root_text(const std::filesystem::path& file, const char* attribute) {
  const Section section;
  inspect_file(file);
  return open_to_read(file).text("", attribute);
}

}  // namespace

void require_replaceable(const std::filesystem::path& named, std::initializer_list<std::string_view> filetypes) {
  const std::filesystem::path file = output_file(named);
  std::error_code failed;
  if (!is_file(file) || std::filesystem::file_size(file, failed) == 0) return;
  std::string found = "a file of another kind";
  if (is_array_file(file)) {
    try {
      found = array_file_type(file);
      if (std::ranges::count(filetypes, found) > 0) return;
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
