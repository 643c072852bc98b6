#include "railtab/runtime/vsi/element_forces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "railtab/runtime/base/index.hpp"
#include "railtab/runtime/vsi/contact_newton.hpp"

namespace railtab {

ElementCompliance::ElementCompliance(const VehicleModel& vehicle, const SeparateSystem& system,
                                     const Eigen::MatrixXd& inverse, double load_weight) {
  const Eigen::MatrixXd rows = vehicle.elements.rows(system.elongations, system.dofs);
  const Eigen::MatrixXd of_system = inverse(system.dofs, system.dofs);
  const Eigen::MatrixXd response = load_weight * (of_system * rows.transpose());
  const Eigen::MatrixXd elongation = load_weight * (rows * of_system);
  own = rows * response;
  const auto unknowns = static_cast<Eigen::Index>(6 * system.wheelsets.size());
  from_wheelsets = Eigen::MatrixXd::Zero(rows.rows(), unknowns);
  to_wheelsets = from_wheelsets.transpose();
  for (Eigen::Index k = 0; k < unknowns; ++k) {
    const int wheelset = system.wheelsets[static_cast<std::size_t>(k / 6)];
    const int dof = vehicle.dof[index(vehicle.wheelsets[index(wheelset)])][static_cast<std::size_t>(k % 6)];
    if (dof == held) continue;
    const auto of_dof = std::lower_bound(system.dofs.begin(), system.dofs.end(), dof) - system.dofs.begin();
    from_wheelsets.col(k) = elongation.col(of_dof);
    to_wheelsets.row(k) = response.row(of_dof);
  }
}

ElementCompliance::ElementCompliance(const VehicleModel& vehicle, const SeparateSystem& system,
                                     const std::vector<int>& free, const Eigen::MatrixXd& inverse, double load_weight) {
  const Eigen::MatrixXd rows = vehicle.elements.rows(system.elongations, free);
  own = load_weight * (rows * inverse * rows.transpose());
}

void ElementCompliance::leave_out_pitch() {
  constexpr Eigen::Index pitch = 4;
  for (Eigen::Index k = pitch; k < to_wheelsets.rows(); k += 6) {
    to_wheelsets.row(k).setZero();
    from_wheelsets.col(k).setZero();
  }
}

ElementForces::ElementForces(const VehicleModel& vehicle, const SeparateSystem& system)
    : system_(system),
      whole_(static_cast<int>(system.dofs.size()) == vehicle.dofs()),
      elements_(elements_of(system, vehicle.elements)) {
  only_stops_ = std::all_of(elements_.element.begin(), elements_.element.end(),
                            [](const ForceElement& e) { return e.kind == ForceElementKind::stop; });
  const Eigen::Index rows = elements_.rows.rows();
  for (Eigen::VectorXd* v : {&x0_, &v0_, &predicted_, &predicted_rate_, &x_, &share_, &end_}) v->setZero(rows);
  friction_ = friction_end_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(elements_.element.size()));
  slope_.setZero(rows, rows);
}

void ElementForces::elongate(const Eigen::VectorXd& displacement, Eigen::VectorXd& elongation) const {
  if (whole_) {
    elongation.noalias() = elements_.rows * displacement;
  } else {
    elongation.setZero(elements_.rows.rows());
    for (std::size_t k = 0; k < system_.dofs.size(); ++k) {
      elongation += displacement[system_.dofs[k]] * elements_.rows.col(static_cast<Eigen::Index>(k));
    }
  }
}

void ElementForces::add_load(const Eigen::VectorXd& force, Eigen::VectorXd& load) const {
  if (whole_) {
    load.noalias() -= elements_.rows.transpose() * force;
  } else {
    for (std::size_t k = 0; k < system_.dofs.size(); ++k) {
      load[system_.dofs[k]] -= elements_.rows.col(static_cast<Eigen::Index>(k)).dot(force);
    }
  }
}

void ElementForces::take_friction(const Eigen::VectorXd& of_vehicle) {
  for (std::size_t i = 0; i < system_.elements.size(); ++i) {
    friction_[static_cast<Eigen::Index>(i)] = of_vehicle[system_.elements[i]];
  }
}

void ElementForces::store_friction(Eigen::VectorXd& friction) const {
  for (std::size_t i = 0; i < system_.elements.size(); ++i) {
    friction[system_.elements[i]] = friction_end_[static_cast<Eigen::Index>(i)];
  }
}

void ElementForces::begin(const Step& step, const Start& start) {
  step_ = step;
  take_friction(start.friction);
  elongate(start.motion.displacement, x0_);
  elongate(start.guess, x_);
  if (only_stops_) return;  // which do not depend on rates
  elongate(start.motion.velocity, v0_);
  elongate(start.prediction.displacement, predicted_);
  elongate(start.prediction.velocity, predicted_rate_);
}

void ElementForces::begin_rest(const Eigen::VectorXd& displacement, const Eigen::VectorXd& friction) {
  step_ = {ElementRule::rest};
  take_friction(friction);
  elongate(displacement, x0_);
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
  solver_.factor(jacobian_);
  factored_slope_ = slope_;
  factored_compliance_ = compliance.own;
}

// Newton's method on x − x_free + C f(x) = 0. f is piecewise linear and, but for friction under a load that changes,
// monotone: a few iterations end it exactly. A correction that makes the residual larger is halved. Stops within their
// clearance exert nothing: x = x_free is the solution.
bool ElementForces::solve(const ElementCompliance& compliance, const Eigen::VectorXd& free) {
  if (empty()) return true;
  constexpr double rounding = 1e-14, good_enough = 1e-11;  // m, rad
  constexpr int most_iterations = 60, most_halvings = 8;
  const auto residual = [&] {
    evaluate();
    residual_ = x_ - free;
    residual_.noalias() += compliance.own * share_;
    return residual_.cwiseAbs().maxCoeff();
  };
  if (only_stops_) {
    x_before_ = x_;
    x_ = free;
    evaluate();
    if (exert_nothing()) return true;
    x_ = x_before_;
  }
  double size = residual();
  for (int iteration = 0; iteration < most_iterations && !(size <= rounding); ++iteration) {
    factor(compliance);
    solver_.solve(residual_, correction_);
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
  return compliance.to_wheelsets * slope_ * dense_solution(jacobian, compliance.from_wheelsets);
}

TrainElements::TrainElements(const VehicleModel& kind, std::size_t vehicles)
    : wheelsets_(static_cast<int>(kind.wheelsets.size())) {
  const std::vector<SeparateSystem> systems = separate_systems(kind);
  systems_ = systems.size();
  for (std::size_t v = 0; v < vehicles; ++v) {
    for (const SeparateSystem& system : systems) system_.emplace_back(kind, system);
  }
  free_.resize(system_.size());
}

std::span<ElementForces> TrainElements::of(int vehicle) {
  return std::span(system_).subspan(index(vehicle) * systems_, systems_);
}
std::span<const ElementForces> TrainElements::of(int vehicle) const {
  return std::span(system_).subspan(index(vehicle) * systems_, systems_);
}

void TrainElements::begin(int vehicle, const ElementForces::Step& step, const ElementForces::Start& start,
                          const Eigen::VectorXd& free) {
  for (std::size_t s = 0; s < systems_; ++s) {
    ElementForces& elements = of(vehicle)[s];
    elements.begin(step, start);
    elements.elongate(free, free_[index(vehicle) * systems_ + s]);
  }
}

void TrainElements::begin_rest(int vehicle, const Eigen::VectorXd& displacement, const Eigen::VectorXd& friction,
                               const Eigen::VectorXd& free) {
  for (std::size_t s = 0; s < systems_; ++s) {
    ElementForces& elements = of(vehicle)[s];
    elements.begin_rest(displacement, friction);
    elements.elongate(free, free_[index(vehicle) * systems_ + s]);
  }
}

void TrainElements::respond(const Eigen::VectorXd& force, Eigen::VectorXd& displacement) {
  for (std::size_t s = 0; s < system_.size(); ++s) {
    if (system_[s].empty()) continue;
    const ElementCompliance& response = (*compliance)[s % systems_];
    const std::vector<int>& wheelsets = system_[s].wheelsets();
    const auto first_unknown = [&](std::size_t w) {
      return wheelset_unknowns * (static_cast<int>(s / systems_) * wheelsets_ + wheelsets[w]);
    };
    wheelset_force_.resize(static_cast<Eigen::Index>(6 * wheelsets.size()));
    for (std::size_t w = 0; w < wheelsets.size(); ++w) {
      wheelset_force_.segment<6>(static_cast<Eigen::Index>(6 * w)) = force.segment<6>(first_unknown(w));
    }
    elongation_ = free_[s];
    elongation_.noalias() += response.from_wheelsets * wheelset_force_;
    if (!system_[s].solve(response, elongation_)) {
      displacement.setConstant(std::numeric_limits<double>::quiet_NaN());
      return;
    }
    if (system_[s].exert_nothing()) continue;
    wheelset_displacement_.noalias() = response.to_wheelsets * system_[s].share();
    for (std::size_t w = 0; w < wheelsets.size(); ++w) {
      displacement.segment<6>(first_unknown(w)) -= wheelset_displacement_.segment<6>(static_cast<Eigen::Index>(6 * w));
    }
  }
}

bool TrainElements::solve(int vehicle) {
  for (std::size_t s = 0; s < systems_; ++s) {
    if (!of(vehicle)[s].solve((*compliance)[s], free_[index(vehicle) * systems_ + s])) return false;
  }
  return true;
}

Eigen::MatrixXd TrainElements::stiffening(WheelsetRange range) const {
  const int vehicle = range.first / wheelsets_, first = range.first % wheelsets_, count = range.end - range.first;
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(6 * count, 6 * count);
  for (std::size_t s = 0; s < systems_; ++s) {
    const ElementForces& elements = of(vehicle)[s];
    const std::vector<int>& wheelsets = elements.wheelsets();
    if (elements.empty() || wheelsets.empty()) continue;
    if (wheelsets.front() < first || wheelsets.front() >= first + count) continue;
    const Eigen::MatrixXd part = elements.stiffening((*compliance)[s]);
    for (std::size_t i = 0; i < wheelsets.size(); ++i) {
      for (std::size_t j = 0; j < wheelsets.size(); ++j) {
        whole.block<6, 6>(6 * (wheelsets[i] - first), 6 * (wheelsets[j] - first)) =
            part.block<6, 6>(static_cast<Eigen::Index>(6 * i), static_cast<Eigen::Index>(6 * j));
      }
    }
  }
  return whole;
}

void TrainElements::add_share(int vehicle, Eigen::VectorXd& load) const {
  for (const ElementForces& elements : of(vehicle)) elements.add_share(load);
}

void TrainElements::add_end_force(int vehicle, Eigen::VectorXd& load) const {
  for (const ElementForces& elements : of(vehicle)) elements.add_end_force(load);
}

void TrainElements::store_friction(int vehicle, Eigen::VectorXd& friction) const {
  for (const ElementForces& elements : of(vehicle)) elements.store_friction(friction);
}

}  // namespace railtab
