#include "railtab/runtime/contact/creepage.hpp"

#include <Eigen/Geometry>
#include <cassert>
#include <cmath>

namespace railtab {

PatchCreepage patch_creepage(const RelativeMotion& motion, const Eigen::Vector3d& arm, const ContactAxes& axes,
                             double speed) noexcept {
  assert(speed > 0.0);
  const Eigen::Vector3d slip = motion.velocity + motion.angular_velocity.cross(arm);
  return {slip.x() / speed, slip.dot(axes.tangent) / speed, motion.angular_velocity.dot(axes.normal) / speed};
}

Creepage normalised_creepage(const PatchCreepage& creepage, double a, double b, double G, double mu_Fn) noexcept {
  assert(a > 0.0 && b > 0.0 && mu_Fn > 0.0);
  const double ab = a * b;
  const double scale = G * ab / mu_Fn;
  return {creepage.x * scale, creepage.y * scale, creepage.spin * scale * std::sqrt(ab)};
}

PatchCreepForce dimensional_creep_force(const CreepForce& force, double a, double b, double mu_Fn) noexcept {
  return {force.x * mu_Fn, force.y * mu_Fn, force.moment * mu_Fn * std::sqrt(a * b)};
}

}  // namespace railtab
