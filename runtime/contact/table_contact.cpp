#include "railtab/runtime/contact/table_contact.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

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

/// Allowance for the error of z_touch when branches are picked [m]: a branch too many costs one Newton.
constexpr double height_margin = 4e-6;
/// A refined pair further from its start than this is another branch's [m].
constexpr double capture_distance = 0.5e-3;
/// Two refined pairs nearer than this are one [m].
constexpr double same_pair = 1e-6;
/// A gap counts as vertical height at most this many times: 1/cos of the steepest contact angle, 80 degrees [-].
constexpr double steepest_gap = 6.0;

}  // namespace

TableContact::TableContact(GeometryTable table) : table_(std::move(table)), search_(pair_of(table_.data())) {}

ContactPatches TableContact::patches(const WheelsetPose& pose, double near_miss) const noexcept {
  ContactPatches result;
  if (!patches_from_table(pose, near_miss, result)) {
    result.count = 0;
    result = search_.patches(pose, near_miss);
  }
  return result;
}

bool TableContact::patches_from_table(const WheelsetPose& pose, double near_miss,
                                      ContactPatches& result) const noexcept {
  const GeometryTable::Lookup lookup = table_.lookup(pose.y, pose.z, pose.yaw, pose.roll);
  if (lookup.status == GeometryTable::Status::outside || lookup.count == 0) return false;
  const double lowering = pose.z + near_miss * steepest_gap - lookup.first_touch;
  // A limit of 0 is a branch that may touch before all of these: it is to be searched at any height.
  if (!(lookup.trusted_lowering > 0 && lowering <= lookup.trusted_lowering)) return false;
  if (!add_branch_patches(search_.pair(), lookup, pose, PoseTrigonometry(pose), near_miss, result)) return false;
  result.from_table = true;
  return true;
}

bool add_branch_patches(const WheelRailPair& pair, const GeometryTable::Lookup& lookup, const WheelsetPose& pose,
                        const PoseTrigonometry& trig, double near_miss, ContactPatches& result) noexcept {
  static_assert(GeometryTable::max_branches <= ContactPatches::capacity);
  const WheelsetCentre centre = wheelset_centre(pair, pose);
  for (int n = 0; n < lookup.count; ++n) {
    const BranchStart& start = lookup.branch[n];
    if (start.distance < -near_miss - height_margin) continue;
    ContactPatch& patch = result.patch[result.count];
    if (polish_pair(pair, centre, trig, start.s_wheel, start.s_rail, patch) != PairStatus::converged ||
        std::abs(patch.s_wheel - start.s_wheel) > capture_distance) {
      return false;
    }
    for (const ContactPatch& other : result) {
      if (std::abs(other.s_wheel - patch.s_wheel) < same_pair) return false;
    }
    if (patch.penetration <= -near_miss) continue;
    patch.source = PatchSource::table;
    // The branches of a leaf stand in increasing s_rail, so this is rare.
    for (int place = result.count++; place > 0 && result.patch[place - 1].y_rail > result.patch[place].y_rail;
         --place) {
      std::swap(result.patch[place - 1], result.patch[place]);
    }
  }
  return true;
}

}  // namespace railtab
