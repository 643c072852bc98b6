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

/// What the reader and the writer of array files share: handles, errors, opening, the checks before a file is believed.
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
  ~Handle() { static_cast<void>(reset()); }
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

/// What HDF5 said last, the innermost of its messages.
[[nodiscard]] std::string last_error();

/// InputError at `place` with what HDF5 said last.
void require(bool done, const std::string& place, std::string_view expected);

/// Shape of a dataset; none of a scalar.
[[nodiscard]] std::vector<hsize_t> extent_of(hid_t dataset, const std::string& place);

/// Values of shape `extent` in memory, and their place in a dataset, from row `first` on.
struct Rows {
  Rows(hid_t dataset, const std::vector<hsize_t>& extent, hsize_t first = 0);
  Space file, memory;
};

enum class Access { create_whole, create_growing, read, write_growing };

/// An open file and its name, which every error names. Paths are as in ArrayFileReader.
class OpenFile {
 public:
  OpenFile() = default;
  /// The one place where files are opened. A new one must be there already, empty (create_temporary).
  /// @throws InputError where HDF5 cannot open it
  OpenFile(std::filesystem::path name, const std::filesystem::path& file, Access access);

  [[nodiscard]] const std::filesystem::path& name() const noexcept { return name_; }
  [[nodiscard]] hid_t get() const noexcept { return handle_.get(); }
  [[nodiscard]] bool valid() const noexcept { return handle_.valid(); }
  [[nodiscard]] bool close() noexcept { return handle_.reset(); }
  [[nodiscard]] std::string place(std::string_view path) const;
  [[nodiscard]] std::string place(std::string_view path, std::string_view attribute) const;

  /// Whether "a/b" exists. Hard links alone are followed. @throws InputError at any other link: it may leave the file.
  [[nodiscard]] bool contains(std::string_view path) const;
  /// Opens a group or a plain dataset: one that lies in this file as it is. @throws InputError where there is none, and
  /// where a dataset is virtual, lies in other files or needs filters, whose plug-ins are code of others and which can
  /// inflate without bound; railtab writes none of these.
  [[nodiscard]] Object object(std::string_view path) const;
  [[nodiscard]] bool has(std::string_view path, const char* attribute) const;
  /// @tparam Number std::int64_t, of an integer attribute; double, of any number
  template <typename Number>
  [[nodiscard]] Number number(std::string_view path, const char* attribute) const;
  /// One alone, or a row of a few.
  [[nodiscard]] std::vector<std::int64_t> integers(std::string_view path, const char* attribute) const;
  [[nodiscard]] std::string text(std::string_view path, const char* attribute) const;

 private:
  /// @param most values
  [[nodiscard]] Attribute open_attribute(std::string_view path, const char* attribute, hssize_t most = 1) const;

  std::filesystem::path name_;
  File handle_;
};

/// HDF5's own driver of files on a disk with one rule more: after a write that failed, nothing more is written to the
/// file, which stays as it is on the disk. HDF5 would try the rest when it closes the file, piece by piece, and leave a
/// mixture.
[[nodiscard]] hid_t file_driver();
/// Why a write to this file has failed; empty where none has. HDF5 does not pass every failure on.
[[nodiscard]] std::string write_failure(hid_t file);

/// Fixed length: HDF5 keeps variable-length text in a heap without checksums.
[[nodiscard]] Type text_type(std::size_t length, H5T_cset_t letters = H5T_CSET_UTF8);

/// Groups that keep their attributes in the order of creation, and in the object header, whose checksum covers them.
[[nodiscard]] Properties group_properties(hid_t kind);

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
