#include "fmu_file.hpp"

#include <fmt/format.h>
#include <minizip/unzip.h>
#include <minizip/zip.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>
#include <type_traits>

#include "embedded.h"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/temporary_file.hpp"
#include "railtab/runtime/base/text_file.hpp"

namespace railtab::fmu {
namespace {

constexpr const char* description_name = "modelDescription.xml";

/// A zip archive under construction. Every entry has the same date, so that the bytes do not depend on the clock.
class Archive {
 public:
  Archive(const std::filesystem::path& file, const std::filesystem::path& name)
      : name_(name), zip_(zipOpen64(file.c_str(), APPEND_STATUS_CREATE)) {
    if (!zip_) fail();
  }
  void add(const char* entry, std::string_view bytes) {
    zip_fileinfo info{};
    info.dosDate = (1U << 21U) | (1U << 16U);  // 1 January 1980, the first that a zip archive knows
    constexpr std::size_t portion = std::size_t{1} << 30, zip64_from = 0xFFFFFFFF;
    check(zipOpenNewFileInZip64(zip_.get(), entry, &info, nullptr, 0, nullptr, 0, nullptr, Z_DEFLATED,
                                Z_DEFAULT_COMPRESSION, bytes.size() >= zip64_from));
    for (; !bytes.empty(); bytes.remove_prefix(std::min(portion, bytes.size()))) {
      check(zipWriteInFileInZip(zip_.get(), bytes.data(), static_cast<unsigned>(std::min(portion, bytes.size()))));
    }
    check(zipCloseFileInZip(zip_.get()));
  }
  void finish() { check(zipClose(zip_.release(), nullptr)); }

 private:
  [[noreturn]] void fail() const {
    throw ComputationError(fmt::format("{}: could not be written, the disk may be full", name_.string()));
  }
  void check(int status) const {
    if (status != ZIP_OK) fail();
  }
  struct Close {
    void operator()(zipFile zip) const noexcept { zipClose(zip, nullptr); }
  };
  std::filesystem::path name_;
  std::unique_ptr<std::remove_pointer_t<zipFile>, Close> zip_;
};

}  // namespace

bool is_fmu(const std::filesystem::path& file) {
  struct Close {
    void operator()(unzFile zip) const noexcept { unzClose(zip); }
  };
  const std::unique_ptr<std::remove_pointer_t<unzFile>, Close> zip(unzOpen64(file.c_str()));
  constexpr int case_sensitive = 1;
  if (!zip || unzLocateFile(zip.get(), description_name, case_sensitive) != UNZ_OK ||
      unzOpenCurrentFile(zip.get()) != UNZ_OK) {
    return false;
  }
  std::array<char, 8192> head;  // the element fmiModelDescription begins the file
  const int count = unzReadCurrentFile(zip.get(), head.data(), static_cast<unsigned>(head.size()));
  return count > 0 &&
         std::string_view(head.data(), static_cast<std::size_t>(count)).find(" generationTool=\"railtab ") !=
             std::string_view::npos;
}

void write_fmu(const std::filesystem::path& file, const fmi::DrivenTrack& track, const std::string& scene_text) {
  const std::filesystem::path target = output_file(file);
  std::error_code none;
  if (is_file(target) && std::filesystem::file_size(target, none) > 0 && !is_fmu(target)) {
    throw input_error(file.string(), "a file that is no FMU of railtab", "a new name, or an earlier FMU to replace");
  }
  const std::string bytes = fmi::track_bytes(track);
  TemporaryFile temporary = create_temporary(target);
  Archive archive(temporary.name, target);
  archive.add(description_name, model_description(track, fmi::track_guid(bytes)));
  archive.add("binaries/linux64/railtab_track.so", {railtab_fmu_library_begin, railtab_fmu_library_end});
  archive.add("resources/track", bytes);
  archive.add("documentation/scene.toml", scene_text);
  archive.add("documentation/licenses/LICENSE", {railtab_license_begin, railtab_license_end});
  archive.finish();
  temporary.publish(target);
}

}  // namespace railtab::fmu
