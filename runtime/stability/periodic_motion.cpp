#include "railtab/runtime/stability/periodic_motion.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <vector>

#include "railtab/runtime/base/dense_solvers.hpp"

namespace railtab {

namespace {

// Share of the residual that an iteration may leave without a new matrix.
constexpr double enough_gain = 0.5;
// An iterate this much worse than the guess, or this far, is lost.
constexpr double lost = 1e3;

}  // namespace

Shooting::Shooting(const Flow& flow, const CycleSection& section, const ShootingLimits& limits)
    : flow_(flow), section_(section), limits_(limits) {}

double Shooting::tolerance(const PeriodicMotion& motion) const {
  const double height = std::abs(motion.start[section_.coordinate]) / flow_.unit()[section_.coordinate];
  return std::max(limits_.tolerance, limits_.relative_tolerance * height);
}

// In units of the flow; the line's equation in that of its coordinate.
std::optional<Eigen::VectorXd> Shooting::equations(const PeriodicMotion& motion, const BranchLine& line) const {
  const std::optional<Eigen::VectorXd> end = flow_.end(motion.start, motion.period, motion.parameter);
  if (!end || !end->allFinite()) return {};
  Eigen::VectorXd residual(size() + 2);
  residual.head(size()) = (*end - motion.start).cwiseQuotient(flow_.unit());
  residual[size()] = motion.start[section_.rate] / flow_.unit()[section_.rate];
  const BranchPoint point = motion.point(section_);
  residual[size() + 1] = line.normal.height * (point.height - line.at.height) +
                         line.normal.parameter * (point.parameter - line.at.parameter);
  return residual;
}

void Shooting::set_line(const BranchPoint& normal, Eigen::MatrixXd& matrix) const {
  matrix.row(size() + 1).setZero();
  matrix(size() + 1, section_.coordinate) = normal.height * flow_.unit()[section_.coordinate];
  matrix(size() + 1, size() + 1) = normal.parameter;
}

bool Shooting::differentiate(const PeriodicMotion& motion) {
  derivatives_ = flow_.end_with_derivatives(motion.start, motion.period, motion.parameter);
  if (!derivatives_ || !derivatives_->by_state.allFinite()) return false;
  const Eigen::Index n = size();
  const Eigen::VectorXd& unit = flow_.unit();
  matrix_.setZero(n + 2, n + 2);
  matrix_.topLeftCorner(n, n) = unit.cwiseInverse().asDiagonal() * derivatives_->by_state * unit.asDiagonal();
  matrix_.topLeftCorner(n, n).diagonal().array() -= 1.0;
  matrix_.col(n).head(n) = derivatives_->by_time.cwiseQuotient(unit);
  matrix_.col(n + 1).head(n) = derivatives_->by_parameter.cwiseQuotient(unit);
  matrix_(n, section_.rate) = 1.0;
  return true;
}

std::optional<PeriodicMotion> Shooting::solve(const PeriodicMotion& guess, const BranchLine& line) {
  PeriodicMotion motion = guess;
  std::optional<Eigen::VectorXd> residual = equations(motion, line);
  iterations_ = 0;
  residual_ = residual ? residual->cwiseAbs().maxCoeff() : std::numeric_limits<double>::infinity();
  const double farthest = lost * std::max(residual_, tolerance(guess));
  bool is_new = false;  // the matrix is that of this iterate
  while (residual && residual_ > tolerance(motion) && residual_ < farthest && iterations_ < limits_.max_iterations) {
    if (matrix_.size() == 0) {
      if (!differentiate(motion)) return {};
      is_new = true;
    }
    set_line(line.normal, matrix_);
    const Eigen::VectorXd correction = -dense_solution(matrix_, *residual);
    PeriodicMotion next = motion;
    next.start += correction.head(size()).cwiseProduct(flow_.unit());
    next.period.duration += correction[size()];
    next.parameter += correction[size() + 1];
    ++iterations_;
    const bool fits = next.start.allFinite() && next.period.duration > 0.0 && next.parameter > 0.0;
    std::optional<Eigen::VectorXd> change = fits ? equations(next, line) : std::nullopt;
    const double remains = change ? change->cwiseAbs().maxCoeff() : std::numeric_limits<double>::infinity();
    if (!is_new && !(remains < enough_gain * residual_)) {
      if (!differentiate(motion)) return {};
      is_new = true;
      continue;
    }
    if (!change) return {};
    matrix_ += (*change - *residual - matrix_ * correction) * (correction.transpose() / correction.squaredNorm());
    is_new = false;
    motion = next;
    residual = std::move(change);
    residual_ = remains;
  }
  if (!(residual_ <= tolerance(motion))) return {};
  remainder_ = *residual;
  return motion;
}

Eigen::VectorXcd Shooting::floquet_multipliers() const {
  // x(T) moves on to the section: by −ẋ (eᵀ M)/(eᵀ ẋ).
  const Eigen::MatrixXd& M = derivatives_->by_state;
  const Eigen::VectorXd& rate = derivatives_->by_time;
  const Eigen::MatrixXd map = M - rate * (M.row(section_.rate) / rate[section_.rate]);
  Eigen::VectorXcd values = general_spectrum(map).values;
  std::sort(values.begin(), values.end(),
            [](std::complex<double> a, std::complex<double> b) { return std::abs(a) > std::abs(b); });
  return values;
}

BranchTangent Shooting::tangent(const BranchPoint& direction) const {
  Eigen::MatrixXd matrix = matrix_;
  set_line(direction, matrix);
  const Eigen::VectorXd t = dense_solution(matrix, Eigen::VectorXd::Unit(size() + 2, size() + 1));
  return {t.head(size()).cwiseProduct(flow_.unit()), t[size()], t[size() + 1]};
}

double Shooting::parameter_error(const BranchPoint& normal) const {
  Eigen::MatrixXd matrix = matrix_;
  set_line(normal, matrix);
  return std::abs(dense_solution(matrix, remainder_)(size() + 1, 0));
}

double Shooting::error_along_motion() const {
  const Eigen::VectorXd& rate = derivatives_->by_time;
  const Eigen::VectorXd& unit = flow_.unit();
  return (derivatives_->by_state * rate - rate).cwiseQuotient(unit).norm() / rate.cwiseQuotient(unit).norm();
}

}  // namespace railtab
