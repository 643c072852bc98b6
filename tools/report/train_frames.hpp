#pragma once

#include <string>

#include "railtab/runtime/results/result_file.hpp"

namespace railtab::report {

/// The section with the time slider: train on the deflected bridge, and a wheelset on its rails, drawn by
/// train_script(). Of a long run, at evenly spaced records. Empty where the run has no wheels or fewer than two
/// records.
[[nodiscard]] std::string train_section(const RunResults& results);

/// What draws it, after chart_script().
[[nodiscard]] std::string_view train_script();

}  // namespace railtab::report
