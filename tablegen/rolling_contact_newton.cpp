#include "railtab/tablegen/rolling_contact_newton.hpp"

#include <algorithm>
#include <cmath>

namespace railtab {

namespace {

/// std::hypot guards against overflow, at five times the run time; squares of 1e150 do not occur here.
double length(double x, double y) { return std::sqrt(x * x + y * y); }

}  // namespace

RollingContactNewton::RollingContactNewton(const RollingContactGrid& grid, double nu)
    : grid_(grid), product_(grid.nx, grid.ny, grid.dx, grid.dy, nu), linear_(grid, product_) {
  const int m = grid.count();
  slips_.assign(static_cast<std::size_t>(m), false);
  slip_ = step_ = ElementField::Zero(2 * m);
}

double RollingContactNewton::residual(const ElementField& traction, const ElementField& slip) const {
  const int m = grid_.count();
  const double flexibility = 1.0 / product_.in_row(0, 0);
  double sum = 0.0;
  for (const int k : grid_.inside) {
    const double px = traction[k], py = traction[m + k];
    const double qx = px - slip[k] * flexibility, qy = py - slip[m + k] * flexibility;
    const double q = length(qx, qy);
    const double shrink = q > grid_.bound[k] ? grid_.bound[k] / q : 1.0;
    sum += length(px - shrink * qx, py - shrink * qy);
  }
  return sum * grid_.area();
}

/// Elements at the bound slip while slip opposes them.
void RollingContactNewton::classify(const ElementField& traction, const ElementField& slip) {
  const int m = grid_.count();
  for (const int k : grid_.inside) {
    const double px = traction[k], py = traction[m + k], g = grid_.bound[k];
    const double against = -(px * slip[k] + py * slip[m + k]);
    slips_[k] = px * px + py * py >= g * g * (1.0 - 1e-12) && against > 0.0;
    if (slips_[k]) {
      linear_.slip(k, -py / g, px / g, against / (g * g));
    } else {
      linear_.adhere(k);
    }
  }
}

/// Take the step; whatever leaves the friction circle comes back to it radially.
void RollingContactNewton::update(ElementField& traction) const {
  const int m = grid_.count();
  traction += step_;
  for (const int k : grid_.inside) {
    const double p = length(traction[k], traction[m + k]), g = grid_.bound[k];
    if (p <= g && !slips_[k]) continue;
    traction[k] *= g / p;
    traction[m + k] *= g / p;
  }
}

RollingContactNewton::Outcome RollingContactNewton::solve(const ElementField& rigid_slip, ElementField& traction,
                                                          double tolerance, int max_iterations) {
  Outcome outcome{0.0, 0, 0, false};
  double before = 1.0;
  for (;; ++outcome.iterations) {
    product_.apply(traction, slip_);
    ++outcome.products;
    slip_ += rigid_slip;
    outcome.residual = residual(traction, slip_);
    outcome.converged = outcome.residual <= tolerance;
    if (outcome.converged || outcome.iterations >= max_iterations) return outcome;
    classify(traction, slip_);
    outcome.products += linear_.solve(slip_, std::clamp(0.5 * outcome.residual / before, 0.01, 0.1), step_);
    before = outcome.residual;
    update(traction);
  }
}

}  // namespace railtab
