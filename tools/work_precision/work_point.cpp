#include "work_point.hpp"

#include <algorithm>

namespace railtab::work_precision {

std::vector<bool> pareto_front(const WorkFigure& figure) {
  std::vector<bool> front;
  for (const WorkPoint& p : figure.points) {
    if (figure.kind == FigureKind::time_over_size) {
      front.push_back(false);
      continue;
    }
    const double error = std::max(p.y, figure.least_error);
    front.push_back(std::none_of(figure.points.begin(), figure.points.end(), [&](const WorkPoint& other) {
      const double other_error = std::max(other.y, figure.least_error);
      return (other.x < p.x && other_error <= error) || (other.x <= p.x && other_error < error);
    }));
  }
  return front;
}

}  // namespace railtab::work_precision
