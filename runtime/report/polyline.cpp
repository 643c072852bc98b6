#include "railtab/runtime/report/polyline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <limits>

namespace railtab::report {
namespace {

/// Indices of first, smallest, largest and last point of one column, in the order of x, without repetition.
void append_column(std::span<const double> x, std::span<const double> y, std::size_t begin, std::size_t end,
                   std::vector<Point>& points) {
  std::size_t least = begin, most = begin;
  for (std::size_t i = begin; i < end; ++i) {
    if (y[i] < y[least]) least = i;
    if (y[i] > y[most]) most = i;
  }
  std::size_t chosen[] = {begin, std::min(least, most), std::max(least, most), end - 1};
  std::size_t* const last = std::unique(std::begin(chosen), std::end(chosen));
  for (const std::size_t* i = chosen; i != last; ++i) points.push_back({x[*i], y[*i]});
}

}  // namespace

std::vector<Point> decimated(std::span<const double> x, std::span<const double> y, const Axis& axis, int columns) {
  assert(x.size() == y.size() && columns > 0);
  const auto column = [&](double value) { return std::floor(axis.fraction(value) * columns); };
  std::vector<Point> points;
  std::size_t begin = 0;
  while (begin < x.size()) {
    if (!std::isfinite(y[begin])) {
      const bool gap_open = !points.empty() && !std::isfinite(points.back().y);
      if (!gap_open) points.push_back({x[begin], std::numeric_limits<double>::quiet_NaN()});
      ++begin;
      continue;
    }
    std::size_t end = begin + 1;
    while (end < x.size() && std::isfinite(y[end]) && column(x[end]) == column(x[begin])) ++end;
    append_column(x, y, begin, end, points);
    begin = end;
  }
  return points;
}

std::string path_data(std::span<const Point> points, const Axis& x_axis, const Axis& y_axis) {
  std::string data;
  bool pen_down = false;
  for (const Point& point : points) {
    if (!std::isfinite(point.y)) {
      pen_down = false;
      continue;
    }
    fmt::format_to(std::back_inserter(data), "{}{:.1f} {:.1f}", pen_down ? 'L' : 'M', 1000.0 * x_axis.fraction(point.x),
                   1000.0 * (1.0 - y_axis.fraction(point.y)));
    pen_down = true;
  }
  return data;
}

}  // namespace railtab::report
