#include "railtab/runtime/stability/linearised_steps.hpp"

#include <cmath>

#include "railtab/runtime/base/dense_solvers.hpp"
#include "railtab/runtime/base/index.hpp"
#include "railtab/runtime/stability/contact_slopes.hpp"

namespace railtab {

namespace {

// Rows without mass have no acceleration of their own.
Eigen::MatrixXd first_acceleration(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& force) {
  std::vector<int> massive;
  for (int row = 0; row < mass.rows(); ++row) {
    if (mass(row, row) > 0.0) massive.push_back(row);
  }
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(force.rows(), force.cols());
  result(massive, Eigen::all) = symmetric_solution(mass(massive, massive), force(massive, Eigen::all));
  return result;
}

// Adds the slopes of stops and dampers.
void add_element_slopes(const ForceElements& elements, const LinearMotion& at, Eigen::MatrixXd& stiffness,
                        Eigen::MatrixXd& damping) {
  if (elements.empty()) return;
  const Eigen::VectorXd x = elements.rows * at.displacement, v = elements.rows * at.velocity;
  for (const ForceElement& element : elements.element) {
    const auto row = elements.rows.row(element.row);
    if (element.kind == ForceElementKind::stop) {
      stiffness += row.transpose() * (element.curve.at(x[element.row]).slope * row);
    } else if (element.kind == ForceElementKind::damper) {
      damping += row.transpose() * (element.curve.at(v[element.row]).slope * row);
    }
  }
}

}  // namespace

LinearisedSteps::LinearisedSteps(const VsiModel& model, const HhtScheme& hht, const std::vector<int>& displacements,
                                 const LinearMotion& start)
    : model_(model),
      contact_(model.train_contact()),
      hht_(hht),
      linear_damping_(model.vehicle_damping(model.contact.speed)) {
  const int dofs = model.vehicle.dofs();
  const auto tied = static_cast<Eigen::Index>(displacements.size());
  displacement_.setZero(dofs, tied + dofs);
  velocity_.setZero(dofs, tied + dofs);
  for (Eigen::Index k = 0; k < tied; ++k) displacement_(displacements[static_cast<std::size_t>(k)], k) = 1.0;
  velocity_.rightCols(dofs).setIdentity();
  take_slopes(start);
  acceleration_ = first_acceleration(model.vehicle.mass, -damping_ * velocity_ - stiffness_ * displacement_);
}

void LinearisedSteps::take_slopes(const LinearMotion& at) {
  stiffness_ = model_.vehicle.stiffness;
  damping_ = linear_damping_;
  const std::vector<WheelsetMotion> motions = wheelset_motions(model_, at);
  for (int w = 0; w < model_.wheelsets(); ++w) {
    // Where contact points jump within a step, the mean over its way has the jump's share in the motion.
    const WheelsetMotion& motion = motions[index(w)];
    const double travel = std::abs(motion.velocity[1]) * hht_.time_step;
    subtract_contact_slopes(model_.vehicle, w, contact_slopes(contact_[w], motion, travel), stiffness_, damping_);
  }
  add_element_slopes(model_.vehicle.elements, at, stiffness_, damping_);
}

void LinearisedSteps::advance(const LinearMotion& end) {
  const double dt = hht_.time_step;
  Eigen::MatrixXd load = Eigen::MatrixXd::Zero(displacement_.rows(), displacement_.cols());
  if (hht_.alpha != 0.0) load = hht_.alpha * (damping_ * velocity_ + stiffness_ * displacement_);
  const Eigen::MatrixXd predicted = displacement_ + dt * velocity_ + dt * dt * (0.5 - hht_.beta()) * acceleration_;
  const Eigen::MatrixXd predicted_velocity = velocity_ + dt * (1.0 - hht_.gamma()) * acceleration_;
  take_slopes(end);
  load -= hht_.load_weight() * (damping_ * predicted_velocity + stiffness_ * predicted);
  const Eigen::MatrixXd increment =
      dense_solution(effective_matrix(hht_, model_.vehicle.mass, damping_, stiffness_), load);
  displacement_ = predicted + increment;
  velocity_ = predicted_velocity + hht_.velocity_rate() * increment;
  acceleration_ = hht_.acceleration_rate() * increment;
}

Eigen::MatrixXd LinearisedSteps::by_start(const std::vector<int>& displacements) const {
  Eigen::MatrixXd result(static_cast<Eigen::Index>(displacements.size()) + velocity_.rows(), velocity_.cols());
  result << displacement_(displacements, Eigen::all), velocity_;
  return result;
}

}  // namespace railtab
