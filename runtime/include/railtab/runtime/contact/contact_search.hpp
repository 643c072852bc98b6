#pragma once

#include <vector>

#include "railtab/runtime/contact/contact_pair.hpp"

namespace railtab {

/// The online search: every local minimum of the signed distance between wheel and rail at a pose. The truth that the
/// tables are held against. A constant model: build once per pair, query from any thread without allocation.
class ContactSearch {
 public:
  /// @param spacing of the scan along the wheel profile [m]; two minima closer than this may be taken for one.
  explicit ContactSearch(WheelRailPair pair, double spacing = 0.25e-3);

  [[nodiscard]] const WheelRailPair& pair() const noexcept { return pair_; }

  /// All candidate patches whose penetration is above -near_miss (a gap of near_miss [m] is still reported).
  [[nodiscard]] ContactPatches patches(const WheelsetPose& pose, double near_miss = 0.0) const noexcept;

  /// z of the pose at which the wheel first touches the rail at this y, roll, yaw [m]; NaN where they never meet.
  [[nodiscard]] double touch_height(double y, double roll, double yaw) const noexcept;

 private:
  WheelRailPair pair_;
  // scan points of wheel and rail, sampled once
  std::vector<double> scan_s_;
  std::vector<CurvePoint> scan_wheel_;
};

/// Roll [rad] and z of a wheelset in which both wheels just touch undeflected rails at lateral shift y and this yaw.
struct RigidPosition {
  double roll = 0.0;
  double z = 0.0;
  bool converged = false;
};
[[nodiscard]] RigidPosition rigid_position(const ContactSearch& search, double y, double yaw) noexcept;

}  // namespace railtab
