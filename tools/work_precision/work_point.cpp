#include "work_point.hpp"

#include <algorithm>

namespace railtab::work_precision {

std::vector<bool> pareto_front(const WorkFigure& figure) {
  std::vector<bool> front;
  for (const WorkPoint& p : figure.points) {
    const double error = std::max(p.error, figure.least_error);
    front.push_back(std::none_of(figure.points.begin(), figure.points.end(), [&](const WorkPoint& other) {
      const double other_error = std::max(other.error, figure.least_error);
      return (other.time_ns < p.time_ns && other_error <= error) || (other.time_ns <= p.time_ns && other_error < error);
    }));
  }
  return front;
}

}  // namespace railtab::work_precision
