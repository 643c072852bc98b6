#include "railtab/runtime/vsi/element_forces.hpp"

#include <cmath>
#include <limits>

#include "railtab/runtime/vsi/contact_newton.hpp"

namespace railtab {

ElementCompliance::ElementCompliance(const VehicleModel& vehicle, const Eigen::MatrixXd& inverse, double load_weight) {
  const Eigen::MatrixXd& rows = vehicle.elements.rows;
  const Eigen::MatrixXd response = load_weight * (inverse * rows.transpose());
  const Eigen::MatrixXd elongation = load_weight * (rows * inverse);
  own = rows * response;
  const auto wheelsets = static_cast<Eigen::Index>(vehicle.wheelsets.size());
  from_wheelsets = Eigen::MatrixXd::Zero(rows.rows(), 6 * wheelsets);
  to_wheelsets = from_wheelsets.transpose();
  for (Eigen::Index k = 0; k < 6 * wheelsets; ++k) {
    const int dof = vehicle.dof[static_cast<std::size_t>(vehicle.wheelsets[static_cast<std::size_t>(k / 6)])]
                               [static_cast<std::size_t>(k % 6)];
    if (dof == held) continue;
    from_wheelsets.col(k) = elongation.col(dof);
    to_wheelsets.row(k) = response.row(dof);
  }
}

ElementCompliance::ElementCompliance(const VehicleModel& vehicle, const std::vector<int>& free,
                                     const Eigen::MatrixXd& inverse, double load_weight) {
  const Eigen::MatrixXd rows = vehicle.elements.rows(Eigen::all, free);
  own = load_weight * (rows * inverse * rows.transpose());
}

void ElementCompliance::leave_out_pitch() {
  constexpr Eigen::Index pitch = 4;
  for (Eigen::Index k = pitch; k < to_wheelsets.rows(); k += 6) {
    to_wheelsets.row(k).setZero();
    from_wheelsets.col(k).setZero();
  }
}

ElementForces::ElementForces(const VehicleModel& vehicle) : elements_(vehicle.elements) {
  const Eigen::Index rows = elements_.rows.rows();
  for (Eigen::VectorXd* v : {&x0_, &v0_, &predicted_, &predicted_rate_, &x_, &share_, &end_}) v->setZero(rows);
  friction_ = friction_end_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(elements_.element.size()));
  slope_.setZero(rows, rows);
}

void ElementForces::begin(const Step& step, const LinearMotion& motion, const Eigen::VectorXd& friction,
                          const Prediction& prediction, const Eigen::VectorXd& guess) {
  step_ = step;
  friction_ = friction;
  x0_.noalias() = elements_.rows * motion.displacement;
  v0_.noalias() = elements_.rows * motion.velocity;
  predicted_.noalias() = elements_.rows * prediction.displacement;
  predicted_rate_.noalias() = elements_.rows * prediction.velocity;
  x_.noalias() = elements_.rows * guess;
}

void ElementForces::begin_rest(const Eigen::VectorXd& displacement, const Eigen::VectorXd& friction) {
  step_ = {ElementRule::rest};
  friction_ = friction;
  x0_.noalias() = elements_.rows * displacement;
  x_ = x0_;
}

// The force at the end of the step and its mean over the path, with their derivatives by the element's elongation.
ElementForces::Evaluated ElementForces::evaluated(std::size_t i) const {
  const ForceElement& e = elements_.element[i];
  const double x = x_[e.row], before = x0_[e.row];
  switch (e.kind) {
    case ForceElementKind::stop:
      return {e.curve.at(before).force, e.curve.at(x), e.curve.mean(before, x)};
    case ForceElementKind::damper: {
      if (step_.rule == ElementRule::rest) return {};
      const double rate = predicted_rate_[e.row] + step_.velocity_rate * (x - predicted_[e.row]);
      ForceCurve::Value end = e.curve.at(rate), mean = e.curve.at((x - before) / step_.time_step);
      end.slope *= step_.velocity_rate;
      mean.slope /= step_.time_step;
      return {e.curve.at(v0_[e.row]).force, end, mean};
    }
    case ForceElementKind::friction: {
      const double begin = friction_[static_cast<Eigen::Index>(i)];
      if (step_.rule == ElementRule::rest) return {begin, {begin, 0.0}, {begin, 0.0}};
      const ForceElement::Limit limit = e.limit(x_);
      const FrictionStep path = slide(begin, e.stiffness * (x - before), e.limit(x0_).force, limit.force);
      return {begin,
              {path.end, e.stiffness * path.end_by_stretch},
              {path.mean, e.stiffness * path.mean_by_stretch},
              path.end_by_limit * limit.by_load_row,
              path.mean_by_limit * limit.by_load_row};
    }
  }
  return {};
}

void ElementForces::evaluate() {
  share_.setZero();
  end_.setZero();
  slope_.setZero();
  const bool mean = step_.rule == ElementRule::energy;
  for (std::size_t i = 0; i < elements_.element.size(); ++i) {
    const ForceElement& e = elements_.element[i];
    const Evaluated f = evaluated(i);
    const double weight = mean ? step_.mean_weight : 1.0;
    share_[e.row] += mean ? weight * (f.mean.force - 0.5 * f.begin) : f.end.force;
    slope_(e.row, e.row) += weight * (mean ? f.mean.slope : f.end.slope);
    if (e.load_row >= 0) slope_(e.row, e.load_row) += weight * (mean ? f.mean_by_load_row : f.end_by_load_row);
    end_[e.row] += f.end.force;
    if (e.kind == ForceElementKind::friction) friction_end_[static_cast<Eigen::Index>(i)] = f.end.force;
  }
}

// I + C ∂f/∂x. Slopes stay as they are while every element stays on its piece: so does the factor, which costs the
// most.
void ElementForces::factor(const ElementCompliance& compliance) {
  const auto same = [](const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) { return a.rows() == b.rows() && a == b; };
  if (same(slope_, factored_slope_) && same(compliance.own, factored_compliance_)) return;
  jacobian_.setIdentity(x_.size(), x_.size());
  jacobian_.noalias() += compliance.own * slope_;
  solver_.compute(jacobian_);
  factored_slope_ = slope_;
  factored_compliance_ = compliance.own;
}

// Newton's method on x − x_free + C f(x) = 0. f is piecewise linear and, but for friction under a load that changes,
// monotone: a few iterations end it exactly. A correction that makes the residual larger is halved.
bool ElementForces::solve(const ElementCompliance& compliance, const Eigen::VectorXd& free) {
  constexpr double rounding = 1e-14, good_enough = 1e-11;  // m, rad
  constexpr int most_iterations = 60, most_halvings = 8;
  const auto residual = [&] {
    evaluate();
    residual_ = x_ - free;
    residual_.noalias() += compliance.own * share_;
    return residual_.cwiseAbs().maxCoeff();
  };
  double size = residual();
  for (int iteration = 0; iteration < most_iterations && !(size <= rounding); ++iteration) {
    factor(compliance);
    correction_ = solver_.solve(residual_);
    x_before_ = x_;
    const double before = size;
    double part = 1.0;
    for (int halving = 0; halving <= most_halvings; ++halving, part *= 0.5) {
      x_ = x_before_ - part * correction_;
      size = residual();
      if (size < before) break;
    }
    if (!std::isfinite(size)) return false;
    if (size >= before && before < good_enough) return true;  // what is left is rounding
  }
  return size <= good_enough;
}

Eigen::MatrixXd ElementForces::stiffening(const ElementCompliance& compliance) const {
  const Eigen::Index n = x_.size();
  const Eigen::MatrixXd jacobian = Eigen::MatrixXd::Identity(n, n) + compliance.own * slope_;
  return compliance.to_wheelsets * slope_ * jacobian.partialPivLu().solve(compliance.from_wheelsets);
}

TrainElements::TrainElements(const VehicleModel& kind, std::size_t vehicles)
    : vehicle(vehicles, ElementForces(kind)), free(vehicles) {}

void TrainElements::respond(const Eigen::VectorXd& force, Eigen::VectorXd& displacement) {
  const Eigen::Index wheelsets = compliance->to_wheelsets.rows() / 6;
  wheelset_force_.resize(6 * wheelsets);
  for (std::size_t v = 0; v < vehicle.size(); ++v) {
    const Eigen::Index first = static_cast<Eigen::Index>(v) * wheelsets;
    for (Eigen::Index w = 0; w < wheelsets; ++w) {
      wheelset_force_.segment<6>(6 * w) = force.segment<6>(wheelset_unknowns * (first + w));
    }
    elongation_ = free[v];
    elongation_.noalias() += compliance->from_wheelsets * wheelset_force_;
    if (!vehicle[v].solve(*compliance, elongation_)) {
      displacement.setConstant(std::numeric_limits<double>::quiet_NaN());
      return;
    }
    wheelset_displacement_.noalias() = compliance->to_wheelsets * vehicle[v].share();
    for (Eigen::Index w = 0; w < wheelsets; ++w) {
      displacement.segment<6>(wheelset_unknowns * (first + w)) -= wheelset_displacement_.segment<6>(6 * w);
    }
  }
}

}  // namespace railtab
