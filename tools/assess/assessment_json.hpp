#pragma once

#include <nlohmann/json.hpp>

#include "assessment.hpp"

namespace railtab::assess {

/// The whole assessment as one JSON object in SI units; docs/guide/assess.md lists the members.
[[nodiscard]] nlohmann::ordered_json assessment_json(const Assessment& assessment);

}  // namespace railtab::assess
