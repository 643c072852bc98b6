#include "railtab/runtime/contact/table_contact.hpp"

#include <algorithm>
#include <cmath>

namespace railtab {

namespace {

WheelRailPair pair_of(const GeometryTableData& data) {
  PairDimensions dimensions;
  dimensions.track_gauge = data.track_gauge;
  dimensions.gauge_height = data.gauge_height;
  dimensions.flange_back = data.flange_back;
  dimensions.nominal_radius = data.nominal_radius;
  return {ProfileCurve(data.wheel), ProfileCurve(data.rail), dimensions};
}

/// Largest vertical height per unit of normal distance on any branch: sqrt(1 + z'²) = 1/|cos(contact angle)|.
double steepest_branch(const GeometryTableData& data) {
  double steepest = 1.0;
  for (const GeometryBranch& branch : data.branches) {
    for (double slope : branch.z_touch_dy) {
      if (!std::isnan(slope)) steepest = std::max(steepest, std::hypot(1.0, slope));
    }
  }
  return steepest;
}

/// Allowance for the interpolation error of z_touch when branches are picked [m]: a branch too many costs one Newton.
constexpr double height_margin = 2e-6;
/// A refined pair further from its start than this is another branch's [m].
constexpr double capture_distance = 0.5e-3;
/// Two refined pairs nearer than this are one [m].
constexpr double same_pair = 1e-6;
/// Newton stops where its next step would be below this [m]: the position is then that near, and the penetration, which
/// is stationary at the common normal, exact to rounding.
constexpr double step_tolerance = 1e-8;
constexpr int newton_iterations = 8;

}  // namespace

TableContact::TableContact(GeometryTable table)
    : table_(std::move(table)), search_(pair_of(table_.data())), steepest_(steepest_branch(table_.data())) {}

ContactPatches TableContact::patches(const WheelsetPose& pose, double near_miss) const noexcept {
  ContactPatches result;
  if (!patches_from_table(pose, near_miss, result)) result = search_.patches(pose, near_miss);
  return result;
}

TableContact::Route TableContact::route(const GeometryTable::Lookup& lookup, const WheelsetPose& pose,
                                        double near_miss) const noexcept {
  if (lookup.status == GeometryTable::Status::outside || lookup.count == 0) return Route::online;
  double first_touch = lookup.branch[0].z_touch;
  for (int n = 1; n < lookup.count; ++n) first_touch = std::min(first_touch, lookup.branch[n].z_touch);
  const double lowering = pose.z + near_miss * steepest_ - first_touch;
  // A limit of 0 is a branch that may touch before all of these: it is to be searched at any height.
  if (lookup.trusted_lowering > 0 && lowering <= lookup.trusted_lowering) return Route::branches;
  const bool windows = !lookup.windows.empty() && lowering <= table_.data().searched_lowering;
  return windows ? Route::windows : Route::online;
}

bool TableContact::searches_windows(const WheelsetPose& pose, double near_miss) const noexcept {
  return route(table_.lookup(pose.y, pose.yaw, pose.roll), pose, near_miss) == Route::windows;
}

bool TableContact::patches_from_table(const WheelsetPose& pose, double near_miss,
                                      ContactPatches& result) const noexcept {
  const GeometryTable::Lookup lookup = table_.lookup(pose.y, pose.yaw, pose.roll);
  const Route way = route(lookup, pose, near_miss);
  if (way == Route::online) return false;
  const PoseTrigonometry trigonometry(pose);
  if (!add_branch_patches(lookup, pose, trigonometry, near_miss, result)) return false;
  if (way == Route::windows) {
    for (const SearchWindow& window : lookup.windows) {
      search_.add_patches_between(window.s_low, window.s_high, pose, trigonometry, near_miss, result);
    }
    for (int n = 0; n < result.count; ++n) result.patch[n].source = PatchSource::table;
  }
  result.from_table = !result.overflow;
  return result.from_table;
}

bool TableContact::add_branch_patches(const GeometryTable::Lookup& lookup, const WheelsetPose& pose,
                                      const PoseTrigonometry& trigonometry, double near_miss,
                                      ContactPatches& result) const noexcept {
  for (int n = 0; n < lookup.count; ++n) {
    const BranchValue& branch = lookup.branch[n];
    // Distance from (y, z) to the branch's touch curve, seen as a straight line: the normal is (-z', 1) cos(angle).
    const double cosine = 1.0 / std::sqrt(1.0 + branch.z_touch_dy * branch.z_touch_dy);
    const double distance = (pose.z - branch.z_touch) * cosine;
    if (distance < -near_miss - height_margin) continue;
    // A wheel moved back along the normal by the penetration touches at the same pair: y* = y - d·n_y.
    const double shift = distance * branch.z_touch_dy * cosine;
    const double s_wheel = branch.s_wheel + branch.s_wheel_dy * shift;
    const double s_rail = branch.s_rail + branch.s_rail_dy * shift;
    const RefinedPair refined =
        refine_pair(search_.pair(), pose, trigonometry, s_wheel, s_rail, newton_iterations, step_tolerance);
    if (refined.status != PairStatus::converged || std::abs(refined.patch.s_wheel - s_wheel) > capture_distance) {
      return false;
    }
    for (const ContactPatch& other : result) {
      if (std::abs(other.s_wheel - refined.patch.s_wheel) < same_pair) return false;
    }
    if (refined.patch.penetration <= -near_miss) continue;
    static_assert(GeometryTable::max_branches <= ContactPatches::capacity);
    int place = result.count++;
    while (place > 0 && result.patch[place - 1].y_rail > refined.patch.y_rail) {
      result.patch[place] = result.patch[place - 1];
      --place;
    }
    result.patch[place] = refined.patch;
    result.patch[place].source = PatchSource::table;
  }
  return true;
}

}  // namespace railtab
