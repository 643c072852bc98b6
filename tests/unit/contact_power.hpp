#pragma once

#include "railtab/runtime/contact/wheel_contact.hpp"

namespace railtab::testing {

/// Power of all contact forces on wheelset and rail, which the wheelset passes along the rail's tangent; the rail's
/// material rests along x [W].
inline double power(const WheelContactModel& model, const WheelForce& f, const WheelsetMotion& w,
                    const RailHeadMotion& r) {
  const double V = model.speed;
  Vector6 velocity = w.velocity;
  velocity[0] += V;
  velocity[1] -= r.velocity[0] + V * r.yaw;
  velocity[2] -= r.velocity[1] + V * r.slope;
  velocity[4] -= V / model.geometry->pair().nominal_radius();
  return f.wheelset.dot(velocity) + f.rail[2] * r.velocity[2];
}

}  // namespace railtab::testing
