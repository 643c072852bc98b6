#include "railtab/runtime/contact/paper_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "railtab/runtime/base/constants.hpp"
#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

namespace {

// A wheel with less curvature is straight: its curvature's sign is rounding [1/m].
constexpr double straightness = 1e-6;

double between(double y, double y0, double z0, double y1, double z1) noexcept {
  return z0 + (y - y0) * (z1 - z0) / (y1 - y0);
}

// Foot of a point on the line from 0 to 1: its place there, 0..1, and squared distance.
struct Foot {
  double share, distance2;
};

Foot foot_on_line(double y, double z, double y0, double z0, double y1, double z1) noexcept {
  const double dy = y1 - y0, dz = z1 - z0;
  const double share = std::clamp(((y - y0) * dy + (z - z0) * dz) / (dy * dy + dz * dz), 0.0, 1.0);
  const double off_y = y0 + share * dy - y, off_z = z0 + share * dz - z;
  return {share, off_y * off_y + off_z * off_z};
}

}  // namespace

// The wheel's points inside the rail.
struct PaperSearch::OverlapPoints {
  std::array<double, most_points> y, z;
  std::array<int, most_points> index;
  int count = 0;

  void add(double y_point, double z_point, int i) noexcept {
    const auto n = static_cast<std::size_t>(count++);
    y[n] = y_point;
    z[n] = z_point;
    index[n] = i;
  }
};

// The wheel's points at a pose, rail-head frame; z = -infinity where the section has no silhouette point.
struct PaperSearch::Outline {
  std::array<double, most_points> y, z, gap;  // gap: vertical distance down to the rail, infinity beside it
};

PaperSearch::PaperSearch(WheelRailPair pair, int points, PaperDistance distance)
    : pair_(std::move(pair)), distance_(distance) {
  if (points < 10 || points > most_points) {
    throw input_error("points of the published contact search", fmt::format("{}", points),
                      fmt::format("10 to {}", most_points));
  }
  const ProfileCurve& wheel = pair_.wheel();
  const ProfileCurve& rail = pair_.rail();
  double sharpest = -infinity;
  for (int i = 0; i < points; ++i) {
    const double t = static_cast<double>(i) / (points - 1);
    const double s = wheel.s_begin() + t * (wheel.s_end() - wheel.s_begin());
    const CurvePoint p = wheel.at(s);
    const double axial = pair_.tape_circle_offset() + p.y;
    if (!(p.dy > 0.0) || (!wheel_.empty() && axial <= wheel_.back().axial)) continue;
    wheel_.push_back({s, axial, pair_.nominal_radius() + p.z, p.dz / p.dy});
    // Concave is positive for a wheel: the root between flange and tread.
    if (p.curvature() > sharpest) {
      sharpest = p.curvature();
      split_ = wheel_.size() - 1;
    }
  }
  for (int i = 0; i < points; ++i) {
    const double t = static_cast<double>(i) / (points - 1);
    const double s = rail.s_begin() + t * (rail.s_end() - rail.s_begin());
    const CurvePoint p = rail.at(s);
    if (p.dy > 0.0 && (rail_.empty() || p.y > rail_.back().y)) rail_.push_back({s, p.y, p.z});
  }
  if (wheel_.size() < 4 || rail_.size() < 4) {
    throw input_error("points of the published contact search", "profiles that face each other in less than 4 points",
                      "a wheel's lower and a rail's upper outline");
  }
}

void PaperSearch::place(const WheelsetPose& pose, const PoseTrigonometry& trig, Outline& outline) const noexcept {
  const WheelsetCentre centre = wheelset_centre(pair_, pose);
  std::size_t r = 0;
  for (std::size_t i = 0; i < wheel_.size(); ++i) {
    const WheelSample& w = wheel_[i];
    const double w2 = silhouette_cosine2(w.slope, trig);
    const PlaneVector<double> at = in_rail_head(silhouette_y(w.axial, w.radius, w.slope, trig),
                                                w.radius * std::sqrt(std::max(w2, 0.0)), centre, trig);
    outline.y[i] = at.y;
    outline.z[i] = w2 > 0.0 ? at.z : -infinity;
    // Eq. 6: the rail's point straight below. The outline may step back where yaw folds it: the pointer follows.
    while (r + 2 < rail_.size() && rail_[r + 1].y < outline.y[i]) ++r;
    while (r > 0 && rail_[r].y > outline.y[i]) --r;
    const RailSample& a = rail_[r];
    const RailSample& b = rail_[r + 1];
    const bool beside = outline.y[i] < a.y || outline.y[i] > b.y;
    outline.gap[i] = beside ? infinity : between(outline.y[i], a.y, a.z, b.y, b.z) - outline.z[i];
  }
}

ContactPatches PaperSearch::patches(const WheelsetPose& pose) const noexcept {
  const PoseTrigonometry trig(pose);
  Outline wheel;
  place(pose, trig, wheel);
  ContactPatches result;
  const int split = static_cast<int>(split_);
  add_contact(pose, trig, wheel, {0, split}, result);
  add_contact(pose, trig, wheel, {split, static_cast<int>(wheel_.size()) - 1}, result);
  std::sort(result.patch.data(), result.patch.data() + result.count,
            [](const ContactPatch& p, const ContactPatch& q) { return p.y_rail < q.y_rail; });
  return result;
}

void PaperSearch::add_contact(const WheelsetPose& pose, const PoseTrigonometry& trig, const Outline& wheel, Zone zone,
                              ContactPatches& patches) const noexcept {
  const double* const gap = wheel.gap.data();
  const int least = static_cast<int>(std::min_element(gap + zone.first, gap + zone.last + 1) - gap);
  if (least == zone.first || least == zone.last || gap[least] == infinity) return;
  const auto start = static_cast<std::size_t>(least);
  const auto below = std::lower_bound(rail_.begin(), rail_.end(), wheel.y[start],
                                      [](const RailSample& r, double y) { return r.y < y; });
  const double s_rail = below == rail_.end() ? rail_.back().s : below->s;
  const RefinedPair convex = refine_pair(pair_, pose, trig, {wheel_[start].s, s_rail});
  const double s_first = wheel_[static_cast<std::size_t>(zone.first)].s;
  const double s_last = wheel_[static_cast<std::size_t>(zone.last)].s;
  const bool found = convex.status == PairStatus::converged && convex.patch.s_wheel >= s_first &&
                     convex.patch.s_wheel <= s_last && convex.patch.curv_wheel > -straightness;  // Eq. 2
  if (!found) {
    add_overlap(pose, trig, wheel, zone, patches);
  } else if (convex.patch.penetration > 0.0) {  // Eq. 3
    patches.patch[static_cast<std::size_t>(patches.count++)] = convex.patch;
  }
}

// Eq. 9: the nearest of the points. Two passes, the first a plain reduction that vectorises.
PaperSearch::WheelPair PaperSearch::nearest_point(const OverlapPoints& points, const RailSample& rail) const noexcept {
  const auto n = static_cast<std::size_t>(points.count);
  const auto distance2 = [&](std::size_t j) {
    const double dy = points.y[j] - rail.y, dz = points.z[j] - rail.z;
    return dy * dy + dz * dz;
  };
  double least = infinity;
  for (std::size_t j = 0; j < n; ++j) {
    const double d2 = distance2(j);
    least = d2 < least ? d2 : least;
  }
  std::size_t j = 0;
  while (j + 1 < n && distance2(j) > least) ++j;
  return {wheel_[static_cast<std::size_t>(points.index[j])].s, least};
}

// The nearest place on the wheel's lines, from wheel point w downhill.
PaperSearch::WheelPair PaperSearch::nearest_on_outline(const Outline& wheel, Zone zone, std::size_t w,
                                                       const RailSample& rail) const noexcept {
  const auto first = static_cast<std::size_t>(zone.first), last = static_cast<std::size_t>(zone.last);
  const auto distance2 = [&](std::size_t i) {
    const double dy = wheel.y[i] - rail.y, dz = wheel.z[i] - rail.z;
    return dy * dy + dz * dz;
  };
  while (w < last && distance2(w + 1) < distance2(w)) ++w;
  while (w > first && distance2(w - 1) < distance2(w)) --w;
  WheelPair best{wheel_[w].s, infinity};
  for (std::size_t i = w > first ? w - 1 : w; i <= w && i < last; ++i) {
    if (wheel.z[i] == -infinity || wheel.z[i + 1] == -infinity) continue;
    const Foot foot = foot_on_line(rail.y, rail.z, wheel.y[i], wheel.z[i], wheel.y[i + 1], wheel.z[i + 1]);
    if (foot.distance2 >= best.distance2) continue;
    best = {wheel_[i].s + foot.share * (wheel_[i + 1].s - wheel_[i].s), foot.distance2};
  }
  return best;
}

void PaperSearch::add_overlap(const WheelsetPose& pose, const PoseTrigonometry& trig, const Outline& wheel, Zone zone,
                              ContactPatches& patches) const noexcept {
  OverlapPoints inside;  // Eqs. 6, 8
  for (int j = zone.first; j <= zone.last; ++j) {
    const auto i = static_cast<std::size_t>(j);
    if (wheel.gap[i] < 0.0) inside.add(wheel.y[i], wheel.z[i], j);
  }
  if (distance_ == PaperDistance::points && inside.count == 0) return;
  double deepest2 = -1.0;
  double s_wheel = 0.0;
  std::size_t rail_index = 0;
  auto j = static_cast<std::size_t>(zone.first);
  for (std::size_t i = 0; i < rail_.size(); ++i) {
    const RailSample& r = rail_[i];
    while (j + 1 < static_cast<std::size_t>(zone.last) && wheel.y[j + 1] < r.y) ++j;
    if (r.y < wheel.y[j] || r.y > wheel.y[j + 1]) continue;
    // Eqs. 5, 7: the rail's point lies inside the wheel where the wheel's outline is below it.
    if (!(between(r.y, wheel.y[j], wheel.z[j], wheel.y[j + 1], wheel.z[j + 1]) > r.z)) continue;
    const WheelPair pair =
        distance_ == PaperDistance::points ? nearest_point(inside, r) : nearest_on_outline(wheel, zone, j, r);
    if (pair.distance2 == infinity || pair.distance2 <= deepest2) continue;  // Eq. 10
    deepest2 = pair.distance2;
    s_wheel = pair.s;
    rail_index = i;
  }
  if (deepest2 < 0.0) return;
  ContactPatch patch = patch_of_pair(pair_, pose, trig, {s_wheel, rail_[rail_index].s});
  patch.penetration = std::sqrt(deepest2);
  patch.source = PatchSource::online_concave;
  patches.patch[static_cast<std::size_t>(patches.count++)] = patch;
}

}  // namespace railtab
