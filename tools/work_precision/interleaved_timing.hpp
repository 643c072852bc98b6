#pragma once

#include <functional>
#include <vector>

namespace railtab::work_precision {

/// Median time of each pass [s]: all passes in turn, `rounds` times, so that what else the machine does falls on all
/// alike. A pass returns a number that depends on its work, so that the work is not left out.
[[nodiscard]] std::vector<double> interleaved_medians(const std::vector<std::function<double()>>& passes, int rounds);

}  // namespace railtab::work_precision
