#pragma once

#include <span>
#include <string>
#include <vector>

#include "railtab/runtime/report/axis_ticks.hpp"

namespace railtab::report {

struct Point {
  double x, y;
};

/// At most four points per column of the axis (first, smallest, largest, last), so that no peak is lost at the width
/// that is drawn. x not decreasing; a point with a y that is not finite is kept once as a gap.
[[nodiscard]] std::vector<Point> decimated(std::span<const double> x, std::span<const double> y, const Axis& axis,
                                           int columns);

/// SVG path data in a box of 1000 × 1000, y upward; gaps start a new line.
[[nodiscard]] std::string path_data(std::span<const Point> points, const Axis& x_axis, const Axis& y_axis);

}  // namespace railtab::report
