#pragma once

#include <string>
#include <vector>

#include "railtab/runtime/report/chart.hpp"

namespace railtab::report {

/// What one unit of each axis measures on the page: as much as fits, or the same length for both (drawings).
enum class SvgScale { each_axis, equal };

enum class LineStyle { solid, dashed };

/// A diagram of a figure: lines, and values to hold them against as circles.
struct SvgPanel {
  std::string title;
  std::string x_label, y_label;  ///< with unit
  std::vector<Series> lines;     ///< NaN in y is a gap; up to four are told apart by colour
  std::vector<Series> dots;      ///< circles in the colour of the line of the same place
  SvgScale scale = SvgScale::each_axis;
  std::vector<LineStyle> styles{};  ///< of the lines; solid where there is none
};

/// Diagrams beside and below each other as one SVG file that stands alone. One legend below the heading where it
/// holds for all diagrams, otherwise one above each.
/// @param columns diagrams beside each other
[[nodiscard]] std::string svg_figure(const std::string& heading, const std::vector<SvgPanel>& panels, int columns);

}  // namespace railtab::report
