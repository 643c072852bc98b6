#pragma once

#include <cstdint>
#include <optional>

#include "railtab/tables/files/array_file.hpp"
#include "railtab/tables/loaded_table.hpp"

namespace railtab {

/// The loaded part of a geometry table's file, its group "loaded".
void write_loaded_table(ArrayFileWriter& file, const LoadedTableData& table);
/// Nothing where the file has none. @throws InputError
[[nodiscard]] std::optional<LoadedTableData> read_loaded_table(const ArrayFileReader& file);

/// Of all its numbers, after those with the checksum `sum`.
[[nodiscard]] std::uint64_t loaded_checksum(const LoadedTableData& table, std::uint64_t sum) noexcept;

}  // namespace railtab
