#pragma once

#include <string>
#include <string_view>

#include "assessment.hpp"

namespace railtab::assess {

/// Of its first line, see html_first_line().
inline constexpr std::string_view assessment_page_kind = "assessment";

/// The assessment as one HTML page that needs no other file and no network.
[[nodiscard]] std::string assessment_page(const Assessment& assessment);

}  // namespace railtab::assess
