#pragma once

#include <Eigen/Core>

#include "railtab/runtime/base/dof_range.hpp"
#include "railtab/runtime/vsi/hht.hpp"

namespace railtab {

/// State of a linear subsystem (one vehicle, or the structure) at the end of a step.
struct LinearMotion {
  Eigen::VectorXd displacement, velocity, acceleration;
  Eigen::VectorXd contact_load;  ///< contact forces at the end of the step
  Eigen::VectorXd step_load;     ///< the contacts' part of Eq. 12 in the step; for ContactForceRule::energy

  explicit LinearMotion(Eigen::Index dofs = 0)
      : displacement(Eigen::VectorXd::Zero(dofs)),
        velocity(Eigen::VectorXd::Zero(dofs)),
        acceleration(Eigen::VectorXd::Zero(dofs)),
        contact_load(Eigen::VectorXd::Zero(dofs)),
        step_load(Eigen::VectorXd::Zero(dofs)) {}
};

/// Predictors of one HHT step, caller-owned so that a step allocates nothing.
struct Prediction {
  Eigen::VectorXd displacement, velocity;                    ///< ã, ṽ
  Eigen::VectorXd weighted_displacement, weighted_velocity;  ///< (1+α)ã − αa(t), (1+α)ṽ − αv(t)
};

/// Predictors of the unknowns in `range`; those of others keep what they had.
inline void predict(const HhtScheme& scheme, const LinearMotion& motion, const DofRange& range, Prediction& p) {
  const double dt = scheme.time_step;
  const auto a = range.of(motion.displacement);
  const auto v = range.of(motion.velocity);
  const auto acceleration = range.of(motion.acceleration);
  for (Eigen::VectorXd* vector : {&p.displacement, &p.velocity, &p.weighted_displacement, &p.weighted_velocity})
    vector->resize(motion.displacement.size());
  range.of(p.displacement) = a + dt * v + dt * dt * (0.5 - scheme.beta()) * acceleration;
  range.of(p.velocity) = v + dt * (1.0 - scheme.gamma()) * acceleration;
  range.of(p.weighted_displacement) = scheme.load_weight() * range.of(p.displacement) - scheme.alpha * a;
  range.of(p.weighted_velocity) = scheme.load_weight() * range.of(p.velocity) - scheme.alpha * v;
}
inline void predict(const HhtScheme& scheme, const LinearMotion& motion, Prediction& p) {
  predict(scheme, motion, {0, motion.displacement.size()}, p);
}

/// What the contact forces up to the beginning of a step add to its right-hand side: −α f(t); with
/// ContactForceRule::energy (½ f(t) − (1−γ) p(t))/γ, see docs/theory/time_integration.md.
inline void past_contact_load(const HhtScheme& scheme, const LinearMotion& motion, const DofRange& range,
                              Eigen::VectorXd& load) {
  load.resize(motion.contact_load.size());
  if (scheme.contact_force == ContactForceRule::endpoint) {
    range.of(load) = -scheme.alpha * range.of(motion.contact_load);
  } else {
    range.of(load) =
        (0.5 * range.of(motion.contact_load) - (1.0 - scheme.gamma()) * range.of(motion.step_load)) / scheme.gamma();
  }
}

/// Close the step of the unknowns in `range` with the increment Δ over the predictor.
inline void update(const HhtScheme& scheme, const Prediction& p, const Eigen::VectorXd& increment,
                   const DofRange& range, LinearMotion& motion) {
  range.of(motion.displacement) = range.of(p.displacement) + range.of(increment);
  range.of(motion.velocity) = range.of(p.velocity) + scheme.velocity_rate() * range.of(increment);
  range.of(motion.acceleration) = scheme.acceleration_rate() * range.of(increment);
}
inline void update(const HhtScheme& scheme, const Prediction& p, const Eigen::VectorXd& increment,
                   LinearMotion& motion) {
  update(scheme, p, increment, {0, increment.size()}, motion);
}

}  // namespace railtab
