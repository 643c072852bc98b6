#include "railtab/runtime/contact/contact_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "railtab/runtime/base/constants.hpp"
#include "railtab/runtime/contact/contact_search_walk.hpp"

namespace railtab {

namespace {

constexpr double height_error = 2e-6;  // of the screening heights, with reserve [m]

// Interval j of a block lies between elements j + 1 and j + 2 of its gaps. It is looked at where an end is inside the
// rail, or where an end is a local minimum of the gaps so low that the overlap may hide between the scan points.
bool may_touch(const ContactScan::BlockGaps& gap, int j, double margin) noexcept {
  const auto i = static_cast<std::size_t>(j);
  const double left = gap[i + 1];
  const double right = gap[i + 2];
  if (left == infinity || right == infinity) return false;
  const double lower = std::min(left, right);
  if (lower < height_error) return true;
  return lower < margin && (left <= gap[i] + height_error && left <= right + height_error
                                ? true
                                : right <= gap[i + 3] + height_error && right <= left + height_error);
}

void insert(ContactPatches& patches, const ContactPatch& patch) noexcept {
  ContactPatch* const begin = patches.patch.data();
  ContactPatch* end = begin + patches.count;
  for (ContactPatch* p = begin; p != end; ++p) {
    // Two neighbouring brackets that share their common end point can both end there; a table's patch is that near to
    // the search's.
    if (std::abs(p->s_wheel - patch.s_wheel) < 5e-6) return;
  }
  if (patches.count == ContactPatches::capacity) {
    patches.overflow = true;
    ContactPatch* const shallowest = std::min_element(
        begin, end, [](const ContactPatch& p, const ContactPatch& q) { return p.penetration < q.penetration; });
    if (shallowest->penetration >= patch.penetration) return;
    std::move(shallowest + 1, end, shallowest);
    --end;
    --patches.count;
  }
  ContactPatch* const place = std::upper_bound(
      begin, end, patch, [](const ContactPatch& p, const ContactPatch& q) { return p.y_rail < q.y_rail; });
  std::move_backward(place, end, end + 1);
  *place = patch;
  ++patches.count;
}

// Start of Newton in a bracket: the slope's zero by the chord.
PairPosition chord_zero(const GapBracket& b) noexcept {
  const double t = b.left.slope / (b.left.slope - b.right.slope);
  return {b.left.s_wheel + t * (b.right.s_wheel - b.left.s_wheel),
          b.left.s_rail + t * (b.right.s_rail - b.left.s_rail)};
}

bool within(const GapBracket& b, double s_wheel) noexcept {
  constexpr double reserve = 1e-12;  // a zero at the bracket's end, to rounding [m]
  return s_wheel >= b.left.s_wheel - reserve && s_wheel <= b.right.s_wheel + reserve;
}

// The online search of one wheel: its scan at a pose.
struct PosedScan {
  const WheelRailPair& pair;
  const ContactScan& scan;
  const WheelsetPose& pose;
  const PoseTrigonometry& trig;
  WheelsetCentre centre = wheelset_centre(pair, pose);
};

// Convex search first (Eqs. 1-4); where its Newton leaves the bracket, the safe search: the deepest of the nearest
// distances, Eqs. 9-10 without their points.
void add_patch(const PosedScan& search, const GapWalk& walk, const GapBracket& bracket, double near_miss,
               ContactPatches& patches) noexcept {
  const auto& [pair, scan, pose, trig, centre] = search;
  const RefinedPair refined = refine_pair(pair, pose, trig, chord_zero(bracket));
  ContactPatch patch = refined.patch;
  if (refined.status != PairStatus::converged || !within(bracket, patch.s_wheel)) {
    const GapSlope zero = walk.solve(bracket);
    if (!zero.exists) return;
    patch = patch_of_pair(pair, pose, trig, {zero.s_wheel, zero.s_rail});
    patch.source = PatchSource::online_concave;
  }
  if (patch.penetration > -near_miss) insert(patches, patch);
}

struct ScanRange {
  int begin, end;  ///< intervals
};

// Which intervals of a scan are searched: those for which wanted(gaps, j) holds, j counting in the block, in the blocks
// for which near(block) holds. The gaps are those of ContactScan::gaps() with this dilation [m].
template <class Near, class Wanted>
struct GapFilter {
  double dilation;
  Near near;
  Wanted wanted;
};
template <class Near, class Wanted>
GapFilter(double, Near, Wanted) -> GapFilter<Near, Wanted>;

// Calls found(bracket) for every minimum of the gap in the intervals of a range that the filter lets pass.
template <class Near, class Wanted, class Found>
void for_each_minimum(const PosedScan& search, ScanRange range, const GapWalk& walk,
                      const GapFilter<Near, Wanted>& filter, Found found) noexcept {
  const ContactScan& scan = search.scan;
  ContactScan::BlockGaps gap;
  GapSlope last;
  int last_point = -1;
  const auto slope_at = [&](int k) {
    if (k == last_point) return last;
    const double s = scan.s_wheel(k);
    const SilhouettePoint S = walk.wheel_point(s);
    const bool next = k == last_point + 1 && last.exists;
    last = walk.at(S, s, next ? last.s_rail + last.s_rail_ds * scan.spacing() : scan.s_rail_at(S.y));
    last_point = k;
    return last;
  };
  constexpr int size = ContactScan::block_size;
  for (int block = range.begin / size; block * size < range.end; ++block) {
    if (!filter.near(block)) continue;
    scan.gaps(block, search.centre, search.trig, filter.dilation, gap);
    const int first = block * size;
    for (int k = std::max(first, range.begin); k < std::min(first + size, range.end); ++k) {
      if (!filter.wanted(gap, k - first)) continue;
      const GapSlope left = slope_at(k);
      const GapSlope right = slope_at(k + 1);
      const GapBracket bracket = walk.bracket(left, right);
      if (bracket.found) found(bracket);
    }
  }
}

}  // namespace

ContactSearch::ContactSearch(WheelRailPair pair, double spacing) : pair_(std::move(pair)), scan_(pair_, spacing) {}

namespace {

void add_patches(const PosedScan& search, ScanRange range, double near_miss, ContactPatches& result) noexcept {
  const auto& [pair, scan, pose, trig, centre] = search;
  const GapWalk walk(pair, pose, trig, Opposite::nearest);
  // A minimum at zero distance stands at most half a spacing from a scan point; 75 degrees make four of the distance.
  const double margin = 2.0 * scan.spacing();
  const GapFilter filter{
      near_miss,
      [&](int block) { return search.scan.gap_bound(block, search.centre, search.trig, near_miss) < margin; },
      [&](const ContactScan::BlockGaps& gap, int j) { return may_touch(gap, j, margin); }};
  for_each_minimum(search, range, walk, filter,
                   [&](const GapBracket& bracket) { add_patch(search, walk, bracket, near_miss, result); });
}

}  // namespace

ContactPatches ContactSearch::patches(const WheelsetPose& pose, double near_miss) const noexcept {
  ContactPatches result;
  const PoseTrigonometry trig(pose);
  add_patches({pair_, scan_, pose, trig}, {0, scan_.blocks() * ContactScan::block_size}, near_miss, result);
  return result;
}

void ContactSearch::add_patches_between(double s_low, double s_high, const WheelsetPose& pose,
                                        const PoseTrigonometry& trig, double near_miss,
                                        ContactPatches& result) const noexcept {
  const double most = static_cast<double>(scan_.blocks() * ContactScan::block_size);
  const auto point = [&](double s) { return std::clamp((s - scan_.s_wheel(0)) / scan_.spacing(), 0.0, most); };
  const ScanRange range{static_cast<int>(point(s_low)), static_cast<int>(std::ceil(point(s_high)))};
  add_patches({pair_, scan_, pose, trig}, range, near_miss, result);
}

namespace {

// A block whose scan points are this much higher than the limit holds no minimum below it [m].
constexpr double block_reserve = 1e-3;

// A lower bound of the gap in interval j of a block, with the bend that its scan points show; infinity without rail.
double lowest_possible(const ContactScan::BlockGaps& gap, int j) noexcept {
  const auto i = static_cast<std::size_t>(j);
  const double left = gap[i + 1];
  const double right = gap[i + 2];
  if (left == infinity || right == infinity) return infinity;
  // A parabola falls by an eighth of its second difference below its points, a kink by half of it.
  const double bend = std::max({0.0, gap[i] - 2.0 * left + right, left - 2.0 * right + gap[i + 3]});
  return std::min(left, right) - 0.5 * bend - 2.0 * height_error;
}

// Calls found(TouchPoint) for every minimum of the vertical gap that can be less than `height` above the least.
template <class Found>
void for_each_touch(const PosedScan& search, double height, Found found) noexcept {
  const ContactScan& scan = search.scan;
  double least = infinity;
  ContactScan::BlockGaps gap;
  std::array<double, ContactScan::most_blocks> block_least;  // or a lower bound of it
  for (int block = 0; block < scan.blocks(); ++block) {
    double& bound = block_least[static_cast<std::size_t>(block)];
    bound = scan.gap_bound(block, search.centre, search.trig, 0.0);
    if (bound >= least) continue;
    scan.gaps(block, search.centre, search.trig, 0.0, gap);
    bound = *std::min_element(gap.begin(), gap.end());
    least = std::min(least, bound);
  }
  if (least == infinity) return;
  const GapWalk walk(search.pair, search.pose, search.trig, Opposite::vertical);
  const GapFilter filter{
      0.0, [&](int block) { return block_least[static_cast<std::size_t>(block)] < least + height + block_reserve; },
      [&](const ContactScan::BlockGaps& g, int j) { return lowest_possible(g, j) < least + height; }};
  for_each_minimum(search, {0, scan.blocks() * ContactScan::block_size}, walk, filter, [&](const GapBracket& bracket) {
    const RefinedTouch refined = refine_touch(search.pair, search.pose, search.trig, chord_zero(bracket));
    if (refined.status == PairStatus::converged && within(bracket, refined.touch.s_wheel)) {
      found(refined.touch);
      return;
    }
    const GapSlope zero = walk.solve(bracket);
    if (zero.exists) {
      found(touch_of_pair(search.pair, search.pose, search.trig, {zero.s_wheel, zero.s_rail}));
    }
  });
}

void insert(TouchPoints& touches, const TouchPoint& touch) noexcept {
  TouchPoint* const begin = touches.touch.data();
  TouchPoint* end = begin + touches.count;
  if (touches.count > 0 && std::abs((end - 1)->s_wheel - touch.s_wheel) < 1e-9) return;
  if (touches.count == TouchPoints::capacity) {
    touches.overflow = true;
    TouchPoint* const highest =
        std::max_element(begin, end, [](const TouchPoint& p, const TouchPoint& q) { return p.z_touch < q.z_touch; });
    if (highest->z_touch <= touch.z_touch) return;
    std::move(highest + 1, end, highest);
    --end;
    --touches.count;
  }
  *end = touch;
  ++touches.count;
}

}  // namespace

TouchPoints ContactSearch::touches(double y, double roll, double yaw, double height) const noexcept {
  const WheelsetPose pose{y, 0.0, roll, yaw};
  TouchPoints result;
  double least = infinity;
  const PoseTrigonometry trig(pose);
  for_each_touch({pair_, scan_, pose, trig}, height, [&](const TouchPoint& touch) {
    least = std::min(least, touch.z_touch);
    insert(result, touch);
  });
  TouchPoint* const begin = result.touch.data();
  TouchPoint* const end =
      std::remove_if(begin, begin + result.count, [&](const TouchPoint& t) { return t.z_touch > least + height; });
  result.count = static_cast<int>(end - begin);
  return result;
}

TouchPoint ContactSearch::first_touch(double y, double roll, double yaw) const noexcept {
  const WheelsetPose pose{y, 0.0, roll, yaw};
  TouchPoint result;
  result.z_touch = std::numeric_limits<double>::quiet_NaN();
  const PoseTrigonometry trig(pose);
  for_each_touch({pair_, scan_, pose, trig}, 0.0, [&](const TouchPoint& touch) {
    if (!(touch.z_touch >= result.z_touch)) result = touch;
  });
  return result;
}

double ContactSearch::touch_height(double y, double roll, double yaw) const noexcept {
  return first_touch(y, roll, yaw).z_touch;
}

}  // namespace railtab
