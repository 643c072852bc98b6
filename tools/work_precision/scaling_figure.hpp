#pragma once

#include <filesystem>
#include <vector>

#include "work_point.hpp"

namespace railtab::work_precision {

/// Time per step and of the set-up over the unknowns of the structure for trains of several lengths on plain track,
/// time per step over the wheels. Contact from the geometry table where one is named, else from the online search.
[[nodiscard]] std::vector<WorkFigure> scaling_figures(const std::filesystem::path& geometry_table, bool quick);

/// Wall time of a geometry table over the threads that make it.
[[nodiscard]] WorkFigure threads_figure(bool quick);

}  // namespace railtab::work_precision
