#include "railtab/runtime/stability/contact_slopes.hpp"

#include <algorithm>

#include "railtab/runtime/base/index.hpp"
#include "railtab/runtime/contact/contact_response.hpp"

namespace railtab {

namespace {

// Well below penetration and creepage of sliding, well above the rounding of the contact search.
constexpr double move = 1e-6;  // m, rad
// Half of the least lateral way where a loaded table answers: the lateral force of the half-space solutions, whose
// nodes may lie a few micrometres apart, is known to some 1e-4 of the load, and by less way its slope is that error.
constexpr double loaded_move = 5e-5;  // m
constexpr double creepage_step = 1e-6;
constexpr Eigen::Index lateral_dof = 1;

// Forces of both wheels on a wheelset.
Vector6 wheelset_force(const WheelContactModel& model, const WheelsetMotion& motion) {
  Vector6 sum = Vector6::Zero();
  const RailHeadMotion rail;
  for (const WheelSide side : {WheelSide::left, WheelSide::right}) {
    const WheelsetPose pose = relative_pose(model.geometry->pair(), side, motion, rail);
    sum += wheel_force(model, side, motion, rail, wheel_contact(*model.geometry, pose)).wheelset;
  }
  return sum;
}

}  // namespace

ContactSlopes contact_slopes(const WheelContactModel& model, const WheelsetMotion& at, double travel) {
  ContactSlopes slopes;
  const auto difference = [&](Vector6 WheelsetMotion::*member, Eigen::Index dof, double step) {
    WheelsetMotion ahead = at, behind = at;
    (ahead.*member)[dof] += step;
    (behind.*member)[dof] -= step;
    return Vector6((wheelset_force(model, ahead) - wheelset_force(model, behind)) / (2.0 * step));
  };
  const double radius = model.geometry->pair().nominal_radius();
  const double least = model.geometry->loaded() ? loaded_move : move;
  for (Eigen::Index dof = 0; dof < 6; ++dof) {
    slopes.by_displacement.col(dof) =
        difference(&WheelsetMotion::displacement, dof, dof == lateral_dof ? std::max(least, 0.5 * travel) : move);
    const double arm = dof < 3 ? 1.0 : radius;
    slopes.by_velocity.col(dof) = difference(&WheelsetMotion::velocity, dof, creepage_step * model.speed / arm);
  }
  return slopes;
}

std::vector<WheelsetMotion> wheelset_motions(const VsiModel& model, const LinearMotion& motion) {
  Eigen::VectorXd displacement = Eigen::VectorXd::Zero(wheelset_unknowns * model.wheelsets()), velocity = displacement;
  gather_wheelsets(model, 0, motion.displacement, displacement);
  gather_wheelsets(model, 0, motion.velocity, velocity);
  std::vector<WheelsetMotion> motions;
  for (int w = 0; w < model.wheelsets(); ++w) {
    const int first = wheelset_unknowns * w;
    motions.push_back({displacement.segment<6>(first), velocity.segment<6>(first)});
  }
  return motions;
}

void subtract_contact_slopes(const VehicleModel& vehicle, int wheelset, const ContactSlopes& slopes,
                             Eigen::MatrixXd& stiffness, Eigen::MatrixXd& damping) {
  const DofIndices& dof = vehicle.dof[index(vehicle.wheelsets[index(wheelset)])];
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      if (dof[index(i)] == held || dof[index(j)] == held) continue;
      stiffness(dof[index(i)], dof[index(j)]) -= slopes.by_displacement(i, j);
      damping(dof[index(i)], dof[index(j)]) -= slopes.by_velocity(i, j);
    }
  }
}

}  // namespace railtab
