#pragma once

#include <string>
#include <utility>
#include <vector>

#include "railtab/tables/files/array_file.hpp"
#include "railtab/tables/provenance.hpp"

namespace railtab {

using TableStatistics = std::vector<std::pair<std::string, double>>;

/// What every table file states beside its numbers: who made it, statistics by name, the checksum of its contents.
void write_statements(ArrayFileWriter& file, const TableProvenance& provenance, const TableStatistics& statistics,
                      const std::string& content_checksum);

/// Empty where the file has none. @param group of the attributes
[[nodiscard]] TableStatistics read_statistics(const ArrayFileReader& file, const std::string& group = "statistics");
[[nodiscard]] TableProvenance read_provenance(const ArrayFileReader& file);

/// @param found of the contents as they were read @throws InputError where the file states another checksum
void require_checksum(const ArrayFileReader& file, const std::string& found);

}  // namespace railtab
