#pragma once

#include <string>

#include "assessment.hpp"

namespace railtab::assess {

/// The assessment for a terminal: verdict, stages, limits with values, what was not judged and why.
[[nodiscard]] std::string assessment_text(const Assessment& assessment);

}  // namespace railtab::assess
