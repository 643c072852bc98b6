#include "railtab/runtime/contact/patch_loads.hpp"

#include <algorithm>
#include <cmath>

#include "railtab/runtime/contact/overlap.hpp"

namespace railtab {

namespace {

/// Share of the penetration, from the deepest point up, over which the overlap's area counts: chosen by half-space
/// solutions (docs/theory/normal_contact.md, section 5).
constexpr double counted_share = 0.7;
/// Below this penetration the overlap is narrower than any detail of a profile [m].
constexpr double least_penetration = 1e-9;

double power_3_2(double d) { return d > 0.0 ? d * std::sqrt(d) : 0.0; }

/// Between two neighbouring patches whose penetrations are both positive.
struct Junction {
  bool loaded = false;  ///< otherwise nothing below holds
  OverlapPoint saddle{};
  double left_share = 0.0;   ///< of d_s^{3/2}, what the left patch leaves to the other: w_left of patch_loads()
  double right_share = 0.0;  ///< likewise
  /// How far the shallower patch has become part of the deeper one: 0 where the saddle is at the deeper patch's level
  /// or both are equally deep, 1 where the shallower one vanishes in the saddle.
  double merged = 0.0;
};

double level_of(const ContactPatch& patch) { return (1.0 - counted_share) * patch.penetration; }

Junction junction(const Overlap& overlap, const ContactPatch& left, const ContactPatch& right) {
  Junction result;
  result.loaded = left.penetration > 0.0 && right.penetration > 0.0;
  if (!result.loaded) return result;
  result.saddle = overlap.saddle(left, right);
  const double saddle = result.saddle.penetration;
  const double left_rise = std::max(left.penetration - saddle, 0.0);
  const double right_rise = std::max(right.penetration - saddle, 0.0);
  const double both = left_rise + right_rise;
  result.left_share = both > 0.0 ? right_rise / both : 0.5;
  result.right_share = 1.0 - result.left_share;
  const bool left_deeper = left.penetration >= right.penetration;
  const ContactPatch& shallow = left_deeper ? right : left;
  const double level = level_of(left_deeper ? left : right);
  if (saddle <= level) return result;
  const double one_sided = 1.0 - 2.0 * std::min(result.left_share, result.right_share);
  result.merged = one_sided * one_sided * (saddle - level) / (shallow.penetration - level);
  return result;
}

/// What lies at one side of a patch.
struct Neighbourhood {
  const Junction* junction = nullptr;  ///< none where the patch is the last on that side
  const ContactPatch* patch = nullptr;
};

/// Where the counted overlap ends on one side.
struct Side {
  OverlapFlank flank;
  double saddle = 0.0;  ///< with merged > 0: the end without what the vanishing neighbour adds [m]
  double merged = 0.0;  ///< how much of that counts, see Junction
};

Side counted_side(const ProfileCurve& wheel, const ContactPatch& patch, int direction, const Neighbourhood& side) {
  const double edge = direction > 0 ? wheel.s_end() : wheel.s_begin();
  if (!side.junction || !side.junction->loaded) return {{&patch, edge}};
  const OverlapPoint& saddle = side.junction->saddle;
  if (saddle.penetration <= level_of(patch)) return {{&patch, saddle.s_wheel}};
  const ContactPatch& other = *side.patch;
  const double merged = patch.penetration >= other.penetration ? side.junction->merged : 0.0;
  if (merged <= 0.0) return {{&patch, saddle.s_wheel, false}};
  return {{&other, edge}, saddle.s_wheel, merged};
}

/// Both sides of a patch, and what it shares with its neighbours.
struct Surroundings {
  Neighbourhood left, right;
  double shared = 0.0;  ///< w_i d_s^{3/2} of patch_loads(), the larger of both sides
  double own = 1.0;     ///< share of the force that a patch does not yield to deeper neighbours
};

/// The deepest part of a patch's overlap.
OverlapArea counted_area(const Overlap& overlap, const ProfileCurve& wheel, const ContactPatch& patch,
                         const Surroundings& around) {
  const Side low = counted_side(wheel, patch, -1, around.left);
  const Side high = counted_side(wheel, patch, 1, around.right);
  const OverlapEnds ends = overlap.ends(level_of(patch), low.flank, high.flank);
  const double low_end = low.merged > 0.0 ? low.saddle : ends.low;
  const double high_end = high.merged > 0.0 ? high.saddle : ends.high;
  const auto between = [&](double from, double to) { return overlap.area(patch, level_of(patch), from, to); };
  const OverlapArea inner = between(low_end, high_end);
  OverlapArea sum = inner;
  const auto add = [&](double merged, const OverlapArea& with_neighbour) {
    sum.area += merged * (with_neighbour.area - inner.area);
    sum.moment += merged * (with_neighbour.moment - inner.moment);
  };
  if (low.merged > 0.0) add(low.merged, between(ends.low, high_end));
  if (high.merged > 0.0) add(high.merged, between(low_end, ends.high));
  return sum;
}

/// B of the parabola that has the overlap's area between the deepest point and (1 - kappa) d: with
/// area = (4/3) kappa d w and kappa d = B w².
double overlap_curvature(double penetration, double area) {
  const double half_width = 0.75 * area / (counted_share * penetration);
  return counted_share * penetration / (half_width * half_width);
}

PatchLoad load(const NormalContactModel& model, const ContactPatch& patch, double B, double shared) {
  PatchLoad result;
  result.hertz = hertz_contact(0.5 * patch.curv_rolling, std::max(B, model.curvature_floor), model.material);
  result.elastic_force = result.hertz.stiffness * std::max(power_3_2(patch.penetration) - shared, 0.0);
  result.contact = patch;
  return result;
}

/// The load of the true overlap, at its centre.
PatchLoad overlap_load(const NormalContactModel& model, const Overlap& overlap, const ProfileCurve& wheel,
                       const ContactPatch& patch, const Surroundings& around) {
  if (patch.penetration <= least_penetration) {
    return load(model, patch, 0.5 * (patch.curv_wheel + patch.curv_rail), around.shared);
  }
  const OverlapArea counted = counted_area(overlap, wheel, patch, around);
  if (!(counted.area > 0.0)) return load(model, patch, model.curvature_floor, around.shared);
  PatchLoad result = load(model, patch, overlap_curvature(patch.penetration, counted.area), around.shared);
  result.contact = overlap.pair_at(patch, patch.s_wheel + counted.moment / counted.area);
  return result;
}

PatchLoads published_loads(const NormalContactModel& model, const ContactPatches& patches) {
  PatchLoads loads(patches.count);
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const ContactPatch& patch = patches.patch[i];
    loads[i] = load(model, patch, 0.5 * (patch.curv_wheel + patch.curv_rail), 0.0);
  }
  return loads;
}

}  // namespace

PatchLoads patch_loads(const NormalContactModel& model, const ContactGeometry& geometry, const WheelsetPose& pose,
                       const ContactPatches& patches) noexcept {
  if (geometry.is_paper()) return published_loads(model, patches);
  const WheelRailPair& pair = geometry.pair();
  const Overlap overlap(pair, pose);
  const auto count = static_cast<std::size_t>(patches.count);
  std::array<Junction, ContactPatches::capacity> junctions{};  // i: between patches i and i + 1
  for (std::size_t i = 0; i + 1 < count; ++i) {
    junctions[i] = junction(overlap, patches.patch[i], patches.patch[i + 1]);
  }
  PatchLoads loads(patches.count);
  for (std::size_t i = 0; i < count; ++i) {
    const ContactPatch& patch = patches.patch[i];
    Surroundings around;
    if (i > 0) {
      const Neighbourhood& left = around.left = {&junctions[i - 1], &patches.patch[i - 1]};
      around.shared = left.junction->right_share * power_3_2(left.junction->saddle.penetration);
      if (left.patch->penetration >= patch.penetration) around.own *= 1.0 - left.junction->merged;
    }
    if (i + 1 < count) {
      const Neighbourhood& right = around.right = {&junctions[i], &patches.patch[i + 1]};
      around.shared =
          std::max(around.shared, right.junction->left_share * power_3_2(right.junction->saddle.penetration));
      if (right.patch->penetration > patch.penetration) around.own *= 1.0 - right.junction->merged;
    }
    loads[i] = overlap_load(model, overlap, pair.wheel(), patch, around);
    loads[i].elastic_force *= around.own;
  }
  return loads;
}

}  // namespace railtab
