#pragma once

#include <Eigen/Core>
#include <optional>

namespace railtab {

/// A time made of equal steps.
struct SteppedTime {
  double duration = 0.0;  ///< [s]
  int steps = 0;
};

/// A state x after some time T, and its derivatives by the state before, by T and by the parameter.
struct FlowEnd {
  Eigen::VectorXd state, by_time, by_parameter;
  Eigen::MatrixXd by_state;
};

/// An autonomous motion ẋ = F(x, λ) by its time integration.
class Flow {
 public:
  virtual ~Flow() = default;
  /// The state that `start` becomes. None: the steps do not converge.
  [[nodiscard]] virtual std::optional<Eigen::VectorXd> end(const Eigen::VectorXd& start, const SteppedTime& time,
                                                           double parameter) const = 0;
  /// The same with derivatives.
  [[nodiscard]] virtual std::optional<FlowEnd> end_with_derivatives(const Eigen::VectorXd& start,
                                                                    const SteppedTime& time,
                                                                    double parameter) const = 0;
  /// What counts as one in each component of the state.
  [[nodiscard]] virtual const Eigen::VectorXd& unit() const = 0;
};

/// Where a periodic motion begins: a coordinate is at an extremum, its rate is zero.
struct CycleSection {
  Eigen::Index coordinate = 0, rate = 0;  ///< components of the state
};

/// A point (height, parameter), height being the section's coordinate, or a direction from one point to another.
struct BranchPoint {
  double height = 0.0, parameter = 0.0;
};

/// A periodic motion, or a guess of one.
struct PeriodicMotion {
  Eigen::VectorXd start;
  SteppedTime period;
  double parameter = 0.0;

  [[nodiscard]] BranchPoint point(const CycleSection& section) const { return {start[section.coordinate], parameter}; }
};

/// The direction of the branch at a periodic motion; steps are those of the motion.
struct BranchTangent {
  Eigen::VectorXd start;
  double duration = 0.0, parameter = 0.0;

  void scale(double factor) {
    start *= factor;
    duration *= factor;
    parameter *= factor;
  }
};

/// The line normal·(point − at) = 0 on which a periodic motion is sought.
struct BranchLine {
  BranchPoint at, normal;
};

struct ShootingLimits {
  double tolerance = 1e-6;           ///< of x(T) − x(0), largest component in units of Flow::unit()
  double relative_tolerance = 2e-5;  ///< the same, per the section's coordinate in its unit; the larger one counts
  int max_iterations = 25;
};

/// The equations of single shooting, in units of the flow,
///     x(T; x0, λ) − x0 = 0,   rate of the section = 0,   normal·(point − at) = 0
/// for x0, T and λ, by Newton's method. Its matrix
///     [ M − I   ∂x/∂T   ∂x/∂λ ]
///     [ eᵀ        0       0   ]        M: monodromy matrix
///     [ nᵀ        0      n_λ  ]
/// is made of derivatives of the flow, learns from corrections [Broyden1965] and is made anew where an iteration gains
/// less than a half.
class Shooting {
 public:
  Shooting(const Flow& flow, const CycleSection& section, const ShootingLimits& limits = {});

  /// The periodic motion on a line, from a guess near it. None: no convergence.
  [[nodiscard]] std::optional<PeriodicMotion> solve(const PeriodicMotion& guess, const BranchLine& line);
  /// Makes the derivatives at a motion, for floquet_multipliers(), tangent() and the next solve(). False where the
  /// steps do not converge.
  [[nodiscard]] bool differentiate(const PeriodicMotion& motion);

  /// Of the motion of the last differentiate(): eigenvalues of the linearised Poincaré map of the section, largest
  /// first. The multiplier 1 along the motion is not among them.
  [[nodiscard]] Eigen::VectorXcd floquet_multipliers() const;
  /// Of the motion of the last differentiate(), with a component along `direction` that is 1.
  [[nodiscard]] BranchTangent tangent(const BranchPoint& direction) const;
  /// |M ẋ − ẋ|/|ẋ| of the motion of the last differentiate(), ẋ by the flow's derivative by time: 0 but for errors of
  /// time integration and derivatives.
  [[nodiscard]] double error_along_motion() const;

  /// By how much Newton's next step on a line across `normal` would change the parameter, after solve() and
  /// differentiate(): an estimate of its error.
  [[nodiscard]] double parameter_error(const BranchPoint& normal) const;

  /// Largest component of the last residual in units of the flow.
  [[nodiscard]] double residual() const noexcept { return residual_; }
  [[nodiscard]] int iterations() const noexcept { return iterations_; }

 private:
  [[nodiscard]] Eigen::Index size() const { return flow_.unit().size(); }
  [[nodiscard]] double tolerance(const PeriodicMotion& motion) const;
  [[nodiscard]] std::optional<Eigen::VectorXd> equations(const PeriodicMotion& motion, const BranchLine& line) const;
  void set_line(const BranchPoint& normal, Eigen::MatrixXd& matrix) const;

  const Flow& flow_;
  CycleSection section_;
  ShootingLimits limits_;
  std::optional<FlowEnd> derivatives_;
  Eigen::VectorXd remainder_;  // what solve() leaves of the equations
  Eigen::MatrixXd matrix_;     // of Newton's method, in units of the flow, but for its last row
  double residual_ = 0.0;
  int iterations_ = 0;
};

}  // namespace railtab
