#pragma once

#include <string>
#include <vector>

namespace railtab::work_precision {

/// One setting of one method: what an evaluation costs and how far off it is.
struct WorkPoint {
  std::string method;     ///< points of one method have a colour
  std::string setting;    ///< what distinguishes this point
  double x;               ///< time, median over interleaved passes [ns], or size
  double y;               ///< the error that the figure names, in its unit, or time [ns]
  double largest_error;   ///< 0 where y is no error
  std::string note;       ///< memory, share of fallback: for the table of values
  bool standard = false;  ///< what a user gets who asks for nothing else
  bool joined = true;     ///< by a line with the point of its method before it
};

/// What a figure shows.
enum class FigureKind {
  error_over_time,
  time_over_size,  ///< no Pareto front
};

/// A figure of the page.
struct WorkFigure {
  std::string name;   ///< of its files
  std::string title;  ///< heading
  std::string y_label;
  std::string advice;        ///< what to choose and why: one paragraph
  double least_error = 0.0;  ///< errors below count as this: the resolution of the comparison
  std::vector<WorkPoint> points{};
  std::string x_label = "time per query";
  FigureKind kind = FigureKind::error_over_time;
};

/// Points that no other point of the figure beats in both time and error; none in a figure over sizes.
[[nodiscard]] std::vector<bool> pareto_front(const WorkFigure& figure);

}  // namespace railtab::work_precision
