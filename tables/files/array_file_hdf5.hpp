#pragma once

#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "railtab/runtime/base/input_error.hpp"

/// What the reader and the writer of array files share: handles, errors, the checks before a file is believed.
namespace railtab::hdf5 {

/// Held around every call into HDF5: one thread at a time, since not every build of HDF5 is thread-safe; its error
/// stack kept off the screen, since every error becomes an InputError; no plug-ins loaded, which are code that a file
/// names.
class Section {
 public:
  Section();
  ~Section();
  Section(const Section&) = delete;
  Section& operator=(const Section&) = delete;

 private:
  std::lock_guard<std::mutex> lock_;
  H5E_auto2_t print_ = nullptr;
  void* print_data_ = nullptr;
  unsigned plugins_ = 0;
};

/// Owns an HDF5 identifier; negative is none.
template <herr_t (*close)(hid_t)>
class Handle {
 public:
  Handle() = default;
  explicit Handle(hid_t id) : id_(id) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~Handle() {
    if (id_ >= 0) close(id_);
  }
  [[nodiscard]] hid_t get() const noexcept { return id_; }
  [[nodiscard]] bool valid() const noexcept { return id_ >= 0; }
  /// Close now; false where HDF5 could not.
  [[nodiscard]] bool reset() noexcept { return id_ < 0 || close(std::exchange(id_, -1)) >= 0; }

 private:
  hid_t id_ = -1;
};
using File = Handle<H5Fclose>;
using Object = Handle<H5Oclose>;
using Attribute = Handle<H5Aclose>;
using Space = Handle<H5Sclose>;
using Type = Handle<H5Tclose>;
using Properties = Handle<H5Pclose>;

/// InputError at `place` with what HDF5 said last.
[[nodiscard]] InputError failure(const std::string& place, std::string_view expected);
inline void require(bool done, const std::string& place, std::string_view expected) {
  if (!done) throw failure(place, expected);
}

/// ComputationError at `place` with what the system said: an output could not be written.
[[nodiscard]] ComputationError write_failure(const std::string& place);

[[nodiscard]] std::string place(const std::filesystem::path& file, std::string_view path);
[[nodiscard]] std::string place(const std::filesystem::path& file, std::string_view path, std::string_view attribute);

/// Whether "a/b" exists. Hard links alone are followed. @throws InputError at any other link: it may leave the file.
[[nodiscard]] bool contains(hid_t file, const std::filesystem::path& name, std::string_view path);

/// Opens a group or a plain dataset: one that lies in this file as it is. @throws InputError where there is none, and
/// where a dataset is virtual, lies in other files or needs filters, whose plug-ins are code of others and which can
/// inflate without bound; railtab writes none of these.
[[nodiscard]] Object open_object(hid_t file, const std::filesystem::path& name, std::string_view path);

[[nodiscard]] std::int64_t integer_attribute(hid_t object, const std::string& at, std::string_view name);
/// Of an integer or floating-point attribute.
[[nodiscard]] double number_attribute(hid_t object, const std::string& at, std::string_view name);
[[nodiscard]] std::string text_attribute(hid_t object, const std::string& at, std::string_view name);

/// The first eight bytes of an HDF5 file.
inline constexpr std::string_view signature("\x89HDF\r\n\x1a\n", 8);

/// What the first bytes of a file say ([HDF5 file format specification 3.0, section II.A]).
struct FileState {
  std::uint64_t bytes = 0;
  bool being_written = false;  ///< a writer has it open, or was killed
};
/// Checks that the file exists, is HDF5 and, unless it is being written, not cut short. @throws InputError
[[nodiscard]] FileState inspect_file(const std::filesystem::path& file);

/// HDF5's view of files on a disk, with the rules for failed writes and for what is beyond a file's end.
[[nodiscard]] hid_t file_driver();
/// Drop whatever HDF5 still has to write, also when the file is closed: it stays as it is on the disk.
void stop_writing(hid_t file);

/// Fixed length: HDF5 keeps variable-length text in a heap without checksums.
[[nodiscard]] Type text_type(std::size_t length);

enum class Access { create_whole, create_growing, read, read_growing, write_growing };
/// The one place where files are opened. Invalid where HDF5 cannot.
[[nodiscard]] File open_file(const std::filesystem::path& file, Access access);
/// Groups that keep their attributes in the order of creation, and in the object header, whose checksum covers them.
[[nodiscard]] Properties group_properties(hid_t kind);

/// @param state of the file, found anew where a writer opens or closes it at this moment
/// @throws InputError where HDF5 cannot open it
[[nodiscard]] File open_for_reading(const std::filesystem::path& file, FileState& state);

/// Checks the attributes "filetype" and "format_version" of the root group, in this order. @throws InputError
void check_type(hid_t file, const std::filesystem::path& name, std::string_view filetype, int format_version);

/// Growing datasets have this attribute, with the name of the dataset that counts their rows.
inline constexpr const char* rows_attribute = "rows";
inline constexpr const char* records_dataset = "records";
/// One row for each flush that brought records: their number by then, and a checksum of the new rows of each growing
/// dataset, in the column that its attribute checksum_column names.
inline constexpr const char* blocks_dataset = "block_checksums";
inline constexpr const char* column_attribute = "checksum_column";
/// Of a dataset that does not grow, in a growing file: the checksum of its bytes. Whole files have a seal.
inline constexpr const char* checksum_attribute = "checksum";

}  // namespace railtab::hdf5
