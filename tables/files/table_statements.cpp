#include "railtab/tables/files/table_statements.hpp"

#include <fmt/format.h>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tables/files/file_fields.hpp"

namespace railtab {

void write_statements(ArrayFileWriter& file, const TableProvenance& provenance, const TableStatistics& statistics,
                      const std::string& content_checksum) {
  file.attribute("provenance", "program_version", provenance.program_version);
  file.attribute("provenance", "command_line", provenance.command_line);
  file.attribute("provenance", "created", provenance.created);
  for (const auto& [name, value] : statistics) FieldWriter(file).number("statistics", name, value);
  file.attribute("", "checksum", content_checksum);
}

TableStatistics read_statistics(const ArrayFileReader& file, const std::string& group) {
  TableStatistics statistics;
  if (!file.contains(group)) return statistics;
  for (const std::string& name : file.attribute_names(group)) {
    statistics.emplace_back(name, FieldReader(file).number(group, name));
  }
  return statistics;
}

TableProvenance read_provenance(const ArrayFileReader& file) {
  return {file.text("provenance", "program_version"), file.text("provenance", "command_line"),
          file.text("provenance", "created")};
}

void require_checksum(const ArrayFileReader& file, const std::string& found) {
  const std::string expected = file.text("", "checksum");
  if (found == expected) return;
  throw input_error(file.file().string(), fmt::format("contents with checksum {}", found),
                    fmt::format("{}: the file is damaged", expected));
}

}  // namespace railtab
