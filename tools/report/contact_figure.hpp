#pragma once

#include <string>

#include "railtab/runtime/results/result_file.hpp"

namespace railtab::report {

/// Wheel and rail outlines of both sides, seen along the track, with how often each place of the rail and of the wheel
/// was in contact over all wheels and records. Empty where the results hold no outlines.
[[nodiscard]] std::string contact_figure(const RunResults& results);

}  // namespace railtab::report
