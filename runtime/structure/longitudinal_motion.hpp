#pragma once

#include <vector>

#include "railtab/runtime/structure/track_bridge.hpp"

namespace railtab {

/// Largest change of a rail head's static compliance that counts as none.
inline constexpr double longitudinal_tolerance = 0.01;

/// How much it changes the rails under a wheelset that rails and sleepers do not move along x: the largest relative
/// change of the work fᵀC f of any static load f on both rail heads, with C = Bᵀ K⁻¹ B of their y, z and roll (z alone
/// in the vertical plane), over a sleeper and between two. It is computed on short pieces of this track: on the ground,
/// on the deck's ballast with the deck held, and on one span of every kind. Each piece reaches twenty bays beyond.
/// @throws ComputationError where the stiffness of a piece is not positive definite
[[nodiscard]] double longitudinal_change(const TrackParameters& track, const std::vector<BridgeParameters>& spans,
                                         MotionPlane plane);

/// The track with `automatic` decided: left out where longitudinal_change() is within the tolerance.
struct LongitudinalChoice {
  LongitudinalMotion motion = LongitudinalMotion::kept;
  double change = 0.0;  ///< longitudinal_change(); 0 where `kept` is asked for
};
[[nodiscard]] LongitudinalChoice choose_longitudinal(const TrackParameters& track,
                                                     const std::vector<BridgeParameters>& spans, MotionPlane plane);

}  // namespace railtab
