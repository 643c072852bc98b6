#include "railtab/tablegen/rolling_contact.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/tablegen/rolling_contact_newton.hpp"
#include "railtab/tablegen/rolling_contact_transient.hpp"
#include "railtab/tablegen/slip_average.hpp"

namespace railtab {

void RollingContactOptions::validate() const {
  if (elements < 4 || elements > 240) throw input_error("elements", fmt::format("{}", elements), "4..240");
  if (!(tolerance >= 1e-12 && tolerance <= 1e-2)) {
    throw input_error("tolerance", fmt::format("{}", tolerance), "1e-12..1e-2");
  }
  if (max_iterations < 0 || max_iterations > 1000) {
    throw input_error("max_iterations", fmt::format("{}", max_iterations), "0..1000");
  }
  if (!(slip_ahead >= 0.0 && slip_ahead <= 1.0)) {
    throw input_error("slip_ahead", fmt::format("{}", slip_ahead), "0..1");
  }
}

struct RollingContact::Impl {
  Impl(RollingContactGrid elements, double poisson, const RollingContactOptions& o)
      : options(o), nu(poisson), grid(std::move(elements)), newton(grid, nu) {}

  [[nodiscard]] RigidSlip rigid_slip(const Creepage& creepage) const;
  [[nodiscard]] ElementField start(const std::vector<double>* given) const;
  void describe(const ElementField& traction, const ElementField& slip, RollingContactSolution& solution) const;

  RollingContactOptions options;
  double nu;
  RollingContactGrid grid;
  RollingContactNewton newton;
  std::optional<RollingContactTransient> transient;  // created at first use
};

RigidSlip RollingContact::Impl::rigid_slip(const Creepage& creepage) const {
  const int n = grid.nx, m = grid.count();
  RigidSlip rigid{ElementField::Zero(2 * m), creepage.spin};
  for (const int k : grid.inside) {
    const double x = grid.x[k % n] + options.slip_ahead * grid.dx;
    rigid.w[k] = creepage.x - creepage.spin * grid.y[k / n];
    rigid.w[m + k] = creepage.y + creepage.spin * x;
  }
  return rigid;
}

ElementField RollingContact::Impl::start(const std::vector<double>* given) const {
  const int m = grid.count();
  ElementField traction = ElementField::Zero(2 * m);
  if (!given) return traction;
  assert(static_cast<int>(given->size()) == 2 * m);
  for (const int k : grid.inside) {
    const double px = (*given)[k], py = (*given)[m + k];
    const double size = std::hypot(px, py);
    const double scale = size > grid.bound[k] ? grid.bound[k] / size : 1.0;
    traction[k] = scale * px;
    traction[m + k] = scale * py;
  }
  return traction;
}

void RollingContact::Impl::describe(const ElementField& traction, const ElementField& slip,
                                    RollingContactSolution& solution) const {
  const int n = grid.nx, m = grid.count();
  double against = 0.0, work = 0.0;
  for (const int k : grid.inside) {
    const double px = traction[k], py = traction[m + k];
    solution.force.x += px * grid.area();
    solution.force.y += py * grid.area();
    solution.force.moment += (grid.x[k % n] * py - grid.y[k / n] * px) * grid.area();
    const double excess = std::hypot(px, py) / grid.bound[k] - 1.0;
    solution.bound_excess = std::max(solution.bound_excess, excess);
    ++(excess > -1e-9 ? solution.slip : solution.adhesion);
    if (excess <= -1e-9) continue;
    against += std::hypot(px, py) * std::hypot(slip[k], slip[m + k]);
    work += px * slip[k] + py * slip[m + k];
  }
  solution.slip_deviation = against > 0.0 ? 1.0 + work / against : 0.0;
  solution.traction.assign(traction.begin(), traction.end());
}

RollingContact::RollingContact(double ratio, double nu, const RollingContactOptions& options) {
  options.validate();
  if (!(ratio >= 1e-4 && ratio <= 1e4)) throw input_error("ratio a/b", fmt::format("{}", ratio), "1e-4..1e4");
  if (!(nu >= 0.0 && nu <= 0.5)) throw input_error("Poisson's ratio", fmt::format("{}", nu), "0..0.5");
  impl_ = std::make_unique<Impl>(ellipse_grid(ratio, options.elements, options.size), nu, options);
}
RollingContact::RollingContact(RollingContactGrid grid, double nu, const RollingContactOptions& options) {
  options.validate();
  assert(!grid.inside.empty());
  if (!(nu >= 0.0 && nu <= 0.5)) throw input_error("Poisson's ratio", fmt::format("{}", nu), "0..0.5");
  impl_ = std::make_unique<Impl>(std::move(grid), nu, options);
}
RollingContact::~RollingContact() = default;
RollingContact::RollingContact(RollingContact&&) noexcept = default;
RollingContact& RollingContact::operator=(RollingContact&&) noexcept = default;

RollingContactSolution RollingContact::solve(const Creepage& creepage, const std::vector<double>* start) {
  assert(std::isfinite(creepage.x) && std::isfinite(creepage.y) && std::isfinite(creepage.spin));
  return solve(impl_->rigid_slip(creepage), start);
}

RollingContactSolution RollingContact::solve(const RigidSlip& rigid, const std::vector<double>* start) {
  const RollingContactOptions& options = impl_->options;
  assert(rigid.w.size() == 2 * impl_->grid.count() && rigid.w.allFinite());
  const ElementField rigid_slip = rigid.w * impl_->grid.dx;
  RollingContactSolution solution;
  ElementField traction = impl_->start(nullptr);
  const double untouched = impl_->newton.residual(traction, rigid_slip);
  const double tolerance = options.tolerance * untouched;
  // Without creepage p = 0 is the solution, and no residual but 0 would do: Newton from another start may only near it.
  if (untouched == 0.0) start = nullptr;
  traction = impl_->start(start);
  auto outcome = impl_->newton.solve(rigid_slip, traction, tolerance, options.max_iterations);
  if (!outcome.converged) {
    if (!impl_->transient) impl_->transient.emplace(impl_->grid, impl_->nu);
    solution.safe_method = true;
    traction = impl_->start(start);
    outcome = impl_->transient->solve(rigid_slip, traction, tolerance, impl_->newton);
  }
  solution.residual = untouched > 0.0 ? outcome.residual / untouched : 0.0;
  solution.iterations = outcome.iterations;
  solution.products = outcome.products;
  solution.converged = outcome.converged;
  ElementField slip(traction.size());
  impl_->newton.product().apply(traction, slip);
  slip += rigid_slip;
  impl_->describe(traction, slip, solution);
  if (options.direction == RollingContactOptions::SlipDirection::averaged) {
    const double rigid_gradient = rigid.spin * impl_->grid.dx;
    const CreepForce correction = slip_average_correction(impl_->grid, traction, slip, rigid_gradient);
    solution.force.x += correction.x;
    solution.force.y += correction.y;
    solution.force.moment += correction.moment;
  }
  return solution;
}

std::vector<double> RollingContact::refined(const std::vector<double>& half_traction) const {
  const RollingContactGrid& grid = impl_->grid;
  const int n = grid.nx, half = n / 2;
  assert(n == grid.ny && n % 2 == 0 && static_cast<int>(half_traction.size()) == 2 * half * half);
  const RollingContactGrid coarse = ellipse_grid(1.0, half, ElementSize::equal_area);
  std::vector<double> traction(static_cast<std::size_t>(2 * n * n), 0.0);
  for (const int k : grid.inside) {
    const int from = k / n / 2 * half + k % n / 2;
    if (coarse.bound[from] == 0.0) continue;
    // the share of friction used is smoother than the traction; a slipping element stays on the circle
    const double scale = grid.bound[k] / coarse.bound[from];
    traction[k] = scale * half_traction[from];
    traction[n * n + k] = scale * half_traction[half * half + from];
  }
  return traction;
}

}  // namespace railtab
