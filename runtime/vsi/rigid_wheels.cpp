#include "railtab/runtime/vsi/rigid_wheels.hpp"

#include <algorithm>

#include "railtab/runtime/base/dense_solvers.hpp"
#include "railtab/runtime/base/index.hpp"

namespace railtab {

namespace {

constexpr int heave = 2;

// The systems of a vehicle by the numbers that their dofs have in `of`, ascending; others are left out.
std::vector<SeparateSystem> numbered(const std::vector<SeparateSystem>& systems, const std::vector<int>& of) {
  std::vector<SeparateSystem> result;
  for (const SeparateSystem& system : systems) {
    result.emplace_back();
    for (const int dof : system.dofs) {
      const auto found = std::lower_bound(of.begin(), of.end(), dof);
      if (found != of.end() && *found == dof) result.back().dofs.push_back(static_cast<int>(found - of.begin()));
    }
  }
  return result;
}

}  // namespace

RigidWheelResponse::RigidWheelResponse(const VehicleModel& vehicle, const Eigen::MatrixXd& damping,
                                       const HhtScheme& scheme)
    : load_weight_(scheme.load_weight()) {
  for (int w : vehicle.wheelsets) c_.push_back(vehicle.dof[index(w)][heave]);
  for (int i = 0; i < vehicle.dofs(); ++i) {
    if (std::find(c_.begin(), c_.end(), i) == c_.end()) b_.push_back(i);
  }
  const Eigen::MatrixXd effective = effective_matrix(scheme, vehicle.mass, damping, vehicle.stiffness);
  const Eigen::MatrixXd effective_bb = effective(b_, b_);  // none where the vehicle is its wheelsets
  const std::vector<SeparateSystem> systems = separate_systems(vehicle);
  const Eigen::MatrixXd inverse_bb = b_.empty() ? effective_bb : effective_inverse(effective_bb);
  inverse_bb_ = SeparateMatrix(numbered(systems, b_), inverse_bb);
  damping_ = SeparateMatrix(systems, damping);
  stiffness_ = SeparateMatrix(systems, vehicle.stiffness);
  if (!vehicle.elements.empty()) {
    for (const SeparateSystem& system : systems) {
      elements_.emplace_back(vehicle, system, b_, inverse_bb, load_weight_);
    }
  }
  E_inverse_ = effective(c_, b_) * inverse_bb;
  K_bc_ = vehicle.stiffness(b_, c_);
  C_bc_ = damping(b_, c_);
  M_bc_ = vehicle.mass(b_, c_);
  Z_ = vehicle.stiffness(c_, c_) - E_inverse_ * K_bc_;
  W_ = damping(c_, c_) - E_inverse_ * C_bc_;
  A_ = (vehicle.mass(c_, c_) - E_inverse_ * M_bc_) / load_weight_;
}

Eigen::VectorXd RigidWheelResponse::remainder(const HhtScheme& scheme, const Eigen::VectorXd& load,
                                              const LinearMotion& motion, Prediction& p) const {
  predict(scheme, motion, p);
  for (int i : c_) {
    p.weighted_displacement[i] = -scheme.alpha * motion.displacement[i];
    p.weighted_velocity[i] = -scheme.alpha * motion.velocity[i];
  }
  Eigen::VectorXd R = load - scheme.alpha * motion.contact_load;
  damping_.add_product(-1.0, p.weighted_velocity, R);
  stiffness_.add_product(-1.0, p.weighted_displacement, R);
  return R;
}

Eigen::VectorXd RigidWheelResponse::free_force(const Eigen::VectorXd& R) const {
  return (E_inverse_ * R(b_) - R(c_)) / load_weight_;
}

Eigen::VectorXd RigidWheelResponse::increment(const Eigen::VectorXd& R, const WheelsetHeave& h) const {
  const Eigen::VectorXd load = R(b_) - M_bc_ * h.a - load_weight_ * (C_bc_ * h.v + K_bc_ * h.z);
  return inverse_bb_ * load;
}

Eigen::VectorXd RigidWheelResponse::displacement(const Prediction& p, const Eigen::VectorXd& R,
                                                 const WheelsetHeave& h) const {
  Eigen::VectorXd u = p.displacement;
  u(b_) += increment(R, h);
  u(c_) = h.z;
  return u;
}

Prediction RigidWheelResponse::prescribed(const Prediction& p, const WheelsetHeave& h) const {
  Prediction result = p;
  result.displacement(c_) = h.z;
  result.velocity(c_) = h.v;
  return result;
}

void RigidWheelResponse::update(const HhtScheme& scheme, const Prediction& p, const Eigen::VectorXd& R,
                                const WheelsetHeave& h, const Eigen::VectorXd& force, LinearMotion& motion) const {
  const Eigen::VectorXd moved = increment(R, h);
  motion.displacement(b_) = p.displacement(b_) + moved;
  motion.velocity(b_) = p.velocity(b_) + scheme.velocity_rate() * moved;
  motion.acceleration(b_) = scheme.acceleration_rate() * moved;
  motion.displacement(c_) = h.z;
  motion.velocity(c_) = h.v;
  motion.acceleration(c_) = h.a;
  motion.contact_load.setZero();
  motion.contact_load(c_) = force;
}

void set_vertical_forces(const Eigen::VectorXd& force, ContactSolution& solution) {
  solution.force.setZero();
  for (int w = 0; w < static_cast<int>(force.size()); ++w) {
    solution.force[wheelset_unknowns * w + heave] = force[w];
    for (int side = 0; side < 2; ++side) {
      solution.force[rail_unknown(2 * w + side) + 1] = -0.5 * force[w];
      solution.contact[index(2 * w + side)] = {};
    }
  }
  solution.end_force = solution.force;
}

void rest_on_rails(const ContactProblem& problem, ContactSolution& solution) {
  const int wheelsets = static_cast<int>(solution.displacement.size()) / wheelset_unknowns;
  const int per_vehicle = problem.wheelsets_per_vehicle;
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(wheelsets, wheelsets);
  Eigen::VectorXd gap(wheelsets);  // of rail below wheel, without forces
  for (int i = 0; i < wheelsets; ++i) {
    gap[i] = -problem.free[wheelset_unknowns * i + heave];
    for (int side = 0; side < 2; ++side) {
      gap[i] += 0.5 * (problem.free[rail_unknown(2 * i + side) + 1] +
                       problem.deviation[index(i)][index(side)].displacement[1]);
    }
    const int first = i - i % per_vehicle;
    for (int j = first; j < first + per_vehicle; ++j) {
      system(i, j) += problem.vehicle_compliance(6 * (i - first) + heave, 6 * (j - first) + heave);
    }
  }
  for (const RailCoupling& c : problem.rail) {
    const Vector6 moved = c.under_vertical_loads();
    system(c.i, c.j) += 0.25 * (moved[1] + moved[4]);
  }
  const Eigen::VectorXd force = dense_solution(system, gap);
  set_vertical_forces(force, solution);

  solution.displacement = problem.free;
  for (int i = 0; i < wheelsets; ++i) {
    const int first = i - i % per_vehicle;
    for (int j = first; j < first + per_vehicle; ++j) {
      solution.displacement.segment<6>(wheelset_unknowns * i) +=
          problem.vehicle_compliance.block<6, 1>(6 * (i - first), 6 * (j - first) + heave) * force[j];
    }
  }
  for (const RailCoupling& c : problem.rail) {
    solution.displacement.segment<6>(rails_unknown(c.i)) += -0.5 * force[c.j] * c.under_vertical_loads();
  }
}

}  // namespace railtab
