#pragma once

#include <array>

#include "railtab/runtime/contact/contact_pair.hpp"
#include "railtab/runtime/contact/contact_search_scan.hpp"

namespace railtab {

/// Touching positions of one wheel at fixed y, roll and yaw, in increasing s_wheel, without heap allocation.
struct TouchPoints {
  static constexpr int capacity = 16;
  std::array<TouchPoint, capacity> touch;
  int count = 0;
  bool overflow = false;  ///< more than `capacity` minima: the lowest were kept

  [[nodiscard]] const TouchPoint* begin() const noexcept { return touch.data(); }
  [[nodiscard]] const TouchPoint* end() const noexcept { return touch.data() + count; }
};

/// The online search: every local minimum of the signed distance between wheel and rail at a pose. The truth that the
/// tables are held against. A constant model: build once per pair, query from any thread without allocation.
class ContactSearch {
 public:
  /// @param spacing of the scan along the wheel profile [m]; two minima closer than this may be taken for one.
  /// @throws InputError where spacing is not in (0, 1e-2]
  explicit ContactSearch(WheelRailPair pair, double spacing = 0.25e-3);

  [[nodiscard]] const WheelRailPair& pair() const noexcept { return pair_; }

  /// All candidate patches whose penetration is above -near_miss (a gap of near_miss [m] is still reported).
  /// A minimum at an open end of a profile is not a contact.
  [[nodiscard]] ContactPatches patches(const WheelsetPose& pose, double near_miss = 0.0) const noexcept;

  /// Adds to `result` the patches that patches() finds on the scan intervals that meet the stretch s_low..s_high of the
  /// wheel profile [m]; a patch within 5 µm of one already there is that one.
  void add_patches_between(double s_low, double s_high, const WheelsetPose& pose, const PoseTrigonometry& trig,
                           double near_miss, ContactPatches& result) const noexcept;

  /// Every local minimum of the vertical gap between wheel and rail, whatever the height of the wheel: one TouchPoint
  /// per branch, with exact derivatives along y. A wheel at pose.z = z_touch touches there; the least z_touch is where
  /// it first touches. At the touch, vertical gap and normal distance have the same minimum.
  /// @param height minima up to this height above the lowest z_touch are returned [m]
  [[nodiscard]] TouchPoints touches(double y, double roll, double yaw, double height = 3e-3) const noexcept;

  /// z of the pose at which the wheel first touches the rail at this y, roll, yaw [m]; NaN where they never meet.
  [[nodiscard]] double touch_height(double y, double roll, double yaw) const noexcept;

  /// The touch of touch_height() with its derivatives; z_touch is NaN where they never meet.
  [[nodiscard]] TouchPoint first_touch(double y, double roll, double yaw) const noexcept;

 private:
  WheelRailPair pair_;
  ContactScan scan_;
};

/// Roll [rad] and z of a wheelset in which both wheels just touch undeflected rails at lateral shift y and this yaw.
struct RigidPosition {
  double roll = 0.0;
  double z = 0.0;
  bool converged = false;
};
[[nodiscard]] RigidPosition rigid_position(const ContactSearch& search, double y, double yaw) noexcept;

}  // namespace railtab
