#pragma once

#include <string>

#include "work_point.hpp"

namespace railtab::work_precision {

/// Error over time, both logarithmic, as one SVG file that stands alone. Every point has its setting beside it; those
/// on the Pareto front are filled.
[[nodiscard]] std::string log_figure(const WorkFigure& figure);

/// A time [ns] with three digits and its unit.
[[nodiscard]] std::string time_name(double ns);

/// The same values as CSV, one row per point.
[[nodiscard]] std::string csv(const WorkFigure& figure);

}  // namespace railtab::work_precision
