#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "railtab/runtime/results/result_file.hpp"

namespace railtab::report {

/// Of its first line, see html_first_line().
inline constexpr std::string_view page_kind = "run report";

/// A run as one HTML page that needs no other file and no network: headline numbers, warnings, the train over time,
/// charts, contact positions, what was built and left out, the scene, and where the program's time went.
[[nodiscard]] std::string report_page(const RunResults& results);

/// Several runs on one page: extremes beside each other with their differences to the first run's, scenes where they
/// differ, charts laid over each other. @param names of the runs, each its own @pre at least two runs
[[nodiscard]] std::string comparison_page(std::span<const RunResults> runs, const std::vector<std::string>& names);

}  // namespace railtab::report
