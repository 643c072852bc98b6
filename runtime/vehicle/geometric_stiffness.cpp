#include "railtab/runtime/vehicle/geometric_stiffness.hpp"

#include <fmt/format.h>

#include "railtab/runtime/base/dense_solvers.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/motion_names.hpp"
#include "railtab/runtime/base/spring_damper.hpp"
#include "railtab/runtime/vehicle/vehicle_terms.hpp"

namespace railtab {

namespace {

// A unit between two bodies that carries `force` at rest, that on body a.
struct PreloadedUnit {
  int body_a, body_b;
  Eigen::Vector3d point, force;
  double couple_share;
};

void add_preload(VehicleModel& vehicle, const PreloadedUnit& unit) {
  Eigen::Vector3d share = Eigen::Vector3d::Constant(unit.couple_share);
  DofIndices a = vehicle.dof[unit.body_a], b = vehicle.dof[unit.body_b];
  if (is_wheelset(vehicle, unit.body_a)) {
    share[1] = 1.0;
    a[pitch_dof] = held;
  } else if (is_wheelset(vehicle, unit.body_b)) {
    share[1] = 0.0;
    b[pitch_dof] = held;
  }
  const Eigen::Vector3d arm_a = unit.point - vehicle.bodies[unit.body_a].position;
  const Eigen::Vector3d arm_b = unit.point - vehicle.bodies[unit.body_b].position;
  add_pair_matrix(vehicle.stiffness, a, b, preload_matrix(arm_a, arm_b, unit.force, share));
}

Eigen::Matrix<double, 12, 1> pair_motion(const VehicleModel& vehicle, const Suspension& unit,
                                         const Eigen::VectorXd& displacement) {
  Eigen::Matrix<double, 12, 1> motion = Eigen::Matrix<double, 12, 1>::Zero();
  for (int k = 0; k < 12; ++k) {
    const int row = k < 6 ? vehicle.dof[unit.body_a][k] : vehicle.dof[unit.body_b][k - 6];
    if (row != held) motion[k] = displacement[row];
  }
  return motion;
}

// The row that moves most in the softest motion, by its energy.
Eigen::Index softest_row(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M) {
  const CholeskyFactor mass(M);
  const Eigen::MatrixXd half = mass.solve_L(K);
  const Eigen::VectorXd motion = mass.solve_LT(symmetric_spectrum(mass.solve_L(half.transpose())).vectors.col(0));
  Eigen::Index row = 0;
  M.diagonal().cwiseSqrt().cwiseProduct(motion).cwiseAbs().maxCoeff(&row);
  return row;
}

// The bodies on standing wheelsets must not fall over.
void check_standing(const VehicleModel& vehicle) {
  constexpr double softest_omega2 = -0.004;  // rad²/s²: 0.01 Hz
  std::vector<int> moving;
  for (std::size_t b = 0; b < vehicle.bodies.size(); ++b) {
    if (is_wheelset(vehicle, static_cast<int>(b))) continue;
    for (const int row : vehicle.dof[b]) {
      if (row != held) moving.push_back(row);
    }
  }
  if (moving.empty()) return;
  const Eigen::MatrixXd K = vehicle.stiffness(moving, moving), M = vehicle.mass(moving, moving);
  const double lowest = generalised_eigenvalues(K, M)[0];
  if (lowest >= softest_omega2) return;
  throw input_error(
      vehicle.name,
      fmt::format("a vehicle that falls over under its weight, {} first, ω² = {:.3g} rad²/s²",
                  body_of(vehicle, moving[static_cast<std::size_t>(softest_row(K, M))]), lowest),
      "springs that resist sideways motion, and roll and pitch by more than weights times their heights above "
      "them");
}

}  // namespace

Eigen::Vector3d elongation(const VehicleModel& vehicle, const Suspension& unit, const Eigen::VectorXd& displacement) {
  const SpringKinematics kinematics = spring_kinematics(unit.point - vehicle.bodies[unit.body_a].position,
                                                        unit.point - vehicle.bodies[unit.body_b].position);
  return (kinematics * pair_motion(vehicle, unit, displacement)).head<3>();
}

void add_geometric_stiffness(VehicleModel& vehicle, const std::vector<Suspension>& suspension,
                             const Eigen::VectorXd& rest) {
  for (const Suspension& unit : suspension) {
    const Eigen::Vector3d force = unit.stiffness.cwiseProduct(elongation(vehicle, unit, rest));
    add_preload(vehicle, {unit.body_a, unit.body_b, unit.point, force, unit.couple_share});
  }
  check_standing(vehicle);
}

void add_geometric_stiffness(VehicleModel& vehicle, const std::vector<CarriedWeight>& weights) {
  if (weights.empty()) return;
  const auto cases = static_cast<Eigen::Index>(weights.size());
  Eigen::MatrixXd unit_loads = Eigen::MatrixXd::Zero(vehicle.dofs(), cases);
  for (Eigen::Index k = 0; k < cases; ++k) unit_loads(vehicle.dof[weights[k].body][z_dof], k) = 1.0;
  const Eigen::MatrixXd reaction = standing(vehicle, unit_loads).reaction;  // by the springs alone
  for (Eigen::Index k = 0; k < cases; ++k) {
    for (const int wheelset : vehicle.wheelsets) {
      const double force = weights[k].weight * reaction(vehicle.dof[wheelset][z_dof], k);
      const Eigen::Vector3d point{vehicle.bodies[wheelset].position.x(), 0.0, weights[k].height};
      add_preload(vehicle, {wheelset, weights[k].body, point, {0.0, 0.0, force}, 0.5});
    }
  }
  check_standing(vehicle);
}

}  // namespace railtab
