#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "railtab/runtime/results/result_file.hpp"

namespace railtab::report {

/// Of its first line, see html_first_line().
inline constexpr std::string_view page_kind = "run report";

/// A run as one HTML page that needs no other file and no network: headline numbers, charts, contact positions, where
/// the time went, the scene.
[[nodiscard]] std::string report_page(const RunResults& results);

/// Writes the page; the file is whole or not there. @throws InputError where it cannot be written.
void write_report(const std::filesystem::path& file, const RunResults& results);

}  // namespace railtab::report
