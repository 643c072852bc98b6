#pragma once

#include <vector>

#include "work_point.hpp"

namespace railtab::work_precision {

/// Time integration: time step, alpha and Newton's tolerance against a run of a 16th of the default step, alpha = 0, by
/// wheel forces, on three scenes: a sprung mass on a beam, hunting with flange impacts, a coach on a rough bridge.
[[nodiscard]] std::vector<WorkFigure> integration_figures(bool quick);

}  // namespace railtab::work_precision
