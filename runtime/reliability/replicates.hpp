#pragma once

#include <vector>

#include "railtab/runtime/measures/percentile.hpp"
#include "railtab/runtime/reliability/proportion.hpp"

namespace railtab {

/// A value with the percentile interval of its bootstrap replicates. @pre there are some
[[nodiscard]] inline ConfidenceInterval replicate_interval(double value, const std::vector<double>& replicates,
                                                           double confidence) {
  return {value, percentile(replicates, 0.5 - 0.5 * confidence), percentile(replicates, 0.5 + 0.5 * confidence)};
}

}  // namespace railtab
