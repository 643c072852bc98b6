#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "railtab/tablegen/creep_verification.hpp"
#include "railtab/tables/creep_table.hpp"

namespace railtab {

/// Whether a file is a creep table and no geometry table. @throws InputError where it is a part of a creep table.
[[nodiscard]] bool is_creep_table(const std::string& file);

/// A creep table's verification and description, as `verify`, `info` and `creep` print them.
[[nodiscard]] nlohmann::ordered_json verification_description(const CreepVerification& verification);
[[nodiscard]] std::string verification_text(const CreepVerification& verification);
[[nodiscard]] nlohmann::ordered_json table_description(const CreepTableData& table, const std::string& file);
[[nodiscard]] std::string table_text(const CreepTableData& table, const std::string& file);

}  // namespace railtab
