#include "run_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

#include "railtab/runtime/base/file_checksum.hpp"
#include "railtab/runtime/base/input_error.hpp"
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
  RunCount count;
  for (const RunRow& run : runs) {
    if (!pool.finished(run.name)) continue;
    const std::string row = read_row(pool, run, columns);
    rows += row;
    ++count.finished;
    count.ended_early += !complete_of_row(run, row);
  }
  return count;
}

void check_same_scene(std::string text, const std::vector<fs::path>& files, const fs::path& folder) {
  const fs::path file = folder / "scene.toml";
  for (const fs::path& input : files) text += fmt::format("\n# {}: {}", input.string(), file_checksum(input));
  text += '\n';
  try {
    if (!fs::exists(file)) write_text_file(file, text);
  } catch (const std::runtime_error&) {
    if (!fs::exists(file)) throw;  // else another shard was first
  }
  if (whole_text(file) != text) {
    throw input_error(file.string(), "another scene, or other contents of the files that it names",
                      "the scene of this sweep, or another folder for -o");
  }
}

void remove_abandoned_runs(const std::vector<RunRow>& runs, const std::vector<std::string>& others,
                           const fs::path& folder) {
  std::set<std::string> outputs(others.begin(), others.end());
  for (const RunRow& run : runs) {
    for (const char* suffix : {".h5", ".row"}) outputs.insert(run.name + suffix);
  }
  remove_abandoned_in(folder, [&](const std::string& output) { return outputs.contains(output); });
}

}  // namespace railtab::vsi
