#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace railtab::vsi {

/// Numbers of a CSV file, columns in the order they were asked for; `line` of each row for messages.
struct CsvTable {
  std::vector<std::vector<double>> rows;
  std::vector<int> line;
};

/// Read a CSV with a header row that has exactly these columns, in any order. Blank lines, lines that begin with
/// '#' and a byte order mark are skipped. @throws InputError with file and line: missing file, missing, unknown or
/// repeated column, wrong number of fields, a field that is no finite number, no row.
[[nodiscard]] CsvTable read_csv(const std::filesystem::path& file, const std::vector<std::string>& columns);

}  // namespace railtab::vsi
