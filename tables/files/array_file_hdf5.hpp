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

/// Held around every call into HDF5: one thread at a time, since not every build of HDF5 is thread-safe, and its error
/// stack kept off the screen, since every error becomes an InputError.
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
using Group = Handle<H5Gclose>;
using Dataset = Handle<H5Dclose>;
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

/// File access with checksummed metadata, and without HDF5's own file lock, which many file systems lack.
[[nodiscard]] Properties file_access();

/// Gives each object of a growing file pages of its own. A kill can end a write at the edge of a page; an object in one
/// page is written wholly or not at all.
void set_page_alignment(const Properties& access, const std::filesystem::path& file);

/// "a/b" exists as link and object.
[[nodiscard]] bool contains(hid_t file, std::string_view path);

/// Opens a group or dataset. @throws InputError where there is none.
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
