#pragma once

#include <filesystem>
#include <string_view>

#include "railtab/tables/creep_table.hpp"

namespace railtab {

inline constexpr std::string_view creep_table_filetype = "railtab-creep-table";

/// Write a table: to a temporary name beside `file`, then renamed, so that `file` is always whole. Values are stored
/// with 32 bits. @throws InputError where the folder cannot be written.
void write_creep_table(const std::filesystem::path& file, const CreepTableData& table);

/// Read a table. Type and format version are checked before anything else, then shapes, then the checksum.
/// @throws InputError with file and place: missing, not HDF5, truncated, of another type or version, checksum wrong.
[[nodiscard]] CreepTableData read_creep_table(const std::filesystem::path& file);

/// The creep table that comes with railtab, for Poisson's ratio 0.28: in the folder RAILTAB_DATA_DIR of the
/// environment, in share/railtab beside the running program's bin, where railtab was installed, or in the source tree,
/// in that order. @throws InputError where it is in none of them.
[[nodiscard]] std::filesystem::path shipped_creep_table();

}  // namespace railtab
