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

/// A part of the x axis with its name: the bridge, or the time during which a train is on it.
struct Mark {
  double from, to;
  std::string label;
};

/// A line that the page's script draws from a stored history: value·factor + shift over the chart's own x, or over
/// time. @see HistoryStore
struct LiveSeries {
  std::string label;
  std::size_t run = 0, history = 0;
  double offset = 0.0;  ///< added to the run's position where the chart is over position [m]
  double factor = 1.0, shift = 0.0;
  bool shown = false;  ///< when the page opens
};

enum class Over { quantity, position, time };  ///< quantity: a chart that is not drawn live

struct Chart {
  std::string title;
  std::string note;            ///< sign, place, filter: one sentence
  std::string x_label;         ///< with unit
  std::string y_label;         ///< with unit
  std::vector<Series> series;  ///< up to four are told apart by colour
  std::vector<Band> bands;
  std::vector<Limit> limits;  ///< the y axis always reaches them
  std::vector<Mark> marks{};
  Over over = Over::quantity;
  std::vector<LiveSeries> live{};
};

/// Lines that colour and dash tell apart.
inline constexpr std::size_t line_styles = 8;

/// A chart as HTML: text is laid out by the page at its own size, lines are an inline SVG that stretches with it, so
/// that the chart reads the same at any width. Where it has live series, the page's script draws these in its place on
/// a screen; paper and browsers without scripts show the static lines. Empty where no series has a point.
[[nodiscard]] std::string chart_html(const Chart& chart);

}  // namespace railtab::report
