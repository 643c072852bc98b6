#include "railtab/tablegen/intersection/outline_overlap.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "railtab/runtime/contact/wheel_silhouette.hpp"

namespace railtab {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// Points of the wheel are first looked at by so many together. Their chord is 0.5 µm off.
constexpr std::size_t block = 16;
constexpr double block_margin = 20e-6;  // m

/// Points of a curve whose chords are off by no more than chord_error.
std::vector<CurvePoint> points_of(const ProfileCurve& curve) {
  constexpr double longest = 0.5e-3;  // m
  const std::vector<double>& knot = curve.knots().s;
  std::vector<CurvePoint> points{curve.at(knot.front())};
  for (std::size_t k = 0; k + 1 < knot.size(); ++k) {
    const double length = knot[k + 1] - knot[k];
    double bend = 0.0;
    for (const double part : {0.0, 0.5, 1.0}) {
      const CurvePoint p = curve.on_piece(k, knot[k] + part * length);
      bend = std::max(bend, std::hypot(p.ddy, p.ddz));
    }
    const double step = std::min(longest, std::sqrt(8.0 * OutlineOverlap::chord_error / std::max(bend, 1e-9)));
    const int chords = static_cast<int>(std::ceil(length / step));
    for (int n = 1; n <= chords; ++n) points.push_back(curve.on_piece(k, knot[k] + length * n / chords));
  }
  return points;
}

}  // namespace

OutlineOverlap::OutlineOverlap(const WheelRailPair& pair) : pair_(pair), wheel_(points_of(pair.wheel())) {
  const std::vector<CurvePoint> rail = points_of(pair.rail());
  const auto top = std::min_element(rail.begin(), rail.end(), [](const auto& a, const auto& b) { return a.z < b.z; });
  auto first = top, last = top;
  while (first != rail.begin() && (first - 1)->y < first->y) --first;
  while (last + 1 != rail.end() && (last + 1)->y > last->y) ++last;
  for (auto p = first; p <= last; ++p) rail_.push_back({p->y, p->z});
}

/// Whether the wheel between two of its points can be below the rail's surface: by boxes.
bool OutlineOverlap::may_overlap(const Point& a, const Point& b) const {
  const double low = std::min(a.y, b.y) - block_margin, high = std::max(a.y, b.y) + block_margin;
  const double lowest = std::max(a.z, b.z) + block_margin;
  auto from = std::lower_bound(rail_.begin(), rail_.end(), low, [](const Point& p, double y) { return p.y < y; });
  auto to = std::upper_bound(from, rail_.end(), high, [](double y, const Point& p) { return y < p.y; });
  if (from == rail_.end() || to == rail_.begin()) return false;
  if (from != rail_.begin()) --from;
  if (to != rail_.end()) ++to;
  return std::any_of(from, to, [&](const Point& p) { return p.z < lowest; });
}

std::vector<OverlapRegion> OutlineOverlap::regions(const WheelsetPose& pose) const {
  const PoseTrigonometry trigonometry(pose);
  const WheelsetCentre centre = wheelset_centre(pair_, pose);
  const auto silhouette = [&](std::size_t n) -> std::optional<Point> {
    const SilhouettePoint p =
        silhouette_point(wheel_[n], pair_.tape_circle_offset(), pair_.nominal_radius(), trigonometry);
    if (!p.exists || p.speed <= 0.0) return std::nullopt;  // not on the visible outline
    const PlaneVector<double> at = in_rail_head(p.y, p.z, centre, trigonometry);
    return Point{at.y, at.z};
  };
  std::vector<OverlapRegion> found;
  std::vector<Point> run;
  const auto end_run = [&] {
    sweep(run, found);
    run.clear();
  };
  const std::size_t last = wheel_.size() - 1;
  std::optional<Point> begin = silhouette(0);
  for (std::size_t n = 0; n < last; n += block) {
    const std::size_t end = std::min(n + block, last);
    const std::optional<Point> next = silhouette(end);
    if (begin && next && !may_overlap(*begin, *next)) {
      end_run();
    } else if (begin || next) {
      for (std::size_t k = run.empty() ? n : n + 1; k <= end; ++k) {
        const std::optional<Point> p = silhouette(k);
        if (!p || (!run.empty() && p->y <= run.back().y)) end_run();
        if (p) run.push_back(*p);
      }
    }
    begin = next;
  }
  end_run();
  // Runs that turn back over each other, at large yaw, may have found one region twice.
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.y_low < b.y_low; });
  std::vector<OverlapRegion> apart;
  for (const OverlapRegion& r : found) {
    if (apart.empty() || r.y_low >= apart.back().y_high) {
      apart.push_back(r);
      continue;
    }
    OverlapRegion& whole = apart.back();
    whole = {whole.y_low, std::max(whole.y_high, r.y_high), std::max(whole.height, r.height),
             std::max(whole.depth, r.depth)};
  }
  return apart;
}

/// Both chains in the order of y; between two points that follow each other both are straight, so that the outlines
/// cross there once at most.
void OutlineOverlap::sweep(std::span<const Point> wheel, std::vector<OverlapRegion>& found) const {
  const auto exact = [](const Point& p) { return Kernel::Point_2(p.y, p.z); };
  if (wheel.empty()) return;
  bool open = false;
  double before = std::max(wheel.front().y, rail_.front().y);
  // A point of one outline at the chord from a to b of the other.
  const auto event = [&](const Point& at, const Point& a, const Point& b, bool overlaps) {
    if (overlaps && !open) found.push_back({before, at.y, 0.0, 0.0});
    if (overlaps || open) found.back().y_high = at.y;
    before = at.y;
    open = overlaps;
    if (!overlaps) return;
    const double slope = (b.z - a.z) / (b.y - a.y);
    const double height = std::abs(at.z - (a.z + slope * (at.y - a.y)));
    found.back().height = std::max(found.back().height, height);
    found.back().depth = std::max(found.back().depth, height / std::sqrt(1.0 + slope * slope));
  };
  const auto after = [](std::span<const Point> chain, double y) {
    return static_cast<std::size_t>(
        std::upper_bound(chain.begin(), chain.end(), y, [](double at, const Point& p) { return at < p.y; }) -
        chain.begin());
  };
  std::size_t i = after(wheel, std::nextafter(rail_.front().y, -1.0)), j = after(rail_, wheel.front().y);
  if (i > 0) j = 0;  // the rail begins within the wheel
  while (i < wheel.size() && j < rail_.size()) {
    if (j > 0 && wheel[i].y <= rail_[j].y) {
      const Point &a = rail_[j - 1], &b = rail_[j], &w = wheel[i++];
      event(w, a, b, CGAL::orientation(exact(a), exact(b), exact(w)) == CGAL::LEFT_TURN);
    } else {
      const Point& r = rail_[j++];
      const Point &a = wheel[i - 1], &b = wheel[i];
      event(r, a, b, CGAL::orientation(exact(a), exact(b), exact(r)) == CGAL::RIGHT_TURN);
    }
  }
}

RegionComparison compare(std::span<const OverlapRegion> regions, const ContactPatches& patches) noexcept {
  constexpr double near = 1e-6;  // m: regions are known to their points
  RegionComparison result;
  std::array<bool, ContactPatches::capacity> placed{};
  const auto without = [&](double depth, double height) {
    if (depth < RegionComparison::band) {
      result.in_band = true;
      return;
    }
    result.mismatch = true;
    result.height = std::max(result.height, height);
  };
  for (const OverlapRegion& region : regions) {
    bool held = false;
    for (int n = 0; n < patches.count; ++n) {
      const double y = patches.patch[n].y_rail;
      if (y < region.y_low - near || y > region.y_high + near) continue;
      held = placed[n] = true;
    }
    if (!held) without(region.depth, region.height);
  }
  for (int n = 0; n < patches.count; ++n) {
    const ContactPatch& patch = patches.patch[n];
    if (!placed[n] && patch.penetration > 0.0) without(patch.penetration, patch.penetration / std::cos(patch.angle));
  }
  result.in_band = result.in_band && !result.mismatch;
  return result;
}

}  // namespace railtab
