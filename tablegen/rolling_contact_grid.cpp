#include "railtab/tablegen/rolling_contact_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace railtab {

RollingContactGrid ellipse_grid(double ratio, int elements, ElementSize size) {
  const int n = elements;
  RollingContactGrid grid;
  grid.nx = grid.ny = n;
  grid.bound = Eigen::VectorXd::Zero(n * n);
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      // in units of half an element from the centre, whole numbers: the choice does not hang on rounding
      const int u = 2 * i + 1 - n;
      const int v = 2 * j + 1 - n;
      if (u * u + v * v >= n * n) continue;
      grid.inside.push_back(j * n + i);
    }
  }
  const double covered = 4.0 * static_cast<double>(grid.inside.size()) / (std::numbers::pi * n * n);
  const double shrink = size == ElementSize::equal_area ? 1.0 / std::sqrt(covered) : 1.0;
  const double a = std::sqrt(ratio);
  grid.dx = 2.0 * a / n * shrink;
  grid.dy = 2.0 / (a * n) * shrink;
  for (int i = 0; i < n; ++i) {
    grid.x.push_back((i + 0.5 - 0.5 * n) * grid.dx);
    grid.y.push_back((i + 0.5 - 0.5 * n) * grid.dy);
  }
  for (const int k : grid.inside) {
    // Hertz at the element's true place; scaling may move a centre on the edge a hair outside, where it keeps the
    // pressure of a hair inside
    const double u = grid.x[k % n] / a;
    const double v = grid.y[k / n] * a;
    grid.bound[k] = std::sqrt(std::max(1.0 - u * u - v * v, 1.0 / (n * n)));
  }
  grid.bound /= grid.bound.sum() * grid.area();
  return grid;
}

}  // namespace railtab
