#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "headline.hpp"

namespace railtab::report {

/// The headline of a run for the terminal, one number a line with unit and place.
[[nodiscard]] std::string headline_text(const Headline& headline, const RunSummary& summary);
/// The same numbers as one JSON object, SI units; quantities that the run does not have are left out.
[[nodiscard]] nlohmann::ordered_json headline_json(const Headline& headline, const RunSummary& summary);

}  // namespace railtab::report
