#pragma once

#include <string>

#include "command/json_text.hpp"
#include "railtab/runtime/stability/hunting_branch.hpp"

namespace railtab::vsi {

/// The branch in words and a row per limit cycle.
[[nodiscard]] std::string branch_text(const HuntingBranch& branch);
/// Members of the JSON object of `vsi critical-speed`.
[[nodiscard]] nlohmann::ordered_json branch_json(const HuntingBranch& branch);
/// A row per limit cycle.
[[nodiscard]] std::string branch_csv(const HuntingBranch& branch);
/// The bifurcation diagram: amplitude over speed.
[[nodiscard]] std::string branch_svg(const HuntingBranch& branch, const std::string& heading);

/// Why the branch ends, a part of a sentence.
[[nodiscard]] std::string end_text(BranchEnd end);

}  // namespace railtab::vsi
