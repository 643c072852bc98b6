// Equilibrium of moments of a train about the track's axis at the height of the rail heads, positive where they push
// the right rail down.
#pragma once

#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab::testing {

/// Of the contact forces, by the loads on both rail heads and their moments about them [N m].
inline double moment_at_rails(const VsiModel& model, const VsiState& state) {
  double moment = 0.0;
  for (int wheel = 0; wheel < 2 * model.wheelsets(); ++wheel) {
    const Eigen::Vector3d on_rail = state.contact.end_force.segment<3>(rail_unknown(wheel));
    const double y = (wheel % 2 == 0 ? -1.0 : 1.0) * model.geometry->pair().rail_offset();
    moment += y * on_rail[1] + on_rail[2];
  }
  return moment;
}

/// Σ W Δy: what the weights of bodies add that have moved aside [N m].
inline double moment_of_weights(const VsiModel& model, const VsiState& state) {
  double moment = 0.0;
  for (const LinearMotion& vehicle : state.vehicle) {
    for (const DofIndices& dof : model.vehicle.dof) {
      moment += model.vehicle.gravity * model.vehicle.mass(dof[2], dof[2]) * vehicle.displacement[dof[1]];
    }
  }
  return moment;
}

/// −Σ (m h a_y + J_x·d²φ/dt²): of the masses' inertia [N m].
inline double moment_of_inertia_forces(const VsiModel& model, const VsiState& state) {
  double moment = 0.0;
  for (const LinearMotion& vehicle : state.vehicle) {
    for (std::size_t b = 0; b < model.vehicle.dof.size(); ++b) {
      const int y = model.vehicle.dof[b][1], roll = model.vehicle.dof[b][3];
      const double height = -model.vehicle.bodies[b].position.z();
      moment -= model.vehicle.mass(y, y) * height * vehicle.acceleration[y];
      moment -= model.vehicle.mass(roll, roll) * vehicle.acceleration[roll];
    }
  }
  return moment;
}

/// Σ m h: moment per lateral acceleration of the track [kg m].
inline double mass_times_height(const VehicleModel& vehicle) {
  double moment = 0.0;
  for (std::size_t b = 0; b < vehicle.bodies.size(); ++b) {
    moment -= vehicle.mass(vehicle.dof[b][1], vehicle.dof[b][1]) * vehicle.bodies[b].position.z();
  }
  return moment;
}

}  // namespace railtab::testing
