#pragma once

#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

struct EquilibriumReport {
  bool converged = false;
  int iterations = 0;
  double change = 0.0;  ///< of the last iteration [m, rad]
};

/// The train at rest on the track (rolling steadily: creep forces act, rates are zero) with its first position at
/// `state.time`: displacements, contact forces, and the wheelsets' rotation that needs no torque. Velocities and
/// accelerations otherwise zero.
///
/// A rigid-body motion that nothing holds is held by a small multiple of the mass, K + eps M, iterated until it carries
/// no load (proximal iteration), so that the result is the equilibrium of K itself.
[[nodiscard]] EquilibriumReport static_equilibrium(const VsiModel& model, VsiState& state);

/// Static equilibrium, and the velocities and accelerations of the quasi-static motion along the track: what the
/// deflections under a train that rolls at constant speed change by, from equilibria one `time_step` before and after.
[[nodiscard]] EquilibriumReport quasi_static_start(const VsiModel& model, double time_step, VsiState& state);

}  // namespace railtab
