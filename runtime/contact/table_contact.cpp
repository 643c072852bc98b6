#include "railtab/runtime/contact/table_contact.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "railtab/runtime/base/input_error.hpp"
#include "railtab/runtime/contact/polish_step.hpp"

namespace railtab {

namespace {

/// The walks along a profile count its knots in steps of length. @throws InputError where a knot lies far off
void require_near(const ProfileKnots& profile) {
  constexpr double farthest = 1.0, steepest = 2.0;  // m; of dy/ds and dz/ds, whose squares sum to 1
  for (std::size_t i = 0; i < profile.s.size(); ++i) {
    const bool near = std::abs(profile.y[i]) <= farthest && std::abs(profile.z[i]) <= farthest &&
                      std::abs(profile.dy[i]) <= steepest && std::abs(profile.dz[i]) <= steepest;
    if (near) continue;
    throw input_error(fmt::format("profile {}, knot {}", profile.name, i),
                      fmt::format("({:.6g}, {:.6g}) m, slopes {:.6g} and {:.6g}", profile.y[i], profile.z[i],
                                  profile.dy[i], profile.dz[i]),
                      "a place within 1 m and slopes of an arc length");
  }
}

WheelRailPair pair_of(const GeometryTableData& data) {
  require_near(data.wheel);
  require_near(data.rail);
  PairDimensions dimensions;
  dimensions.track_gauge = data.track_gauge;
  dimensions.gauge_height = data.gauge_height;
  dimensions.flange_back = data.flange_back;
  dimensions.nominal_radius = data.nominal_radius;
  return {ProfileCurve(data.wheel), ProfileCurve(data.rail), dimensions};
}

/// Allowance for the error of z_touch when branches are picked [m]: a branch too many costs one Newton.
constexpr double height_margin = 12e-6;
/// A refined pair further from its start than this is another branch's [m].
constexpr double capture_distance = 0.5e-3;
/// Two refined pairs nearer than this are one [m].
constexpr double same_pair = 5e-6;

/// Largest vertical height per unit of normal distance on any branch, 1/n_z, from the slope of z_touch along the
/// lateral axis in the middle of its leaf.
double steepest_branch(const GeometryTable& table) {
  const GeometryTableData& data = table.data();
  const std::span<const float> coefficients = table.coefficients();
  const int terms = branch_terms(!data.yaw_squared.fixed(), !data.roll.fixed());
  const int linear_term = terms == 4 ? 1 : 3;
  std::vector<std::size_t> first(data.leaf_branch.size() + 1, 0);
  for (std::size_t n = 0; n < data.leaf_branch.size(); ++n) first[n + 1] = first[n] + data.leaf_branch[n];
  // Nodes stand before their halves: one pass makes the widths of all.
  std::vector<double> half_width(data.node.size(), 0.5 * (data.lateral.high - data.lateral.low) / data.lateral.cells);
  double steepest = 0.0;
  for (std::size_t n = 0; n < data.node.size(); ++n) {
    const std::size_t index = CellNode::index(data.node[n]);
    if (!CellNode::is_leaf(data.node[n])) {
      const double half = half_width[n] * (CellNode::axis(data.node[n]) == 0 ? 0.5 : 1.0);
      half_width[index] = half_width[index + 1] = half;
      continue;
    }
    for (std::size_t branch = first[index]; branch < first[index + 1]; ++branch) {
      const auto place = branch_quantities * (branch * static_cast<std::size_t>(terms) + linear_term);
      steepest = std::max(steepest, std::abs(static_cast<double>(coefficients[place])) / half_width[n]);
    }
  }
  constexpr double off_middle = 1.1;  // it is a little steeper elsewhere in the leaf
  constexpr double most = 10.0;       // beyond that, a gap to a wall
  return std::min(most, off_middle * std::hypot(1.0, steepest));
}

}  // namespace

TableContact::TableContact(GeometryTable table)
    : table_(std::move(table)), search_(pair_of(table_.data())), steepest_(steepest_branch(table_)) {}

[[gnu::flatten]] ContactPatches TableContact::patches(const WheelsetPose& pose, double near_miss) const noexcept {
  ContactPatches result;
  if (!patches_from_table(pose, near_miss, result)) [[unlikely]] {
    result = search_.patches(pose, near_miss);
  }
  return result;
}

[[gnu::flatten]] TableAnswer TableContact::answer(const WheelsetPose& pose, double near_miss,
                                                  ContactPatches& result) const noexcept {
  const GeometryLeaf leaf = table_.leaf(pose.y, pose.yaw, pose.roll);
  if (leaf.count == 0) return TableAnswer::none;
  return add_branch_patches(search_, leaf, pose, pose.z + near_miss * steepest_, near_miss, result);
}

namespace {

/// Starts without a pair of their own: the search covers 0.5 mm of the wheel profile on both sides of each.
struct UnmatchedStarts {
  std::array<double, GeometryTable::max_branches> s_wheel;
  int count = 0;
};

[[gnu::noinline, gnu::cold]] TableAnswer search_about(const UnmatchedStarts& unmatched, const ContactSearch& search,
                                                      const WheelsetPose& pose, double near_miss,
                                                      ContactPatches& result) noexcept {
  const PoseTrigonometry trig(pose);
  for (int n = 0; n < unmatched.count; ++n) {
    search.add_patches_between(unmatched.s_wheel[n] - capture_distance, unmatched.s_wheel[n] + capture_distance, pose,
                               trig, near_miss, result);
  }
  for (int n = 0; n < result.count; ++n) result.patch[n].source = PatchSource::table;
  // Where profiles nearly conform, a pair can be farther from its start: a wheel without any patch is searched whole.
  return result.overflow || result.count == 0 ? TableAnswer::none : TableAnswer::searched;
}

}  // namespace

TableAnswer add_branch_patches(const ContactSearch& search, const GeometryLeaf& leaf, const WheelsetPose& pose,
                               double height, double near_miss, ContactPatches& result) noexcept {
  static_assert(GeometryTable::max_branches <= ContactPatches::capacity);
  const WheelRailPair& pair = search.pair();
  const WheelsetCentre centre = wheelset_centre(pair, pose);
  const PoseTrigonometry trig(pose);
  double first_touch = std::numeric_limits<double>::infinity();
  UnmatchedStarts unmatched;
  for (int n = 0; n < leaf.count; ++n) {
    const BranchStart start = leaf.start(n, pose.z);
    first_touch = std::min(first_touch, start.z_touch);
    if (start.z_touch > height + height_margin) continue;
    ContactPatch& patch = result.patch[result.count];
    bool own = polish::polished(pair, centre, trig, {start.s_wheel, start.s_rail}, patch) == PairStatus::converged &&
               std::abs(patch.s_wheel - start.s_wheel) <= capture_distance;
    for (int m = 0; m < result.count && own; ++m) own = std::abs(result.patch[m].s_wheel - patch.s_wheel) >= same_pair;
    if (!own) [[unlikely]] {
      unmatched.s_wheel[unmatched.count++] = start.s_wheel;
      continue;
    }
    if (patch.penetration <= -near_miss) continue;
    patch.source = PatchSource::table;
    // The branches of a leaf stand in increasing s_rail, so this is rare.
    for (int place = result.count++; place > 0 && result.patch[place - 1].y_rail > result.patch[place].y_rail;
         --place) {
      std::swap(result.patch[place - 1], result.patch[place]);
    }
  }
  // A limit of 0 is a branch that may touch before all of these: it is to be searched at any height.
  const auto trusted = static_cast<double>(leaf.trusted_lowering);
  if (!(trusted > 0 && height - first_touch <= trusted)) [[unlikely]]
    return TableAnswer::none;
  result.from_table = true;
  if (unmatched.count == 0) [[likely]]
    return TableAnswer::looked_up;
  return search_about(unmatched, search, pose, near_miss, result);
}

}  // namespace railtab
