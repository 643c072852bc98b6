#pragma once

#include <string>

#include "assessment.hpp"

namespace railtab::assess {

/// The runs with contact as a table: a row per run, a column per measure with its unit, SI; empty cells where a run has
/// no value.
[[nodiscard]] std::string run_columns();
[[nodiscard]] std::string run_rows(const Assessment& assessment);

}  // namespace railtab::assess
