#include "railtab/runtime/vehicle/force_curve.hpp"

#include <algorithm>
#include <cmath>

namespace railtab {

ForceCurve::ForceCurve(std::vector<std::array<double, 2>> points) : points_(std::move(points)) {
  std::array<double, 2> before{0.0, 0.0};
  double area = 0.0;
  for (const std::array<double, 2>& point : points_) {
    slope_.push_back((point[1] - before[1]) / (point[0] - before[0]));
    area_.push_back(area);
    area += 0.5 * (point[0] - before[0]) * (point[1] + before[1]);
    before = point;
  }
}

std::size_t ForceCurve::segment(double magnitude) const noexcept {
  std::size_t i = 0;
  while (i + 1 < points_.size() && magnitude > points_[i][0]) ++i;
  return i;
}

ForceCurve::Value ForceCurve::at(double x) const noexcept {
  const double magnitude = std::abs(x);
  const std::size_t i = segment(magnitude);
  const double force = points_[i][1] + slope_[i] * (magnitude - points_[i][0]);
  return {std::copysign(force, x), slope_[i]};
}

double ForceCurve::integral(double x) const noexcept {
  const double magnitude = std::abs(x);
  const std::size_t i = segment(magnitude);
  const double begin = i == 0 ? 0.0 : points_[i - 1][0];
  const double y0 = i == 0 ? 0.0 : points_[i - 1][1];
  const double way = magnitude - begin;
  return area_[i] + way * (y0 + 0.5 * slope_[i] * way);
}

ForceCurve::Value ForceCurve::mean(double x0, double x1) const noexcept {
  const Value start = at(x0), end = at(x1);
  const bool one_line =
      segment(std::abs(x0)) == segment(std::abs(x1)) && (x0 * x1 >= 0.0 || segment(std::abs(x0)) == 0);
  if (one_line || x0 == x1) return {0.5 * (start.force + end.force), 0.5 * end.slope};
  const double mean = (integral(x1) - integral(x0)) / (x1 - x0);
  return {mean, (end.force - mean) / (x1 - x0)};
}

double ForceCurve::free_travel() const noexcept {
  double free = 0.0;
  for (const std::array<double, 2>& point : points_) {
    if (point[1] > 0.0) break;
    free = point[0];
  }
  return free;
}

FrictionStep slide(double force, double stretch, double limit0, double limit1) noexcept {
  const double before = std::clamp(force, -limit0, limit0);
  const double elastic = before + stretch;
  if (std::abs(elastic) <= limit1) return {elastic, before + 0.5 * stretch, 1.0, 0.5, 0.0, 0.0};
  // The share of the path on which it sticks: the elastic force meets the limit, both linear.
  const double side = elastic > 0.0 ? 1.0 : -1.0;
  const double sticks = (limit0 - side * before) / (side * stretch - (limit1 - limit0));
  return {side * limit1, side * 0.5 * (limit0 + limit1 - sticks * (limit0 - side * before)),
          0.0,           0.5 * sticks * sticks,
          side,          side * 0.5 * (1.0 - sticks * sticks)};
}

}  // namespace railtab
