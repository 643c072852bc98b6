#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "railtab/tablegen/table_verification.hpp"

namespace railtab {

/// The subcommands. `arguments` are those after the subcommand's name. Errors leave as exceptions; see main.cpp.
void batch_command(const std::vector<std::string>& arguments);
void conicity_command(const std::vector<std::string>& arguments);
void contact_command(const std::vector<std::string>& arguments);
void creep_command(const std::vector<std::string>& arguments);
void geometry_command(const std::vector<std::string>& arguments);
void info_command(const std::vector<std::string>& arguments);
void loaded_command(const std::vector<std::string>& arguments);
void merge_command(const std::vector<std::string>& arguments);
void verify_command(const std::vector<std::string>& arguments);

/// What a table is, as `info` and `geometry` print it.
[[nodiscard]] nlohmann::ordered_json table_description(const GeometryTableData& table, const std::string& file);
[[nodiscard]] std::string table_text(const GeometryTableData& table, const std::string& file);

}  // namespace railtab
