#include "railtab/tablegen/rolling_contact_transient.hpp"

#include <algorithm>
#include <cmath>

namespace railtab {

namespace {

constexpr int kContactLengths = 40;  // rolled at most; six to twelve are usual at a tolerance of 1e-6
constexpr int kSweeps = 1000;        // of one step at most

struct Traction {
  double x, y;
};

/// Friction at one element: p in the circle g with s = A p + free slip zero inside it and against p on it, A diagonal.
/// On the circle p = −free/(A + λ) with λ > 0 from |p| = g: Newton on 1/|p|, concave and nearly linear in λ.
Traction friction_circle(double free_x, double free_y, double axx, double ayy, double g) {
  double lambda = 0.0;
  for (int i = 0; i < 30; ++i) {
    const Traction p{-free_x / (axx + lambda), -free_y / (ayy + lambda)};
    const double size = std::hypot(p.x, p.y);
    if (i == 0 && size <= g) return p;
    if (std::abs(size - g) <= 1e-14 * g) break;
    const double slope = (p.x * p.x / (axx + lambda) + p.y * p.y / (ayy + lambda)) / size;  // −d|p|/dλ
    lambda += (size / g) * (size - g) / slope;
  }
  const Traction p{-free_x / (axx + lambda), -free_y / (ayy + lambda)};
  const double scale = g / std::hypot(p.x, p.y);
  return {scale * p.x, scale * p.y};
}

}  // namespace

RollingContactTransient::RollingContactTransient(const RollingContactGrid& grid, double nu)
    : grid_(grid), self_(influence_number(0.0, 0.0, grid.dx, grid.dy, nu)) {
  for (int j = -grid.ny; j <= grid.ny; ++j) {
    for (int i = -grid.nx; i <= grid.nx; ++i) {
      const InfluenceNumber a = influence_number(i * grid.dx, j * grid.dy, grid.dx, grid.dy, nu);
      xx_.push_back(a.xx);
      xy_.push_back(a.xy);
      yy_.push_back(a.yy);
    }
  }
}

/// Displacement of all elements, observed `ahead` elements further forward, by a traction on one.
void RollingContactTransient::add(int element, double px, double py, int ahead, ElementField& field) const {
  const int n = grid_.nx, wide = 2 * n + 1;
  const int i = element % n, j = element / n;
  for (int row = 0; row < grid_.ny; ++row) {
    const int first = (row - j + grid_.ny) * wide + n - i + ahead;
    double* x = field.data() + row * n;
    double* y = x + grid_.count();
    for (int k = 0; k < n; ++k) {
      x[k] += xx_[first + k] * px + xy_[first + k] * py;
      y[k] += xy_[first + k] * px + yy_[first + k] * py;
    }
  }
}

/// One pass of Gauss-Seidel. @returns Σ|Δp| dA
double RollingContactTransient::sweep(ElementField& traction, ElementField& slip) const {
  const int m = grid_.count();
  double change = 0.0;
  for (const int k : grid_.inside) {
    const double px = traction[k], py = traction[m + k];
    const Traction p =
        friction_circle(slip[k] - self_.xx * px, slip[m + k] - self_.yy * py, self_.xx, self_.yy, grid_.bound[k]);
    if (p.x == px && p.y == py) continue;
    add(k, p.x - px, p.y - py, 0, slip);
    traction[k] = p.x;
    traction[m + k] = p.y;
    change += std::hypot(p.x - px, p.y - py) * grid_.area();
  }
  return change;
}

RollingContactNewton::Outcome RollingContactTransient::solve(const ElementField& rigid_slip, ElementField& traction,
                                                             double tolerance, RollingContactNewton& newton) {
  const int m = grid_.count();
  RollingContactNewton::Outcome outcome{0.0, 0, 0, false};
  ElementField slip(traction.size());
  while (outcome.iterations < kContactLengths * grid_.nx) {
    slip = rigid_slip;
    for (const int k : grid_.inside) {
      add(k, traction[k], traction[m + k], 0, slip);
      add(k, -traction[k], -traction[m + k], 1, slip);
    }
    double change = sweep(traction, slip);
    for (int i = 1; i < kSweeps && change > 0.01 * tolerance; ++i) change = sweep(traction, slip);
    ++outcome.iterations;
    newton.product().apply(traction, slip);
    ++outcome.products;
    slip += rigid_slip;
    outcome.residual = newton.residual(traction, slip);
    outcome.converged = outcome.residual <= tolerance;
    if (outcome.converged) break;
  }
  return outcome;
}

}  // namespace railtab
