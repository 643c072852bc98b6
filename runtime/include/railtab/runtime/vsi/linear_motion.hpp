#pragma once

#include <Eigen/Core>

#include "railtab/runtime/vsi/hht.hpp"

namespace railtab {

/// State of a linear subsystem (one vehicle, or the structure) at the end of a step.
struct LinearMotion {
  Eigen::VectorXd displacement, velocity, acceleration;
  Eigen::VectorXd contact_load;  ///< what the contacts applied at the end of the step

  explicit LinearMotion(Eigen::Index dofs = 0)
      : displacement(Eigen::VectorXd::Zero(dofs)),
        velocity(Eigen::VectorXd::Zero(dofs)),
        acceleration(Eigen::VectorXd::Zero(dofs)),
        contact_load(Eigen::VectorXd::Zero(dofs)) {}
};

/// Predictors of one HHT step, caller-owned so that a step allocates nothing.
struct Prediction {
  Eigen::VectorXd displacement, velocity;                    ///< ã, ṽ
  Eigen::VectorXd weighted_displacement, weighted_velocity;  ///< (1+α)ã − αa(t), (1+α)ṽ − αv(t)
};

inline void predict(const HhtScheme& scheme, const LinearMotion& motion, Prediction& p) {
  const double dt = scheme.time_step;
  p.displacement = motion.displacement + dt * motion.velocity + dt * dt * (0.5 - scheme.beta()) * motion.acceleration;
  p.velocity = motion.velocity + dt * (1.0 - scheme.gamma()) * motion.acceleration;
  p.weighted_displacement = scheme.load_weight() * p.displacement - scheme.alpha * motion.displacement;
  p.weighted_velocity = scheme.load_weight() * p.velocity - scheme.alpha * motion.velocity;
}

/// Close the step with the increment Δ over the predictor.
inline void update(const HhtScheme& scheme, const Prediction& p, const Eigen::VectorXd& increment,
                   LinearMotion& motion) {
  motion.displacement = p.displacement + increment;
  motion.velocity = p.velocity + scheme.velocity_rate() * increment;
  motion.acceleration = scheme.acceleration_rate() * increment;
}

}  // namespace railtab
