#pragma once

#include <filesystem>
#include <string_view>

#include "railtab/tables/geometry_table.hpp"

namespace railtab {

/// Type that a file of this kind states: a table, or a shard of one.
inline constexpr std::string_view geometry_table_filetype = "railtab-geometry-table";

/// Write a table: to a temporary name beside `file`, then renamed, so that `file` is always whole.
/// @throws InputError where the folder cannot be written.
void write_geometry_table(const std::filesystem::path& file, const GeometryTableData& table);

/// Read a table. Type and format version are checked before anything else, then shapes, then the checksum.
/// @throws InputError with file and place: missing, not HDF5, truncated, of another type or version, checksum wrong.
[[nodiscard]] GeometryTableData read_geometry_table(const std::filesystem::path& file);

}  // namespace railtab
