#include "run_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

#include "railtab/runtime/base/column_rows.hpp"
#include "railtab/runtime/base/file_checksum.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/printable_text.hpp"
#include "railtab/runtime/base/process_end.hpp"
#include "railtab/runtime/base/temporary_file.hpp"
#include "railtab/runtime/base/text_file.hpp"
#include "railtab/runtime/base/text_lines.hpp"

namespace railtab::vsi {
namespace fs = std::filesystem;
namespace {

std::string whole_text(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::vector<std::string_view> fields_of(std::string_view row) {
  if (row.ends_with('\n')) row.remove_suffix(1);
  std::vector<std::string_view> fields;
  cut(row, ',', fields);
  return fields;
}

/// Whether a text is the row of a run under these columns.
bool is_row(const RunRow& run, std::string_view row, std::string_view columns) {
  const std::vector<std::string_view> fields = fields_of(row);
  const auto complete = static_cast<std::size_t>(std::count(run.begin.begin(), run.begin.end(), ','));
  const bool whole =
      row.starts_with(run.begin) && row.find('\n') == row.size() - 1 && fields.size() == fields_of(columns).size();
  return whole && (fields[complete] == "0" || fields[complete] == "1") &&
         std::all_of(fields.begin() + static_cast<std::ptrdiff_t>(complete), fields.end() - 1,
                     [](std::string_view field) { return field.empty() || parse_number(field); });
}

}  // namespace

int code_of_runs(int code, const RunCount& count) noexcept {
  const bool all = count.finished == count.asked;
  if (code == exit_code::failed && all) code = exit_code::done;
  if (code == exit_code::done && !all) code = exit_code::failed;
  return code == exit_code::done && count.ended_early > 0 ? exit_code::failed : code;
}

std::string read_row(const RunPool& pool, const RunRow& run, std::string_view columns) {
  const fs::path file = pool.file(run.name, ".row");
  std::string row = whole_text(file);
  if (is_row(run, row, columns)) return row;
  throw input_error(file.string(), "no row of this run",
                    "the one that the same command wrote; without the file the run is repeated");
}

bool complete_of_row(const RunRow& run, std::string_view row) noexcept { return row[run.begin.size()] == '1'; }

std::string message_cell(std::string message) {
  for (char& letter : message) {
    if (letter == ',' || letter == '\n' || letter == '"') letter = ';';
  }
  return message;
}

RunCount count_rows(const RunPool& pool, const std::vector<RunRow>& runs, std::string_view columns, std::string& rows) {
  RunCount count{.asked = runs.size()};
  for (const RunRow& run : runs) {
    if (!pool.finished(run.name)) continue;
    const std::string row = read_row(pool, run, columns);
    rows += row;
    ++count.finished;
    count.ended_early += !complete_of_row(run, row);
  }
  return count;
}

std::vector<std::string> warnings_of_runs(const RunPool& pool, const std::vector<RunRow>& runs) {
  struct Found {
    std::string alike, warning, first_run;
    std::size_t others = 0;
  };
  std::vector<Found> all;
  for (const RunRow& run : runs) {
    if (!pool.finished(run.name)) continue;
    std::set<std::string> of_run;
    std::ifstream stream(pool.file(run.name, ".warnings"));
    for (std::string warning; std::getline(stream, warning);) {
      std::string alike = warning;
      std::erase_if(alike, [](char letter) { return letter == '.' || (letter >= '0' && letter <= '9'); });
      if (!of_run.insert(alike).second) continue;
      const auto known = std::ranges::find(all, alike, &Found::alike);
      if (known == all.end()) {
        all.push_back({alike, warning, run.name});
      } else {
        ++known->others;
      }
    }
  }
  std::vector<std::string> warnings;
  for (const Found& found : all) {
    const std::string others = found.others == 0 ? "" : fmt::format(", and alike in {} more", found.others);
    warnings.push_back(fmt::format("{} (run {}{})", found.warning, found.first_run, others));
  }
  return warnings;
}

void print_warnings(std::string_view command, const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) print_message(fmt::format("{}: warning: {}\n", command, warning));
}

namespace {

/// How the line of an input's checksum begins.
std::string checksum_mark(const fs::path& input) { return fmt::format("# {}: ", input.string()); }

/// What differs first between the text that a folder is bound to and another one.
std::string first_difference(const std::string& bound, const std::string& text, const std::vector<fs::path>& files) {
  std::istringstream there(bound), now(text);
  std::string before, after;
  for (int line = 1;; ++line) {
    const bool ends_there = !std::getline(there, before), ends_now = !std::getline(now, after);
    if (!ends_there && !ends_now && before == after) continue;
    const auto shown = [](const std::string& row) { return row.empty() ? "an empty line" : railtab::quoted(row); };
    if (ends_there) return fmt::format("line {} is new: {}", line, shown(after));
    if (ends_now) return fmt::format("line {} is gone: {}", line, shown(before));
    for (const fs::path& input : files) {
      const std::string label = checksum_mark(input);
      if (before.starts_with(label) && after.starts_with(label)) {
        return fmt::format("the contents of {} have changed", printable(input.string()));
      }
    }
    return fmt::format("line {} was {} and is {}", line, shown(before), shown(after));
  }
}

}  // namespace

void check_same_scene(const fs::path& scene, std::string text, const std::vector<fs::path>& files,
                      const fs::path& folder) {
  const fs::path file = folder / "scene.toml";
  std::error_code none;
  if (fs::equivalent(scene, file, none)) {
    throw input_error(fmt::format("-o {}", folder.string()),
                      fmt::format("the scene itself, {}, in this folder", file.string()),
                      "another folder: results come with a file scene.toml of their own");
  }
  for (const fs::path& input : files) text += fmt::format("\n{}{}", checksum_mark(input), file_checksum(input));
  text += '\n';
  try {
    if (!fs::exists(file)) write_text_file(file, text);
  } catch (const std::runtime_error&) {
    if (!fs::exists(file)) throw;  // else another shard was first
  }
  if (const std::string bound = whole_text(file); bound != text) {
    throw input_error(file.string(), "another scene",
                      fmt::format("that of the runs in this folder, or another folder for -o; {}",
                                  first_difference(bound, text, files)));
  }
}

void remove_abandoned_runs(const std::vector<RunRow>& runs, const std::vector<std::string>& others,
                           const fs::path& folder) {
  std::set<std::string> outputs(others.begin(), others.end());
  for (const RunRow& run : runs) {
    for (const char* suffix : {".h5", ".row", ".warnings"}) outputs.insert(run.name + suffix);
  }
  remove_abandoned_in(folder, [&](const std::string& output) { return outputs.contains(output); });
}

}  // namespace railtab::vsi
