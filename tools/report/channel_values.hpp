#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "railtab/runtime/results/result_file.hpp"

namespace railtab::report {

/// Whether records are too far apart for means over 2 m of way.
[[nodiscard]] bool sparse(const RunResults& run);

/// Amounts of the sliding means over 2 m of way, one per record, NaN where there are none.
/// @param value of a record, NaN where it does not count
[[nodiscard]] std::vector<double> sliding_means(const RunResults& run,
                                                const std::function<double(const StepRecord&)>& value);

/// Time between records [s]; none where they are unevenly spaced. The last one may come early.
[[nodiscard]] std::optional<double> even_spacing(const RunResults& run);

/// The largest amount of all finite values; 0 where there is none.
[[nodiscard]] double largest_amount(const std::vector<double>& values);

}  // namespace railtab::report
