// A wheel of the Manchester benchmark that rolls with friction, cases A2.1 and A2.2: creepages and creep force of its
// largest patch at a pose and rotation, as its test and its figure need them.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "manchester_wheelset.hpp"
#include "railtab/runtime/contact/creepage.hpp"
#include "railtab/runtime/contact/wheel_contact.hpp"

namespace railtab {

inline constexpr double manchester_speed = 2.0;     // m/s
inline constexpr double manchester_friction = 0.3;  // [-]

struct RollingWheel {
  PatchCreepage creepage;              ///< of a right wheel, wheel against rail, by (V + |Ω| r)/2 as in CONTACT
  double fx = 0, fy = 0;               ///< on the wheel, of friction times the normal force [-]
  double normal_force = 0, angle = 0;  ///< [N], [rad]
};

/// @param pose of the right wheel @param pitch_rate rotation about the axle, negative forward [rad/s]
/// @param axle_yaw of the axle's direction in the creepage; pose.yaw, or 0 where yaw is to be left out of it [rad]
inline RollingWheel rolling_wheel(const ContactGeometry& geometry, const NormalContactModel& model, const CreepLaw& law,
                                  const WheelsetPose& pose, double pitch_rate, double axle_yaw) {
  using Eigen::Vector3d;
  const WheelRailPair& pair = geometry.pair();
  const ContactPatches patches = geometry.patches(pose);
  const PatchLoads loads = patch_loads(model, geometry, pose, patches);
  const PatchLoad& load =
      *std::max_element(loads.begin(), loads.begin() + patches.count,
                        [](const PatchLoad& a, const PatchLoad& b) { return a.elastic_force < b.elastic_force; });
  const ContactPatch& p = load.contact;
  const Vector3d normal(0.0, -std::sin(p.angle), std::cos(p.angle));
  const Vector3d arm =
      Vector3d(p.x, p.y_rail - (pose.y - pair.rail_offset()), p.z_rail - (pose.z - pair.nominal_radius())) +
      p.penetration * normal;
  const Vector3d axle(-std::sin(axle_yaw), std::cos(axle_yaw) * std::cos(pose.roll),
                      std::cos(axle_yaw) * std::sin(pose.roll));
  const RelativeMotion motion{Vector3d(manchester_speed, 0.0, 0.0), pitch_rate * axle};
  RollingWheel result;
  result.creepage = patch_creepage(motion, arm, ContactAxes(p.angle),
                                   0.5 * (manchester_speed + std::abs(pitch_rate) * p.rolling_radius));
  const double bound = manchester_friction * load.elastic_force;
  const double a = load.hertz.a1 * std::cbrt(load.elastic_force);
  const double b = load.hertz.b1 * std::cbrt(load.elastic_force);
  const CreepForce force = creep_force(
      law, load.hertz.ratio, normalised_creepage(result.creepage, a, b, model.material.shear_modulus(), bound));
  result.fx = force.x;
  result.fy = force.y;
  result.normal_force = load.elastic_force;
  result.angle = p.angle;
  return result;
}

}  // namespace railtab
