#pragma once

#include <string>
#include <string_view>

#include "railtab/tables/geometry_table.hpp"
#include "wheelset_functions.hpp"

namespace railtab {

/// Of its first line, see report::html_first_line().
inline constexpr std::string_view table_page_kind = "contact geometry table";

/// A geometry table as one HTML page: where wheel and rail touch over the lateral shift, rolling radius difference,
/// contact angles, equivalent conicity, and the table's description.
/// @param description plain text, as table_text()
[[nodiscard]] std::string table_page(const WheelRailPair& pair, const GeometryTableData& table,
                                     const WheelsetFunctions& functions, const std::string& description);

}  // namespace railtab
