#include "railtab/tables/files/array_file_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "railtab/runtime/base/text_file.hpp"
#include "railtab/tables/files/array_file_seal.hpp"

namespace railtab {

using hdf5::Section;

ArrayFileWriter::Impl::~Impl() {
  const Section section;
  if (mode == Mode::growing && file.valid()) static_cast<void>(H5Fflush(file.get(), H5F_SCOPE_LOCAL));
  abandon();
}

void ArrayFileWriter::Impl::require_written(bool done, const std::string& place) {
  std::string reason = file.valid() ? hdf5::write_failure(file.get()) : "";
  if (done && reason.empty()) return;
  if (reason.empty()) reason = hdf5::last_error();
  abandon();
  throw ComputationError(fmt::format("{}: could not be written: {}", place, reason));
}

void ArrayFileWriter::Impl::abandon() noexcept {
  growing.clear();
  late.clear();
  blocks = {};
  static_cast<void>(file.close());
  temporary = {};
}

void ArrayFileWriter::Impl::create_groups_of(std::string_view path) {
  const hdf5::Properties properties = hdf5::group_properties(H5P_GROUP_CREATE);
  for (std::size_t end = path.find('/'); end != std::string_view::npos; end = path.find('/', end + 1)) {
    const std::string group(path.substr(0, end));
    if (file.contains(group)) continue;
    const hdf5::Object created(H5Gcreate2(file.get(), group.c_str(), H5P_DEFAULT, properties.get(), H5P_DEFAULT));
    require_written(created.valid(), file.place(group));
  }
}

hdf5::Object ArrayFileWriter::Impl::create_dataset(std::string_view path, hid_t type, const Shape& shape,
                                                   std::size_t chunk_bytes, Statement statement) {
  assert(!temporary.name.empty() && "nothing can be created once records have begun");
  create_groups_of(path);
  const int rank = static_cast<int>(shape.size());
  const std::vector<hsize_t> extent(shape.begin(), shape.end());
  std::vector<hsize_t> limit = extent, chunk = extent;
  const hdf5::Properties properties(H5Pcreate(H5P_DATASET_CREATE));
  bool done = properties.valid();
  if (chunk_bytes > 0) {
    limit[0] = H5S_UNLIMITED;
    // At least 8 rows, so that the index of a long run stays small (up to 8180 chunks each of its blocks fits in a
    // page).
    constexpr std::size_t fewest = 8;
    chunk[0] = std::max(fewest, chunk_bytes / (H5Tget_size(type) * product(std::span(shape).subspan(1))));
    constexpr double missing = std::numeric_limits<double>::quiet_NaN();
    done = H5Pset_chunk(properties.get(), rank, chunk.data()) >= 0 &&
           (H5Tget_class(type) != H5T_FLOAT || H5Pset_fill_value(properties.get(), H5T_NATIVE_DOUBLE, &missing) >= 0);
  }
  const hdf5::Space space(shape.empty() ? H5Screate(H5S_SCALAR) : H5Screate_simple(rank, extent.data(), limit.data()));
  hdf5::Object dataset(
      H5Dcreate2(file.get(), std::string(path).c_str(), type, space.get(), H5P_DEFAULT, properties.get(), H5P_DEFAULT));
  require_written(done && dataset.valid(), file.place(path));
  write_text({dataset.get(), path}, "unit", statement.unit);
  write_text({dataset.get(), path}, "description", statement.description);
  return dataset;
}

void ArrayFileWriter::Impl::write_dataset(std::string_view path, hid_t type, std::span<const std::byte> values,
                                          const Shape& shape, Statement statement) {
  const hdf5::Object dataset = create_dataset(path, type, shape, 0, statement);
  require_written(values.empty() || H5Dwrite(dataset.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0,
                  file.place(path));
  if (mode != Mode::growing || path == hdf5::records_dataset) return;
  write_attribute({dataset.get(), path}, hdf5::checksum_attribute, static_cast<std::int64_t>(word_checksum(values)));
}

hdf5::Object ArrayFileWriter::Impl::owner_of_attributes(std::string_view path) {
  if (!path.empty()) create_groups_of(std::string(path) + "/");
  return file.object(path);
}

hdf5::Attribute ArrayFileWriter::Impl::open_attribute(Owner owner, std::string_view name, hid_t type,
                                                      std::size_t values) {
  const std::string key(name);
  hdf5::Attribute attribute;
  if (H5Aexists(owner.object, key.c_str()) > 0) {
    attribute = hdf5::Attribute(H5Aopen(owner.object, key.c_str(), H5P_DEFAULT));
  } else {
    assert(!temporary.name.empty() && "nothing can be created once records have begun");
    const hsize_t extent = values;
    const hdf5::Space space(values == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &extent, nullptr));
    attribute = hdf5::Attribute(H5Acreate2(owner.object, key.c_str(), type, space.get(), H5P_DEFAULT, H5P_DEFAULT));
  }
  require_written(attribute.valid(), file.place(owner.path, name));
  return attribute;
}

void ArrayFileWriter::Impl::write_text(Owner owner, std::string_view name, std::string_view value, std::size_t capacity,
                                       H5T_cset_t letters) {
  const std::size_t wanted = std::max({value.size(), capacity, std::size_t{1}});
  const hdf5::Attribute attribute = open_attribute(owner, name, hdf5::text_type(wanted, letters).get());
  const hdf5::Type type(H5Aget_type(attribute.get()));
  const std::size_t room = H5Tget_size(type.get());
  std::string bytes(value);
  constexpr std::string_view cut = "...";
  if (bytes.size() > room) bytes.replace(room - std::min(room, cut.size()), std::string::npos, cut);
  bytes.resize(room, '\0');
  require_written(H5Awrite(attribute.get(), type.get(), bytes.data()) >= 0, file.place(owner.path, name));
}

ArrayFileWriter::ArrayFileWriter(const std::filesystem::path& file, std::string_view filetype, int format_version,
                                 Mode mode)
    : impl_(std::make_unique<Impl>(mode)) {
  const bool grows = mode == Mode::growing;
  const std::filesystem::path name = output_file(file);
  if (grows && std::filesystem::exists(name)) static_cast<void>(WriterLock(name));
  impl_->temporary = create_temporary(name);
  const Section section;
  impl_->file =
      hdf5::OpenFile(name, impl_->temporary.name, grows ? hdf5::Access::create_growing : hdf5::Access::create_whole);
  const hdf5::Object root = impl_->file.object("");
  impl_->write_text({root.get(), ""}, "filetype", filetype);
  impl_->write_attribute({root.get(), ""}, "format_version", std::int64_t{format_version});
  if (!grows) return;
  const std::array<std::int64_t, 2> none{0, -1};
  impl_->write_dataset(hdf5::records_dataset, type_of<std::int64_t>(), std::as_bytes(std::span(none)), {none.size()},
                       {"1", "rows of the growing datasets that are valid; minus one minus that number"});
}

ArrayFileWriter::ArrayFileWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

ArrayFileWriter::~ArrayFileWriter() = default;
ArrayFileWriter::ArrayFileWriter(ArrayFileWriter&&) noexcept = default;
ArrayFileWriter& ArrayFileWriter::operator=(ArrayFileWriter&&) noexcept = default;

void ArrayFileWriter::write(std::string_view path, const Numbers& numbers, const Shape& shape, std::string_view unit,
                            std::string_view description) {
  const Section section;
  std::visit(
      [&]<typename Number>(std::span<const Number> values) {
        assert(values.size() == product(shape));
        impl_->write_dataset(path, type_of<Number>(), std::as_bytes(values), shape, {unit, description});
      },
      numbers);
}

void ArrayFileWriter::write(std::string_view path, const std::vector<std::string>& values,
                            std::string_view description) {
  std::size_t length = 1;
  for (const std::string& value : values) length = std::max(length, value.size());
  std::string bytes(length * values.size(), '\0');
  for (std::size_t i = 0; i < values.size(); ++i) values[i].copy(bytes.data() + i * length, length);
  const Section section;
  impl_->write_dataset(path, hdf5::text_type(length).get(), std::as_bytes(std::span(bytes)), {values.size()},
                       {"text", description});
}

void ArrayFileWriter::attribute(std::string_view path, std::string_view name,
                                const std::variant<double, std::int64_t, std::string_view>& value,
                                std::size_t capacity) {
  const Section section;
  const hdf5::Object owner = impl_->owner_of_attributes(path);
  const auto write = [&]<typename Value>(Value content) {
    if constexpr (std::is_same_v<Value, std::string_view>) {
      impl_->write_text({owner.get(), path}, name, content, capacity);
    } else {
      impl_->write_attribute({owner.get(), path}, name, content);
    }
  };
  std::visit(write, value);
}

void ArrayFileWriter::ascii_attribute(std::string_view path, std::string_view name, std::string_view value) {
  const Section section;
  const hdf5::Object owner = impl_->owner_of_attributes(path);
  impl_->write_text({owner.get(), path}, name, value, 0, H5T_CSET_ASCII);
}

void ArrayFileWriter::attribute(std::string_view path, std::string_view name, std::span<const std::int64_t> values) {
  const Section section;
  const hdf5::Object owner = impl_->owner_of_attributes(path);
  const hdf5::Attribute attribute =
      impl_->open_attribute({owner.get(), path}, name, type_of<std::int64_t>(), values.size());
  impl_->require_written(H5Awrite(attribute.get(), type_of<std::int64_t>(), values.data()) >= 0,
                         impl_->file.place(path, name));
}

void ArrayFileWriter::close() {
  if (impl_->mode == Mode::growing) flush();
  const Section section;
  impl_->cut();
  impl_->growing.clear();
  impl_->late.clear();
  impl_->blocks = {};
  // All that needs room first, while the file can still be abandoned.
  impl_->require_written(H5Fflush(impl_->file.get(), H5F_SCOPE_LOCAL) >= 0, impl_->file.place(""));
  impl_->require_written(impl_->file.close(), impl_->file.place(""));
  if (impl_->mode == Mode::whole_or_nothing) seal_file(impl_->temporary.name);
  if (!impl_->temporary.name.empty()) {
    impl_->temporary.publish(impl_->file.name());
  } else if (!impl_->temporary.lock.is_of(impl_->file.name())) {
    throw ComputationError(
        fmt::format("{}: was removed, renamed or replaced while it was written", impl_->file.name().string()));
  }
  impl_->temporary = {};
}

}  // namespace railtab
