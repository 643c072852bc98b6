#pragma once

#include <vector>

#include "railtab/runtime/contact/contact_pair.hpp"

namespace railtab {

/// The contact search of Montenegro & Calcada (2023), kept as a reference to compare with: wheel split into tread and
/// flange at the point of maximum curvature, convex search (Eqs. 1-4) accepted where the wheel's own curvature is
/// convex (Eq. 2), otherwise the overlap of n discretised points per profile (Eqs. 5-10). At most two patches.
class PaperSearch {
 public:
  PaperSearch(WheelRailPair pair, int points = 1000);
  [[nodiscard]] const WheelRailPair& pair() const noexcept { return pair_; }
  [[nodiscard]] ContactPatches patches(const WheelsetPose& pose) const noexcept;

 private:
  WheelRailPair pair_;
  // implementer: sampled points of both zones
};

}  // namespace railtab
