#include "railtab/runtime/vehicle/vehicle_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "railtab/runtime/base/dense_solvers.hpp"
#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/base/motion_names.hpp"
#include "railtab/runtime/base/parameter_range.hpp"
#include "railtab/runtime/base/spring_damper.hpp"
#include "railtab/runtime/vehicle/geometric_stiffness.hpp"
#include "railtab/runtime/vehicle/series_damper.hpp"
#include "railtab/runtime/vehicle/static_wheel_load.hpp"
#include "railtab/runtime/vehicle/vehicle_terms.hpp"

namespace railtab {
namespace {

void check_bodies(const std::string& name, const std::vector<RigidBody>& bodies) {
  for (const RigidBody& body : bodies) {
    const std::string place = name + "." + body.name;
    require_positive(place + ".mass", body.mass, "kg");
    for (int axis = 0; axis < 3; ++axis) require_positive(place + ".inertia", body.inertia[axis], "kg m²");
  }
}

void check_index(const std::string& place, int index, size_t count) {
  if (index >= 0 && static_cast<size_t>(index) < count) return;
  throw input_error(place, fmt::format("body {}", index), fmt::format("0 to {}", static_cast<long>(count) - 1));
}

void check_connections(const std::string& name, size_t bodies, const std::vector<Suspension>& suspension,
                       const std::vector<int>& wheelsets) {
  for (size_t s = 0; s < suspension.size(); ++s) {
    const std::string place = fmt::format("{}.suspension[{}]", name, s);
    check_index(place, suspension[s].body_a, bodies);
    check_index(place, suspension[s].body_b, bodies);
    if (suspension[s].body_a == suspension[s].body_b) {
      throw input_error(place, fmt::format("body {} twice", suspension[s].body_a), "two different bodies");
    }
    for (int axis = 0; axis < 3; ++axis) {
      require_not_negative(place + ".stiffness", suspension[s].stiffness[axis], "N/m");
      require_not_negative(place + ".damping", suspension[s].damping[axis], "N s/m");
      require_not_negative(place + ".rotational_stiffness", suspension[s].rotational_stiffness[axis], "N m/rad");
      require_not_negative(place + ".series_stiffness", suspension[s].series_stiffness[axis], "N/m");
    }
    const double share = suspension[s].couple_share;
    if (!(share >= 0.0 && share <= 1.0)) {
      throw input_error(place + ".couple_share", fmt::format("{}", share), "0 to 1");
    }
  }
  for (size_t w = 0; w < wheelsets.size(); ++w) {
    check_index(fmt::format("{}.wheelsets[{}]", name, w), wheelsets[w], bodies);
  }
}

/// Numbers the free dofs body by body; returns their count.
int number_dofs(VehicleModel& vehicle, const std::vector<DofIndices>& held_dofs) {
  if (!held_dofs.empty() && held_dofs.size() != vehicle.bodies.size()) {
    throw input_error(vehicle.name + ".held_dofs", fmt::format("{} bodies", held_dofs.size()),
                      fmt::format("{}", vehicle.bodies.size()));
  }
  int count = 0;
  vehicle.dof.resize(vehicle.bodies.size());
  for (size_t b = 0; b < vehicle.bodies.size(); ++b) {
    for (size_t i = 0; i < 6; ++i) {
      const bool is_held = !held_dofs.empty() && held_dofs[b][i] == held;
      vehicle.dof[b][i] = is_held ? held : count++;
    }
  }
  return count;
}

void add_inertia(VehicleModel& vehicle, const std::vector<RigidBody>& bodies) {
  for (size_t b = 0; b < bodies.size(); ++b) {
    for (int i = 0; i < 6; ++i) {
      const int row = vehicle.dof[b][i];
      if (row != held) vehicle.mass(row, row) = i < 3 ? bodies[b].mass : bodies[b].inertia[i - 3];
    }
    const int x = vehicle.dof[b][x_dof];
    if (x != held) vehicle.acceleration_load[x] -= bodies[b].mass;
  }
}

Eigen::VectorXd weight_of(const VehicleModel& vehicle, const std::vector<RigidBody>& bodies, double gravity) {
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(vehicle.dofs());
  for (size_t b = 0; b < bodies.size(); ++b) {
    const int z = vehicle.dof[b][z_dof];
    if (z != held) weight[z] = bodies[b].mass * gravity;
  }
  return weight;
}

void add_suspension(VehicleModel& vehicle, const VehicleDescription& parts) {
  for (const Suspension& unit : parts.suspension) {
    const Eigen::Vector3d arm_a = unit.point - vehicle.bodies[unit.body_a].position;
    const Eigen::Vector3d arm_b = unit.point - vehicle.bodies[unit.body_b].position;
    const DofIndices& a = vehicle.dof[unit.body_a];
    const DofIndices& b = vehicle.dof[unit.body_b];
    add_pair_matrix(vehicle.stiffness, a, b, spring_matrix(arm_a, arm_b, unit.stiffness, unit.rotational_stiffness));
    add_pair_matrix(vehicle.damping, a, b,
                    spring_matrix(arm_a, arm_b, parallel_damping(unit, parts.force_elements), Eigen::Vector3d::Zero()));
  }
}

}  // namespace

void add_pair_matrix(Eigen::MatrixXd& matrix, const DofIndices& a, const DofIndices& b, const PairMatrix& pair) {
  for (int i = 0; i < 12; ++i) {
    const int row = i < 6 ? a[i] : b[i - 6];
    if (row == held) continue;
    for (int j = 0; j < 12; ++j) {
      const int column = j < 6 ? a[j] : b[j - 6];
      if (column != held) matrix(row, column) += pair(i, j);
    }
  }
}

/// Forward rolling at Ω > 0 turns a wheelset by ω_y = -Ω: with z down, the bottom at r = (0, 0, R) then moves by
/// ω × r = (-ΩR, 0, 0) against the vehicle. The axle direction is e_y + θ × e_y = (-yaw, 1, roll), hence the angular
/// momentum -J_y·Ω·(-yaw, 1, roll), and its rate enters the left-hand side of the moment balance:
/// about x: +J_y·Ω·d(yaw)/dt, about z: -J_y·Ω·d(roll)/dt.
void add_rolling(VehicleModel& vehicle, std::size_t wheelset, double Jy) {
  const DofIndices& dof = vehicle.dof[vehicle.wheelsets[wheelset]];
  const double per_speed = Jy / vehicle.wheel_radius[wheelset];
  if (dof[pitch_dof] != held) vehicle.acceleration_load[dof[pitch_dof]] += per_speed;
  const int roll = dof[roll_dof], yaw = dof[yaw_dof];
  if (roll == held || yaw == held) return;
  vehicle.gyroscopic(roll, yaw) += per_speed;
  vehicle.gyroscopic(yaw, roll) -= per_speed;
}

bool is_wheelset(const VehicleModel& vehicle, int body) noexcept {
  return std::find(vehicle.wheelsets.begin(), vehicle.wheelsets.end(), body) != vehicle.wheelsets.end();
}

std::string body_text(const VehicleModel& vehicle, int body) {
  const VehicleBody& named = vehicle.bodies[static_cast<std::size_t>(body)];
  return vehicle.coaches > 1 ? fmt::format("{} of vehicle {}", named.name, named.coach + 1) : named.name;
}

std::string body_of(const VehicleModel& vehicle, int row) {
  for (std::size_t b = 0; b < vehicle.bodies.size(); ++b) {
    const DofIndices& dof = vehicle.dof[b];
    if (std::find(dof.begin(), dof.end(), row) != dof.end()) return body_text(vehicle, static_cast<int>(b));
  }
  return "an inner degree of freedom";
}

namespace {

// The body whose vertical balance fails by most, by its own weight. Moments of other rows have another unit.
InputError uncarried_weight(const VehicleModel& vehicle, const Eigen::VectorXd& weight,
                            const Eigen::VectorXd& residual) {
  int worst = -1;
  double largest = 1e-9 * weight.norm();  // less is rounding
  for (std::size_t b = 0; b < vehicle.bodies.size(); ++b) {
    const int z = vehicle.dof[b][z_dof];
    if (z == held || std::abs(residual[z]) <= largest) continue;
    largest = std::abs(residual[z]);
    worst = static_cast<int>(b);
  }
  const std::string expected = "every body carried by the wheelsets through springs";
  if (worst < 0)
    return input_error(vehicle.name, "weight of inner degrees of freedom that no spring carries", expected);
  const int z = vehicle.dof[static_cast<std::size_t>(worst)][z_dof];
  const bool hangs_on_nothing = vehicle.stiffness(z, z) == 0.0;
  return input_error(vehicle.name,
                     fmt::format("a weight of {:.3g} N of {} that {}", weight[z], body_text(vehicle, worst),
                                 hangs_on_nothing ? "no spring carries" : "its springs do not hold in balance"),
                     expected);
}

}  // namespace

/// The motions that stay free of stiffness (lateral, yaw, wheel rotation) carry no weight, so the minimum-norm solution
/// of the singular system is an equilibrium; a residual means that something is not carried.
StandingVehicle standing(const VehicleModel& vehicle, const Eigen::MatrixXd& weight) {
  const int n = vehicle.dofs();
  std::vector<bool> is_supported(n, false);
  for (const int w : vehicle.wheelsets) {
    for (const int i : {z_dof, roll_dof}) {
      if (vehicle.dof[w][i] != held) is_supported[vehicle.dof[w][i]] = true;
    }
  }
  std::vector<int> supported, carried;
  for (int i = 0; i < n; ++i) (is_supported[i] ? supported : carried).push_back(i);
  StandingVehicle rest{weight, Eigen::MatrixXd::Zero(n, weight.cols())};
  if (carried.empty()) return rest;  // wheelsets alone

  const Eigen::MatrixXd K = vehicle.stiffness(carried, carried);
  const Eigen::MatrixXd load = weight(carried, Eigen::all);
  const Eigen::MatrixXd sag = least_squares_solution(K, load);
  const Eigen::MatrixXd residual = K * sag - load;
  for (Eigen::Index k = 0; k < weight.cols(); ++k) {
    if (residual.col(k).norm() <= 1e-6 * weight.col(k).norm()) continue;
    Eigen::VectorXd of_rows = Eigen::VectorXd::Zero(n);
    of_rows(carried) = residual.col(k);
    throw uncarried_weight(vehicle, weight.col(k), of_rows);
  }
  rest.reaction.setZero();
  rest.reaction(supported, Eigen::all) = weight(supported, Eigen::all) - vehicle.stiffness(supported, carried) * sag;
  rest.displacement(carried, Eigen::all) = sag;
  return rest;
}

void check_wheel_loads(const VehicleModel& vehicle, const std::function<std::string(std::size_t)>& place) {
  if (vehicle.gravity == 0.0) return;
  for (std::size_t w = 0; w < vehicle.wheelsets.size(); ++w) {
    const int body = vehicle.wheelsets[w];
    const int vertical = vehicle.dof[static_cast<std::size_t>(body)][z_dof];
    if (vertical == held) continue;
    if (!(vehicle.static_load[vertical] > 0.0)) {
      throw input_error(
          place(w), fmt::format("{} that carries {:.6g} N", body_text(vehicle, body), vehicle.static_load[vertical]),
          "a vehicle that stands on all its wheelsets");
    }
    const WheelLoads wheel = static_wheel_loads(vehicle, static_cast<int>(w), half_contact_distance);
    if (wheel.left >= 0.0 && wheel.right >= 0.0) continue;
    const bool left = wheel.left < wheel.right;
    throw input_error(place(w),
                      fmt::format("{} whose {} wheel carries {:.6g} N", body_text(vehicle, body),
                                  left ? "left" : "right", left ? wheel.left : wheel.right),
                      "a vehicle that stands on all its wheels: weights nearer to the track's centre");
  }
}

VehicleModel assemble_vehicle(const VehicleDescription& parts) {
  const std::string& name = parts.name;
  check_bodies(name, parts.bodies);
  check_connections(name, parts.bodies.size(), parts.suspension, parts.wheelsets);
  require_positive(name + ".nominal_radius", parts.nominal_radius, "m");
  for (const double radius : parts.wheel_radius) require_positive(name + ".wheel_radius", radius, "m");
  require_positive(name + ".length", parts.length, "m");
  require_not_negative(name + ".gravity", parts.weight.gravity, "m/s²");

  VehicleModel vehicle;
  vehicle.name = name;
  for (const RigidBody& body : parts.bodies) vehicle.bodies.push_back({body.name, body.position, body.coach});
  vehicle.wheelsets = parts.wheelsets;
  vehicle.wheel_radius = parts.wheel_radius;
  if (vehicle.wheel_radius.empty()) vehicle.wheel_radius.assign(parts.wheelsets.size(), parts.nominal_radius);
  vehicle.length = parts.length;
  vehicle.coaches = parts.coaches;
  const int of_bodies = number_dofs(vehicle, parts.held_dofs);
  const int n = of_bodies + count_series_dampers(parts.suspension);
  for (Eigen::MatrixXd* matrix : {&vehicle.mass, &vehicle.damping, &vehicle.stiffness, &vehicle.gyroscopic}) {
    matrix->setZero(n, n);
  }
  vehicle.acceleration_load.setZero(n);
  vehicle.lateral_shift.setZero(n);
  for (const DofIndices& dof : vehicle.dof) {
    if (dof[y_dof] != held) vehicle.lateral_shift[dof[y_dof]] = 1.0;
  }
  add_inertia(vehicle, parts.bodies);
  add_suspension(vehicle, parts);
  add_series_dampers(vehicle, parts.suspension, of_bodies, parts.force_elements);
  for (std::size_t w = 0; w < vehicle.wheelsets.size(); ++w) {
    add_rolling(vehicle, w, parts.bodies[vehicle.wheelsets[w]].inertia.y());
  }
  vehicle.lateral_load = vehicle.mass * vehicle.lateral_shift;
  const StandingVehicle rest = standing(vehicle, weight_of(vehicle, parts.bodies, parts.weight.gravity));
  vehicle.gravity = parts.weight.gravity;
  vehicle.static_load = rest.reaction;
  check_wheel_loads(vehicle, [&](std::size_t) { return name; });
  if (parts.weight.geometric_stiffness == GeometricStiffness::included) {
    add_geometric_stiffness(vehicle, parts.suspension, rest.displacement);
  }
  if (parts.force_elements == ForceElementChoice::nonlinear) {
    add_force_elements(vehicle, parts.suspension, rest.displacement, of_bodies);
  }
  return vehicle;
}

}  // namespace railtab
