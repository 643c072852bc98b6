#pragma once

#include <string>

#include "assessment.hpp"

namespace railtab::assess {

/// Acceleration and displacement of each deck over the speed of moving forces, as HTML; empty without them.
[[nodiscard]] std::string resonance_charts(const Assessment& assessment);
/// Unloading of the governing wheel; extremes along the decks, the nodes that govern and histories; as HTML.
[[nodiscard]] std::string run_charts(const Assessment& assessment);

}  // namespace railtab::assess
