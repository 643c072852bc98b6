#pragma once

#include <Eigen/Core>
#include <vector>

#include "railtab/runtime/vsi/contact_newton.hpp"
#include "railtab/runtime/vsi/element_forces.hpp"
#include "railtab/runtime/vsi/hht.hpp"
#include "railtab/runtime/vsi/linear_motion.hpp"

namespace railtab {

/// Vertical motion of one vehicle's wheelsets at the end of a step: displacement, velocity, acceleration.
struct WheelsetHeave {
  Eigen::VectorXd z, v, a;
};

/// One kind of vehicle whose wheelsets move vertically as the rails make them: for one time-step size, the contact
/// forces that a prescribed heave of the wheelsets needs. With b all other dofs, HHT gives (docs/theory/coupling.md)
///   Δ_b = K̄_bb⁻¹ [R_b − M_bc a − (1+α)(C_bc v + K_bc z)],  F = F_free + Z z + W v + A a.
class RigidWheelResponse {
 public:
  RigidWheelResponse(const VehicleModel& vehicle, const Eigen::MatrixXd& damping, const HhtScheme& scheme);

  /// R of the step: loads, damping and stiffness forces known before the wheelsets' heave. Changes the prediction of
  /// the wheelsets' heave, which is prescribed.
  /// @param load of the step on the vehicle besides the contacts: vehicle_step_load()
  [[nodiscard]] Eigen::VectorXd remainder(const HhtScheme& scheme, const Eigen::VectorXd& load,
                                          const LinearMotion& motion, Prediction& prediction) const;
  /// Contact forces on the wheelsets (down) [N] where these end the step with no heave, velocity and acceleration.
  [[nodiscard]] Eigen::VectorXd free_force(const Eigen::VectorXd& R) const;
  /// Displacement of all dofs at the end of the step.
  [[nodiscard]] Eigen::VectorXd displacement(const Prediction& prediction, const Eigen::VectorXd& R,
                                             const WheelsetHeave& heave) const;
  /// The prediction with the wheelsets' heave at the end of the step in place of theirs.
  [[nodiscard]] Prediction prescribed(const Prediction& prediction, const WheelsetHeave& heave) const;
  /// Closes the step with the wheelsets' heave and the forces that it needs.
  void update(const HhtScheme& scheme, const Prediction& prediction, const Eigen::VectorXd& R,
              const WheelsetHeave& heave, const Eigen::VectorXd& force, LinearMotion& motion) const;

  /// Forces on the wheelsets per heave, velocity and acceleration of the wheelsets, w × w.
  [[nodiscard]] const Eigen::MatrixXd& stiffness() const noexcept { return Z_; }
  [[nodiscard]] const Eigen::MatrixXd& damping() const noexcept { return W_; }
  [[nodiscard]] const Eigen::MatrixXd& mass() const noexcept { return A_; }
  /// Of force elements while the wheelsets' heave is held, per separate system; none where the vehicle has none.
  [[nodiscard]] const std::vector<ElementCompliance>& elements() const noexcept { return elements_; }

 private:
  [[nodiscard]] Eigen::VectorXd increment(const Eigen::VectorXd& R, const WheelsetHeave& heave) const;

  double load_weight_;
  std::vector<ElementCompliance> elements_;
  std::vector<int> b_, c_;     // other dofs, heave of the wheelsets
  SeparateMatrix inverse_bb_;  // K̄_bb⁻¹
  SeparateMatrix damping_, stiffness_;
  Eigen::MatrixXd E_inverse_;  // K̄_cb K̄_bb⁻¹
  Eigen::MatrixXd K_bc_, C_bc_, M_bc_, Z_, W_, A_;
};

/// Wheelsets at rest on their rails: forces and displacements such that each wheelset's heave is the mean of its two
/// rail heads', deviation included; both rails carry the same. @pre vehicles' wheelsets are free to move in z
void rest_on_rails(const ContactProblem& problem, ContactSolution& solution);

/// Contact solution with vertical forces on the wheelsets only, half of the opposite on each rail.
void set_vertical_forces(const Eigen::VectorXd& force, ContactSolution& solution);

}  // namespace railtab
