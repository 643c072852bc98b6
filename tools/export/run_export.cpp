#include "run_export.hpp"

#include <fmt/format.h>

#include <fcntl.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <random>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/temporary_file.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/base/writer_lock.hpp"
#include "railtab/runtime/drawing/run_parts.hpp"
#include "vtu_file.hpp"

namespace railtab::vtk {
namespace fs = std::filesystem;
using drawing::Part;
namespace {

constexpr std::string_view collection_ending = ".pvd";

bool begins_with(const fs::path& file, std::string_view mark) {
  std::string head(mark.size(), '\0');
  std::ifstream in(file, std::ios::binary);
  return in.read(head.data(), static_cast<std::streamsize>(head.size())) && head == mark;
}

constexpr std::string_view lock_name = "lock";

/// An earlier export holds nothing but its own files, and its lock where its process was ended.
void require_own_folder(const fs::path& folder) {
  std::error_code failed;
  if (!fs::exists(fs::symlink_status(folder, failed))) return;
  if (!fs::is_directory(folder, failed) || fs::is_symlink(folder, failed)) {
    const bool file = fs::is_regular_file(folder, failed);
    throw input_error(folder.string(), file ? "a file" : what_is_at(folder),
                      "a new name, or the folder of an earlier export");
  }
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().filename() == lock_name && entry.is_regular_file() && entry.file_size() == 0) continue;
    const bool collection = entry.path().extension() == collection_ending;
    if (entry.is_regular_file() && begins_with(entry.path(), collection ? pvd_mark() : vtu_mark())) continue;
    throw input_error(folder.string(), fmt::format("{} in it, which no export wrote", entry.path().filename().string()),
                      "a new name, or the folder of an earlier export, which is replaced as a whole");
  }
}

void write_whole(const fs::path& file, std::string_view text) {
  std::ofstream out(file, std::ios::binary);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  if (!out) throw ComputationError(fmt::format("{}: could not be written, the disk may be full", file.string()));
}

/// Exchanges what two names stand for, or gives the first folder the second name where nothing has it.
std::error_code exchange(const fs::path& folder, const fs::path& other) {
  std::error_code failed;
  if (!fs::exists(other)) {
    fs::rename(folder, other, failed);
    return failed;
  }
  if (::renameat2(AT_FDCWD, folder.c_str(), AT_FDCWD, other.c_str(), RENAME_EXCHANGE) == 0) return {};
  // a file system that cannot do so at once
  const fs::path between = folder.string() + "-old";
  fs::rename(other, between, failed);
  if (failed) return failed;
  fs::rename(folder, other, failed);
  std::error_code also;
  fs::rename(between, failed ? other : folder, also);
  return failed ? failed : also;
}

/// Folders that a process left behind which was ended from outside: nobody holds their lock any more.
void remove_abandoned_folders(const fs::path& final_name) {
  const fs::path parent = final_name.has_parent_path() ? final_name.parent_path() : fs::path(".");
  const std::string begin = fmt::format("{}{}", final_name.filename().string(), temporary_mark);
  std::vector<fs::path> left;
  std::error_code failed;
  for (fs::directory_iterator entry(parent, failed), end; !failed && entry != end; entry.increment(failed)) {
    if (entry->path().filename().string().starts_with(begin)) left.push_back(entry->path());
  }
  for (const fs::path& folder : left) {
    if (WriterLock::if_free(folder / lock_name).held()) fs::remove_all(folder, failed);
  }
}

/// A folder that is gone with this object; once it has its name, the one that had it before.
class NewFolder {
 public:
  explicit NewFolder(const fs::path& final_name) : final_(final_name) {
    remove_abandoned_folders(final_);
    std::random_device random;
    name_ = fmt::format("{}{}{:08x}", final_.string(), temporary_mark, random());
    std::error_code failed;
    if (!fs::create_directory(name_, failed)) {
      throw input_error(final_.string(), fmt::format("a place that cannot be written ({})", failed.message()),
                        "a name in an existing folder that can be written");
    }
    write_whole(name_ / lock_name, {});
    lock_ = WriterLock(name_ / lock_name);
  }
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;
  ~NewFolder() {
    std::error_code ignored;
    fs::remove_all(name_, ignored);
  }
  [[nodiscard]] const fs::path& name() const noexcept { return name_; }

  /// Takes the place of an earlier export.
  void publish() {
    require_own_folder(final_);
    if (const std::error_code failed = exchange(name_, final_)) {
      throw input_error(final_.string(), failed.message(), "a folder that can be replaced");
    }
    std::error_code nothing_to_lock;  // of a new name
    fs::rename(final_ / lock_name, name_ / lock_name, nothing_to_lock);
    fs::remove(final_ / lock_name);
  }

 private:
  fs::path final_, name_;
  WriterLock lock_;
};

/// Points to where they are drawn, and everything into the axes that were asked for.
void place_points(Grid& grid, const ExportOptions& options) {
  for (Array& array : grid.point_data) {
    auto* values = std::get_if<std::vector<float>>(&array.values);
    if (!values || array.components != 3) continue;
    if (array.name == "displacement") {
      for (std::size_t i = 0; i < values->size(); ++i) {
        grid.points[i] = static_cast<float>(grid.points[i] + options.scale * (*values)[i]);
      }
    }
    if (!options.z_up) continue;
    for (std::size_t i = 0; i < values->size(); ++i) (*values)[i] *= i % 3 == 0 ? 1.0F : -1.0F;
  }
  if (!options.z_up) return;
  for (std::size_t i = 0; i < grid.points.size(); ++i) grid.points[i] *= i % 3 == 0 ? 1.0F : -1.0F;
}

void state_origin(Grid& grid, const RunResults& results, const StepRecord& step, const ExportOptions& options) {
  grid.numbers = {{"TimeValue", step.time}, {"displacement_scale", options.scale}};
  grid.texts.emplace_back("scene", std::vector<std::string>{results.header.scene_name});
  grid.texts.emplace_back("program",
                          std::vector<std::string>{fmt::format("railtab {}", results.header.program_version)});
  grid.texts.emplace_back(
      "axes", std::vector<std::string>{options.z_up ? "x forward, y left, z up; m, s, N, rad; forces on the rails"
                                                    : "x forward, y right, z down; m, s, N, rad; forces on the rails"});
  grid.texts.emplace_back("drawn_not_recorded", drawing::drawn_only(results.header));
  grid.texts.emplace_back("not_recorded", drawing::not_recorded(results.header));
  if (!results.summary.complete) {
    grid.texts.emplace_back("run_ended_early", std::vector<std::string>{results.summary.message});
  }
}

}  // namespace

ExportPlace export_place(const std::string& output) {
  ExportPlace place;
  fs::path path = output;
  if (!path.has_filename()) path = path.parent_path();  // "folder/"
  if (path.extension() == collection_ending) {
    place.collection = path;
    place.folder = path;
    place.folder.replace_extension();
    require_replaceable_text(place.collection, pvd_mark());
  } else {
    place.folder = path;
    place.collection = path / "all.pvd";
  }
  require_own_folder(place.folder);
  return place;
}

ExportSummary write_export(const RunResults& results, const ExportOptions& options, const ExportPlace& place) {
  std::vector<Part> parts = drawing::structure_parts(results.header, results.steps);
  for (Part& part : drawing::train_parts(results.header, results.steps)) parts.push_back(std::move(part));
  ExportSummary summary;
  summary.not_recorded = drawing::not_recorded(results.header);
  const bool inside = place.collection.parent_path() == place.folder;
  const std::string prefix = inside ? "" : fmt::format("{}/", place.folder.filename().string());
  std::vector<CollectionEntry> all;
  std::vector<std::vector<CollectionEntry>> of_part(parts.size());
  NewFolder folder(place.folder);
  for (std::size_t frame = 0; frame < options.records.size(); ++frame) {
    const StepRecord& step = results.steps[options.records[frame]];
    for (std::size_t p = 0; p < parts.size(); ++p) {
      Grid grid = parts[p].grid(step);
      place_points(grid, options);
      state_origin(grid, results, step, options);
      const std::string file = fmt::format("{}-{:05}.vtu", parts[p].name, frame);
      write_whole(folder.name() / file, vtu_text(grid));
      all.push_back({step.time, static_cast<int>(p), parts[p].name, prefix + file});
      of_part[p].push_back({step.time, 0, parts[p].name, file});
      ++summary.files;
    }
  }
  for (std::size_t p = 0; p < parts.size(); ++p) {
    write_whole(folder.name() / (fmt::format("{}{}", parts[p].name, collection_ending)), pvd_text(of_part[p]));
    summary.parts.push_back(parts[p].name);
  }
  if (inside) write_whole(folder.name() / place.collection.filename(), pvd_text(all));
  folder.publish();
  if (!inside) write_text_file(place.collection, pvd_text(all), pvd_mark());
  return summary;
}

}  // namespace railtab::vtk
