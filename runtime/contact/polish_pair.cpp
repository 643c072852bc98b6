#include "railtab/runtime/contact/polish_step.hpp"

namespace railtab {

namespace polish {

PairStatus take_more_steps(const WheelRailPair& pair, const WheelsetCentre& centre, const PoseTrigonometry& trig,
                           ContactPatch& patch) noexcept {
  constexpr int most_steps = 3;  // a start that needs more seldom leads to a pair, and a search is faster
  PairStatus status = PairStatus::not_converged;
  for (int n = 0; n < most_steps; ++n) {
    if (take_step(pair, centre, trig, {patch.s_wheel, patch.s_rail}, patch, status) != Outcome::again) return status;
  }
  return PairStatus::not_converged;
}

}  // namespace polish

PairStatus polish_pair(const WheelRailPair& pair, const WheelsetCentre& centre, const PoseTrigonometry& trig,
                       const PairPosition& start, ContactPatch& patch) noexcept {
  return polish::polished(pair, centre, trig, start, patch);
}

}  // namespace railtab
