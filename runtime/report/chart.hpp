#pragma once

#include <string>
#include <vector>

namespace railtab::report {

/// One line of a chart, in the units of the chart's axes. x not decreasing; NaN in y is a gap.
struct Series {
  std::string label;
  std::vector<double> x, y;
};

/// The area between two lines, drawn behind the series.
struct Band {
  std::string label;
  std::vector<double> x, low, high;
};

/// A horizontal line with its name: a limit value.
struct Limit {
  double value;
  std::string label;
};

struct Chart {
  std::string title;
  std::string note;            ///< sign, place, filter: one sentence
  std::string x_label;         ///< with unit
  std::string y_label;         ///< with unit
  std::vector<Series> series;  ///< up to four are told apart by colour
  std::vector<Band> bands;
  std::vector<Limit> limits;  ///< the y axis always reaches them
};

/// A chart as HTML: text is laid out by the page at its own size, lines are an inline SVG that stretches with it, so
/// that the chart reads the same at any width. Empty where no series has a point.
[[nodiscard]] std::string chart_html(const Chart& chart);

}  // namespace railtab::report
