#pragma once

#include <Eigen/Core>

#include "railtab/runtime/base/dof_range.hpp"
#include "railtab/runtime/vsi/hht.hpp"

namespace railtab {

/// K̄ = M·acceleration_rate + (1+α)(C·velocity_rate + K) (Eq. 13), dense or sparse.
template <class Matrix>
[[nodiscard]] Matrix effective_matrix(const HhtScheme& scheme, const Matrix& M, const Matrix& C, const Matrix& K) {
  return scheme.acceleration_rate() * M + scheme.load_weight() * (scheme.velocity_rate() * C + K);
}

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

using ConstVector = Eigen::Ref<const Eigen::VectorXd>;

/// Predictors ã and ṽ.
inline void predict(const HhtScheme& scheme, const ConstVector& a, const ConstVector& v,
                    const ConstVector& acceleration, Eigen::Ref<Eigen::VectorXd> predicted,
                    Eigen::Ref<Eigen::VectorXd> predicted_velocity) {
  const double dt = scheme.time_step;
  predicted = a + dt * v + dt * dt * (0.5 - scheme.beta()) * acceleration;
  predicted_velocity = v + dt * (1.0 - scheme.gamma()) * acceleration;
}

/// Displacement, velocity and acceleration at the end of a step, to be written.
struct MotionTarget {
  Eigen::Ref<Eigen::VectorXd> displacement, velocity, acceleration;
};
/// Closes a step with the increment Δ over the predictors.
inline void update(const HhtScheme& scheme, const ConstVector& predicted, const ConstVector& predicted_velocity,
                   const ConstVector& increment, MotionTarget motion) {
  motion.displacement = predicted + increment;
  motion.velocity = predicted_velocity + scheme.velocity_rate() * increment;
  motion.acceleration = scheme.acceleration_rate() * increment;
}

/// Predictors of the degrees of freedom in `range`; those of others keep their values.
inline void predict(const HhtScheme& scheme, const LinearMotion& motion, const DofRange& range, Prediction& p) {
  for (Eigen::VectorXd* vector : {&p.displacement, &p.velocity, &p.weighted_displacement, &p.weighted_velocity})
    vector->resize(motion.displacement.size());
  predict(scheme, range.of(motion.displacement), range.of(motion.velocity), range.of(motion.acceleration),
          range.of(p.displacement), range.of(p.velocity));
  range.of(p.weighted_displacement) =
      scheme.load_weight() * range.of(p.displacement) - scheme.alpha * range.of(motion.displacement);
  range.of(p.weighted_velocity) =
      scheme.load_weight() * range.of(p.velocity) - scheme.alpha * range.of(motion.velocity);
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

/// The contacts' part p of Eq. 12 in a step that ends with the contact forces `load`; for the next step.
/// @param f the contact forces at the step's beginning @param p that of the step before; is replaced
inline void close_load(const HhtScheme& scheme, const ConstVector& load, const ConstVector& f,
                       Eigen::Ref<Eigen::VectorXd> p) {
  const double g = scheme.gamma();
  if (scheme.contact_force == ContactForceRule::endpoint) {
    p = scheme.load_weight() * load - scheme.alpha * f;
  } else {
    p = scheme.load_weight() * load + (0.5 * f - (1.0 - g) * p) / g;
  }
}

/// Closes the step of the degrees of freedom in `range` with the increment Δ over the predictor.
inline void update(const HhtScheme& scheme, const Prediction& p, const Eigen::VectorXd& increment,
                   const DofRange& range, LinearMotion& motion) {
  update(scheme, range.of(p.displacement), range.of(p.velocity), range.of(increment),
         {range.of(motion.displacement), range.of(motion.velocity), range.of(motion.acceleration)});
}
inline void update(const HhtScheme& scheme, const Prediction& p, const Eigen::VectorXd& increment,
                   LinearMotion& motion) {
  update(scheme, p, increment, {0, increment.size()}, motion);
}

}  // namespace railtab
