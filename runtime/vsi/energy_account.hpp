#pragma once

#include <array>
#include <span>
#include <vector>

#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

/// Energies of train, track and contacts at one instant, and what came and went since the account began [J]. They are
/// those of the motion relative to the steady run at constant speed: the train's own V² and R0 Ω² are left out.
struct EnergyBalance {
  double time = 0;  ///< [s]
  double kinetic = 0;
  double strain = 0;   ///< suspension and structure, bump stops and dry friction that sticks included
  double gravity = 0;  ///< of the static loads, zero in the nominal position
  double contact = 0;  ///< elastic energy: (2/5) F d of every patch, that of the loaded table with its share

  double dissipated = 0;     ///< by dampers of train and structure and by dry friction
  double creep_work = 0;     ///< of creep forces on train and track; negative where they slow the motion down
  double load_work = 0;      ///< of loads on bodies (VsiModel::loads, changing speed)
  double traction_work = 0;  ///< what the drive does against normal forces as wheels run up rails and irregularities
  /// What the time integration of the normal contact made: change of its energy less the work done on it. Contact
  /// damping counts as loss.
  double contact_gain = 0;
  /// The part of contact_gain that is none of the time integration's: Hertz stiffness and normals change as a contact
  /// moves over the profiles, and the forces have no potential.
  double stiffness_work = 0;

  double initial = 0;  ///< energy at the beginning of the account
  /// Impulse of the contact forces on the train since then, y and z, as the steps have them [N s].
  std::array<double, 2> contact_impulse{};
  [[nodiscard]] double energy() const noexcept { return kinetic + strain + gravity + contact; }
  /// Energy that nothing accounts for: gained by the time integration as a whole, contact_gain included. HHT's
  /// numerical damping makes it negative; under Newmark (α = 0) the rest is the contacts'.
  [[nodiscard]] double gain() const noexcept {
    return energy() - initial + dissipated - creep_work - load_work - traction_work;
  }
};

/// Keeps the balance of a run with Hertz's contact, step by step. Works are those of mean_force() in the contacts and
/// of mean velocities in the dampers: second order in the time step, whatever rule the steps have for their forces.
/// What a moving ground does is left out.
class EnergyAccount {
 public:
  EnergyAccount(const VsiModel& model, const VsiState& state);
  /// @param gamma of the step that led to `state` (HhtScheme)
  void step(double gamma, const VsiState& state);
  [[nodiscard]] const EnergyBalance& balance() const noexcept { return balance_; }
  /// The last step's part of contact_gain, per wheelset [J].
  [[nodiscard]] std::span<const double> wheelset_gain() const noexcept { return wheelset_gain_; }
  /// Energy of the contact springs now, per wheelset [J].
  [[nodiscard]] std::span<const double> wheelset_energy() const noexcept { return last_.contact_energy; }

 private:
  /// What a step's works are made of.
  struct Instant {
    std::vector<Eigen::VectorXd> vehicle_displacement, vehicle_velocity;
    std::vector<Eigen::VectorXd> elongation, friction;  ///< of force elements, per vehicle
    Eigen::VectorXd structure_velocity;
    Eigen::VectorXd wheel_displacement;          ///< 12 per wheelset: wheelset, rail heads with irregularity [m, rad]
    Eigen::VectorXd wheel_velocity;              ///< likewise, of the rails' material [m/s, rad/s]
    std::vector<ContactMemory> contact, normal;  ///< per wheel: contact forces, and the normal ones alone
    Eigen::VectorXd mean_force, mean_normal_force;  ///< means over the step that ended here, on wheelsets and rails
    Eigen::VectorXd step_load;                      ///< ContactSolution::step_load
    std::vector<Eigen::VectorXd> vehicle_load;      ///< besides gravity; empty where there is none
    std::vector<double> contact_energy;             ///< of the contact springs, per wheelset [J]
  };
  [[nodiscard]] Instant observe(const VsiState& state);
  [[nodiscard]] double dissipated_by_elements(double time_step, const Instant& now) const;

  const VsiModel& model_;
  TrainContact contact_, frictionless_;  ///< at the speed of the instant
  Instant last_;
  EnergyBalance balance_;
  std::vector<double> wheelset_gain_;
};

}  // namespace railtab
