#pragma once

#include <string_view>

namespace railtab {

/// Edit distance of Levenshtein: insertions, deletions and substitutions, for suggestions of what was meant.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

}  // namespace railtab
