#include "railtab/runtime/contact/mean_force.hpp"

#include <algorithm>
#include <cmath>

namespace railtab {

PenetrationGradient::PenetrationGradient(const WheelRailPair& pair, const ContactPatch& patch,
                                         const WheelsetPose& pose) noexcept
    : angle(patch.angle),
      x(patch.x),
      arm_y(patch.y_rail - (pose.y - pair.rail_offset())),
      arm_z(patch.z_rail - (pose.z - pair.nominal_radius())) {}

double PenetrationGradient::change(const WheelsetPose& from, const WheelsetPose& to) const noexcept {
  const double roll = to.roll - from.roll;
  const double yaw = to.yaw - from.yaw;
  return -std::sin(angle) * (to.y - from.y - roll * arm_z + yaw * x) + std::cos(angle) * (to.z - from.z + roll * arm_y);
}

Vector9 ContactMemory::force() const noexcept {
  Vector9 sum = loaded.total;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) sum += patch[i].force;
  return sum;
}

ContactMemory remembered(const WheelRailPair& pair, const WheelsetPose& pose, const ContactPatches& patches,
                         const WheelForce& force) noexcept {
  ContactMemory memory;
  memory.pose = pose;
  memory.count = patches.count;
  for (std::size_t i = 0; i < static_cast<std::size_t>(patches.count); ++i) {
    const ContactPatch& patch = patches.patch[i];
    memory.patch[i] = {PenetrationGradient(pair, patch, pose), patch.penetration, force.patch[i]};
  }
  return memory;
}

double equivalent_descent(const ContactMemory& contact, std::span<const double> normal, const WheelsetPose& from,
                          const WheelsetPose& to) noexcept {
  constexpr int z = 1;
  const Eigen::Vector4d change(to.y - from.y, to.z - from.z, to.roll - from.roll, to.yaw - from.yaw);
  double work = 0.0, of_descent = 0.0;  // into the elastic energy; per metre
  for (std::size_t i = 0; i < static_cast<std::size_t>(contact.count); ++i) {
    const PenetrationGradient& gradient = contact.patch[i].gradient;
    const double share = (1.0 - contact.loaded.weight) * normal[i];
    work += share * gradient.change(from, to);
    of_descent += share * std::cos(gradient.angle);
  }
  if (contact.loaded.weight > 0.0) {
    work += contact.loaded.weight * contact.loaded.force.dot(change);
    of_descent += contact.loaded.weight * contact.loaded.force[z];
  }
  return of_descent > 0.0 ? work / of_descent : 0.0;
}

double hertz_mean_factor(double d0, double d1) noexcept {
  const double u = std::sqrt(std::max(d0, 0.0));
  const double w = std::sqrt(std::max(d1, 0.0));
  const double ends = 0.5 * (u * u * u + w * w * w);
  if (!(ends > 0.0)) return 1.0;
  if (d0 > 0.0 && d1 > 0.0) {  // the quotient of differences with its zero divided out
    return 0.4 * (w * w * w * w + w * w * w * u + w * w * u * u + w * u * u * u + u * u * u * u) / ((w + u) * ends);
  }
  const double w5 = w * w * w * w * w;
  const double u5 = u * u * u * u * u;
  return 0.4 * (w5 - u5) / ((d1 - d0) * ends);
}

Vector9 mean_force(const WheelRailPair& pair, const ContactMemory& start, const WheelsetPose& pose,
                   const ContactPatches& patches, const WheelForce& end) noexcept {
  Vector9 mean = Vector9::Zero();
  for (std::size_t i = 0; i < static_cast<std::size_t>(patches.count); ++i) {
    const ContactPatch& patch = patches.patch[i];
    const double before = patch.penetration + PenetrationGradient(pair, patch, pose).change(pose, start.pose);
    mean += 0.5 * hertz_mean_factor(before, patch.penetration) * end.patch[i];
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(start.count); ++i) {
    const ContactMemory::Patch& patch = start.patch[i];
    const double after = patch.penetration + patch.gradient.change(start.pose, pose);
    mean += 0.5 * hertz_mean_factor(patch.penetration, after) * patch.force;
  }
  return mean;
}

}  // namespace railtab
