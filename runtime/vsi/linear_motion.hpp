#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <iterator>
#include <optional>
#include <vector>

#include "railtab/runtime/algebra/step_end.hpp"
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
  /// Where either load may be other than zero, some unknowns perhaps twice; none: not known. Who writes loads elsewhere
  /// resets it.
  std::optional<std::vector<int>> loaded;

  explicit LinearMotion(Eigen::Index dofs = 0)
      : displacement(Eigen::VectorXd::Zero(dofs)),
        velocity(Eigen::VectorXd::Zero(dofs)),
        acceleration(Eigen::VectorXd::Zero(dofs)),
        contact_load(Eigen::VectorXd::Zero(dofs)),
        step_load(Eigen::VectorXd::Zero(dofs)) {}
};

/// Newmark's predictors ã = a + Δt v + Δt²(½−β) a'' and ṽ = v + Δt(1−γ) a''.
struct NewmarkPredictor {
  double time_step;                     ///< Δt [s]
  double displacement_by_acceleration;  ///< Δt²(½−β) [s²]
  double velocity_by_acceleration;      ///< Δt(1−γ) [s]

  explicit NewmarkPredictor(const HhtScheme& scheme)
      : time_step(scheme.time_step),
        displacement_by_acceleration(scheme.time_step * scheme.time_step * (0.5 - scheme.beta())),
        velocity_by_acceleration(scheme.time_step * (1.0 - scheme.gamma())) {}
  [[nodiscard]] double displacement(double a, double v, double acceleration) const noexcept {
    return a + time_step * v + displacement_by_acceleration * acceleration;
  }
  [[nodiscard]] double velocity(double v, double acceleration) const noexcept {
    return v + velocity_by_acceleration * acceleration;
  }
};

/// Predictors of one HHT step, caller-owned so that a step allocates nothing.
struct Prediction {
  Eigen::VectorXd displacement, velocity;                    ///< ã, ṽ
  Eigen::VectorXd weighted_displacement, weighted_velocity;  ///< (1+α)ã − αa(t), (1+α)ṽ − αv(t)
  /// Of a vehicle on Hertz's contacts: right-hand side, and Δ, first without the contacts' forces, at last with them.
  Eigen::VectorXd known, increment;
};

using ConstVector = Eigen::Ref<const Eigen::VectorXd>;

/// The prediction of the step that begins with this motion.
inline void predict(const HhtScheme& scheme, const LinearMotion& motion, Prediction& p) {
  const NewmarkPredictor predictor(scheme);
  const double weight = scheme.load_weight(), alpha = scheme.alpha;
  p.displacement = motion.displacement + predictor.time_step * motion.velocity +
                   predictor.displacement_by_acceleration * motion.acceleration;
  p.velocity = motion.velocity + predictor.velocity_by_acceleration * motion.acceleration;
  p.weighted_displacement = weight * p.displacement - alpha * motion.displacement;
  p.weighted_velocity = weight * p.velocity - alpha * motion.velocity;
}

/// What the stiffness and the damping of a step's load act on, in terms of the motion at its beginning:
/// (1+α)ã − αa = u + u_v v + u_w w and (1+α)ṽ − αv = v + v_w w.
struct WeightedPredictor {
  double u_v, u_w, v_w;

  explicit WeightedPredictor(const HhtScheme& scheme) {
    const NewmarkPredictor predictor(scheme);
    const double weight = scheme.load_weight();
    u_v = weight * predictor.time_step;
    u_w = weight * predictor.displacement_by_acceleration;
    v_w = weight * predictor.velocity_by_acceleration;
  }
  /// Of numbers, or of vectors.
  template <class Begin, class Predicted>
  void predict(const Begin& u, const Begin& v, const Begin& w, Predicted&& displacement, Predicted&& velocity) const {
    displacement = u + u_v * v + u_w * w;
    velocity = v + v_w * w;
  }
};

/// Closes a step with increments over its predictor. Refers to the motion's vectors.
template <class Motion>
[[nodiscard]] StepEnd step_end(const HhtScheme& scheme, Motion& motion) {
  const NewmarkPredictor predictor(scheme);
  return {motion.displacement.data(),
          motion.velocity.data(),
          motion.acceleration.data(),
          predictor.time_step,
          predictor.displacement_by_acceleration,
          predictor.velocity_by_acceleration,
          scheme.velocity_rate(),
          scheme.acceleration_rate()};
}

/// Closes the step of the degrees of freedom in `range` with the increment Δ over the predictor.
inline void update(const HhtScheme& scheme, const Eigen::VectorXd& increment, const DofRange& range,
                   LinearMotion& motion) {
  const StepEnd end = step_end(scheme, motion);
#pragma GCC ivdep
  for (Eigen::Index i = range.begin; i < range.end(); ++i) end.move(static_cast<std::size_t>(i), increment[i]);
}
inline void update(const HhtScheme& scheme, const Eigen::VectorXd& increment, LinearMotion& motion) {
  update(scheme, increment, {0, increment.size()}, motion);
}

/// The degrees of freedom in `range` that the contacts loaded at the end of a step or in its mean: few of a
/// structure's. Some perhaps twice.
inline void find_loaded(const LinearMotion& motion, const DofRange& range, std::vector<int>& dofs) {
  dofs.clear();
  if (motion.loaded) {
    std::copy_if(motion.loaded->begin(), motion.loaded->end(), std::back_inserter(dofs),
                 [&](int dof) { return dof >= range.begin && dof < range.end(); });
    return;
  }
  constexpr Eigen::Index together = 32, width = 8;  // to pass over what is not loaded
  for (Eigen::Index first = range.begin; first < range.end(); first += together) {
    if (first + together <= range.end()) {
      Eigen::Array<double, width, 1> loaded = Eigen::Array<double, width, 1>::Zero();
      for (Eigen::Index i = first; i < first + together; i += width) {
        loaded +=
            motion.contact_load.segment<width>(i).array().abs() + motion.step_load.segment<width>(i).array().abs();
      }
      if (loaded.sum() == 0.0) continue;
    }
    for (Eigen::Index i = first; i < std::min(first + together, range.end()); ++i) {
      if (motion.contact_load[i] != 0.0 || motion.step_load[i] != 0.0) dofs.push_back(static_cast<int>(i));
    }
  }
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

/// The same under ContactForceRule::endpoint at few degrees of freedom, where there is no load elsewhere.
inline void close_load(const HhtScheme& scheme, const std::vector<int>& dofs, const Eigen::VectorXd& load,
                       const Eigen::VectorXd& f, Eigen::VectorXd& p) {
  for (int dof : dofs) p[dof] = scheme.load_weight() * load[dof] - scheme.alpha * f[dof];
}

/// Closes a step with the increment Δ over the prediction.
inline void update(const HhtScheme& scheme, const Prediction& p, const Eigen::VectorXd& increment,
                   LinearMotion& motion) {
  motion.displacement = p.displacement + increment;
  motion.velocity = p.velocity + scheme.velocity_rate() * increment;
  motion.acceleration = scheme.acceleration_rate() * increment;
}

}  // namespace railtab
