#pragma once

#include <cstddef>

#include "railtab/runtime/vsi/vsi_model.hpp"

namespace railtab {

/// Places of the train of which a start keeps the couplings of each wheel with each, at most: those that
/// steady_start() returns to, unless wheels are many.
[[nodiscard]] constexpr int kept_couplings(std::size_t wheels) noexcept { return wheels > 256 ? 0 : 3; }

struct EquilibriumReport {
  bool converged = false;
  int iterations = 0;
  double change = 0.0;  ///< of the last iteration, of the vehicles and of the structure under the wheels [m, rad]
  double deviation_share = 0.0;  ///< of the track's deviations, for which there is a state of rest: 1 where converged
  double load_share = 0.0;       ///< the same, of the loads besides gravity
  bool steady = true;            ///< of steady_start(): false where the structure does not move
};

/// The train at rest on the track (rolling steadily: creep forces act, rates are zero) with its first position at
/// `state.time`, under gravity and the body loads of that time: displacements, contact forces, and the wheelsets'
/// rotation that needs no torque. Velocities and accelerations otherwise zero.
///
/// A rigid-body motion that nothing holds is held by a small multiple of the mass, K + eps M, iterated until it carries
/// no load (proximal iteration), so that the result is the equilibrium of K itself.
///
/// Where Newton fails, the loads besides gravity, or else the deviations of the track, grow from none to their full
/// size. A state that has not converged is of no use.
[[nodiscard]] EquilibriumReport static_equilibrium(const VsiModel& model, VsiState& state);

/// The start of a run at constant speed: static equilibrium, with the structure moving as a deflection that travels
/// with the train does. Velocity and acceleration come from equilibria some centimetres before and after, and their
/// inertia and damping forces load the structure, so that the first step finds it in balance. Wheelsets with creep
/// forces rise and roll at the rate of the rails' deviations along which they run; bodies on springs stand still. Where
/// that deflection is not found (track whose dampers bear more than its springs), the structure rests.
[[nodiscard]] EquilibriumReport steady_start(const VsiModel& model, VsiState& state);

/// The train moved to the right by `shift` [m] and its wheelsets turned by `yaw` [rad], from a state of rest: where a
/// hunting study begins. Wheelsets rise and roll with their treads and, farther aside, with flanges that climb their
/// rails, so that every wheel carries what it did; without that a shift of millimetres begins with an impact. False
/// where no height near the rails does that: a wheel is beside its rail.
[[nodiscard]] bool displace_train(const VsiModel& model, double shift, double yaw, VsiState& state);

}  // namespace railtab
