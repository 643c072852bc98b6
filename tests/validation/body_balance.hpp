#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "railtab/runtime/vehicle/vehicle_model.hpp"

namespace railtab {

/// Forces and moments on displaced rigid bodies, each about its centre of gravity, by finite rotations in place of
/// matrices [N], [N m]. They begin with those of the bodies' inertia.
struct BodyBalance {
  std::vector<Eigen::Vector3d> position, rotation;  ///< displaced [m], [rad]
  std::vector<Eigen::Vector3d> velocity, rate;      ///< [m/s], [rad/s]
  std::vector<Eigen::Vector3d> force, moment;

  BodyBalance(const VehicleModel& vehicle, const LinearMotion& motion) {
    for (std::size_t b = 0; b < vehicle.bodies.size(); ++b) {
      Eigen::Matrix<double, 6, 1> u = Eigen::Matrix<double, 6, 1>::Zero(), v = u, inertia = u;
      for (int k = 0; k < 6; ++k) {
        const int row = vehicle.dof[b][static_cast<std::size_t>(k)];
        if (row == held) continue;
        u[k] = motion.displacement[row];
        v[k] = motion.velocity[row];
        inertia[k] = -vehicle.mass(row, row) * motion.acceleration[row];
      }
      position.emplace_back(vehicle.bodies[b].position + u.head<3>());
      rotation.emplace_back(u.tail<3>());
      velocity.emplace_back(v.head<3>());
      rate.emplace_back(v.tail<3>());
      force.emplace_back(inertia.head<3>());
      moment.emplace_back(inertia.tail<3>());
    }
  }
  static Eigen::Matrix3d turned(const Eigen::Vector3d& rotation) {
    return Eigen::AngleAxisd(rotation.norm(), rotation.norm() > 0.0 ? rotation.normalized() : Eigen::Vector3d::UnitX())
        .toRotationMatrix();
  }
  void add(std::size_t body, const Eigen::Vector3d& point, const Eigen::Vector3d& f) {
    force[body] += f;
    moment[body] += (point - position[body]).cross(f);
  }
  /// A spring-damper between the bodies `below` and `above`, which meet at `point` when at rest, along axes that turn
  /// by the mean of their rotations. It presses them apart by `load` there. The couple of its ends that have moved
  /// apart is shared by halves.
  void add_spring(std::size_t below, std::size_t above, const Eigen::Vector3d& rest_below,
                  const Eigen::Vector3d& rest_above, const Eigen::Vector3d& point, const Eigen::Vector3d& stiffness,
                  const Eigen::Vector3d& damping, double load) {
    const Eigen::Vector3d lower = position[below] + turned(rotation[below]) * (point - rest_below);
    const Eigen::Vector3d upper = position[above] + turned(rotation[above]) * (point - rest_above);
    const Eigen::Matrix3d axes = turned(0.5 * (rotation[below] + rotation[above]));
    const Eigen::Vector3d along = axes.transpose() * (upper - lower);
    const Eigen::Vector3d apart = velocity[above] + rate[above].cross(upper - position[above]) - velocity[below] -
                                  rate[below].cross(lower - position[below]);
    const Eigen::Vector3d on_below = axes * (Eigen::Vector3d(0.0, 0.0, load) + stiffness.cwiseProduct(along) +
                                             damping.cwiseProduct(axes.transpose() * apart));
    add(below, lower, on_below);
    add(above, upper, -on_below);
    const Eigen::Vector3d couple = (upper - lower).cross(on_below);
    moment[below] += 0.5 * couple;
    moment[above] += 0.5 * couple;
  }
  void add_rotational(std::size_t below, std::size_t above, const Eigen::Vector3d& stiffness) {
    const Eigen::Vector3d torque = stiffness.cwiseProduct(rotation[above] - rotation[below]);
    moment[below] += torque;
    moment[above] -= torque;
  }
};

}  // namespace railtab
