#pragma once

#include <string>
#include <vector>

namespace railtab::work_precision {

/// One setting of one method: what an evaluation costs and how far off it is.
struct WorkPoint {
  std::string method;   ///< points of one method are joined by a line
  std::string setting;  ///< what distinguishes this point
  double time_ns;       ///< per query or step, median over interleaved passes
  double error;         ///< the quantile that the figure names, in its unit
  double largest_error;
  std::string note;  ///< memory, share of fallback: for the table of values
};

/// A figure of the page.
struct WorkFigure {
  std::string name;   ///< of its files
  std::string title;  ///< heading
  std::string error_label;
  std::string advice;  ///< what to choose and why: one paragraph
  double least_error;  ///< errors below count as this: the resolution of the comparison
  std::vector<WorkPoint> points;
  std::string time_label = "time per query";
};

/// Points that no other point of the figure beats in both time and error.
[[nodiscard]] std::vector<bool> pareto_front(const WorkFigure& figure);

}  // namespace railtab::work_precision
