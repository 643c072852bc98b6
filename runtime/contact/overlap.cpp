#include "railtab/runtime/contact/overlap.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "railtab/runtime/contact/common_normal.hpp"

namespace railtab {

namespace {

/// Points side by side: divisions and roots of several points run in parallel.
using Eight = Eigen::Array<double, 8, 1>;
using LanePieces = std::array<std::size_t, 8>;

// Newton's method finds the foot point on the rail. Its last step is not evaluated again where the penetration, counted
// to second order, is then exact to rounding: up to `small_on_piece` on one cubic of the profile, of which the third
// order is below 1e-11 m, and up to `small` across a joint, where curvature may jump.
constexpr int foot_iterations = 8;
constexpr double small = 1e-8, small_on_piece = 1e-5;

/// A curve at several points: position and derivatives by arc length.
struct CurveLanes {
  PlaneVector<Eight> at, tangent, bend;
};

CurveLanes on_pieces(const ProfileCurve& curve, const LanePieces& piece, const Eight& s) {
  CurveLanes lanes;
  for (std::size_t i = 0; i < piece.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const CurvePoint p = curve.on_piece(piece[i], s[k]);
    lanes.at.y[k] = p.y;
    lanes.at.z[k] = p.z;
    lanes.tangent.y[k] = p.dy;
    lanes.tangent.z[k] = p.dz;
    lanes.bend.y[k] = p.ddy;
    lanes.bend.z[k] = p.ddz;
  }
  return lanes;
}

LanePieces pieces_of(const ProfileCurve& curve, const Eight& s) {
  LanePieces piece;
  for (std::size_t i = 0; i < piece.size(); ++i) piece[i] = curve.piece_of(s[static_cast<Eigen::Index>(i)]);
  return piece;
}

}  // namespace

struct Overlap::PointLanes {
  Eight penetration;
  PlaneVector<Eight> at;
};

OverlapPoint Overlap::at(double s_wheel, double s_rail) const noexcept {
  const SilhouettePoint w = placed(
      silhouette_point(pair_.wheel().at(s_wheel), pair_.tape_circle_offset(), pair_.nominal_radius(), trigonometry_),
      centre_, trigonometry_);
  const ProfileCurve& rail = pair_.rail();
  for (int i = 0;; ++i) {
    const std::size_t piece = rail.piece_of(s_rail);
    const CurvePoint r = rail.on_piece(piece, s_rail);
    const PlaneVector<double> e{w.y - r.y, w.z - r.z};
    const PlaneVector<double> tangent{r.dy, r.dz};
    const PlaneVector<double> bend{r.ddy, r.ddz};
    const FootOfNormal<double> foot(tangent, bend, e);
    const double step = foot.step();
    s_rail += step;
    const double size = std::abs(step);
    if (!(size < small || (size < small_on_piece && rail.piece_contains(piece, s_rail))) && i < foot_iterations)
      continue;
    // Into the rail, turned to the foot point.
    const double length = std::sqrt(foot.squared);
    const double turn = step * cross(tangent, bend) / foot.squared;
    const double ny = (-r.dz - turn * r.dy) / length;
    const double nz = (r.dy - turn * r.dz) / length;
    return {s_wheel, s_rail, foot.depth(tangent, bend, e), ny * w.dy + nz * w.dz, w.y, w.z};
  }
}

Overlap::PointLanes Overlap::at(const Eigen::Array<double, 8, 1>& s_wheel,
                                Eigen::Array<double, 8, 1> s_rail) const noexcept {
  const CurveLanes wheel = on_pieces(pair_.wheel(), pieces_of(pair_.wheel(), s_wheel), s_wheel);
  const Eight radius = pair_.nominal_radius() + wheel.at.z;
  const Eight axial = pair_.tape_circle_offset() + wheel.at.y;
  const Eight slope = wheel.tangent.z / wheel.tangent.y;
  const Eight w2 = silhouette_cosine2(slope, trigonometry_);
  const Eight below = radius * w2.max(0.0).sqrt();
  PointLanes point;
  point.at = in_rail_head(silhouette_y(axial, radius, slope, trigonometry_), below, centre_, trigonometry_);
  const ProfileCurve& rail = pair_.rail();
  for (int i = 0;; ++i) {
    const LanePieces piece = pieces_of(rail, s_rail);
    const CurveLanes r = on_pieces(rail, piece, s_rail);
    const PlaneVector<Eight> e{point.at.y - r.at.y, point.at.z - r.at.z};
    const FootOfNormal<Eight> foot(r.tangent, r.bend, e);
    const Eight step = foot.step();
    s_rail += step;
    const Eight size = step.abs();
    bool found = (size < small_on_piece).all();
    for (std::size_t k = 0; k < piece.size() && found; ++k) {
      const auto lane = static_cast<Eigen::Index>(k);
      found = size[lane] < small || rail.piece_contains(piece[k], s_rail[lane]);
    }
    if (!found && i < foot_iterations) continue;
    const auto exists = wheel.tangent.y > 0.0 && w2 > 0.0;
    point.penetration = exists.select(foot.depth(r.tangent, r.bend, e), -pair_.nominal_radius());
    return point;
  }
}

OverlapPoint Overlap::saddle(const ContactPatch& left, const ContactPatch& right) const noexcept {
  double low = left.s_wheel;
  double high = right.s_wheel;
  OverlapPoint middle{};
  middle.s_rail = 0.5 * (left.s_rail + right.s_rail);
  // Penetration falls from the left patch to the saddle and rises to the right one: bisection on its slope. Once near,
  // Newton on the common normal is exact, or the error of bisection is of second order.
  constexpr int coarse = 3, fine = 20;
  for (int i = 0; i < coarse + fine; ++i) {
    middle = at(0.5 * (low + high), middle.s_rail);
    (middle.slope < 0.0 ? low : high) = middle.s_wheel;
    if (i + 1 == coarse) {
      const RefinedPair pair =
          refine_pair(pair_, pose_, trigonometry_, {0.5 * (low + high), middle.s_rail}, {.iterations = 8});
      if (pair.status == PairStatus::not_a_minimum && pair.patch.s_wheel > left.s_wheel &&
          pair.patch.s_wheel < right.s_wheel) {
        return at(pair.patch.s_wheel, pair.patch.s_rail);
      }
    }
  }
  return middle;
}

namespace {

/// Newton for the distance at which penetration has fallen to a level, one point of the overlap at a time.
class LevelSearch {
 public:
  LevelSearch(const ContactPatch& patch, int direction, double level, double limit)
      : patch_(patch),
        direction_(direction),
        level_(level),
        fall_(std::sqrt(patch.penetration - level)),
        far_(std::max(0.0, direction * (limit - patch.s_wheel))) {
    const double B = std::max(0.5 * (patch.curv_wheel + patch.curv_rail), 0.05);
    s_ = std::min(fall_ / std::sqrt(B), far_);
  }

  [[nodiscard]] bool found() const { return found_ || iterations_ >= most_iterations; }
  [[nodiscard]] double s_wheel() const { return patch_.s_wheel + direction_ * s_; }
  [[nodiscard]] double s_rail() const { return patch_.s_rail + direction_ * s_; }

  /// @param point of the overlap at s_wheel()
  void advance(const OverlapPoint& point) {
    ++iterations_;
    // For constant curvatures d - penetration is B s², so that its root is a straight line over s: Newton on that.
    const double root = std::sqrt(std::max(patch_.penetration - point.penetration, 0.0));
    (point.penetration > level_ ? near_ : far_) = s_;
    double next = s_ - (root - fall_) * 2.0 * root / (-direction_ * point.slope);
    const bool newton = next > near_ && next < far_;
    if (!newton) {
      found_ = near_ >= far_;
      if (found_) return;
      next = 0.5 * (near_ + far_);
    }
    const double step = std::abs(next - s_);
    s_ = next;
    found_ = step < (newton ? newton_tolerance : bisection_tolerance) * s_;
  }

 private:
  static constexpr int most_iterations = 24;
  // Of the distance. Newton's last step leaves its square, and the area above the level counts the square of that.
  static constexpr double newton_tolerance = 1e-3, bisection_tolerance = 1e-6;

  const ContactPatch& patch_;
  int direction_;
  double level_, fall_;
  double s_, near_ = 0.0, far_;  // distances along the wheel profile; near and far hold the level between them
  bool found_ = false;
  int iterations_ = 0;
};

}  // namespace

OverlapEnds Overlap::ends(double level, const OverlapFlank& low, const OverlapFlank& high) const noexcept {
  LevelSearch left(*low.patch, -1, level, low.limit), right(*high.patch, 1, level, high.limit);
  // One point of either side per turn: neither waits for the other's divisions and roots.
  bool search_left = low.searched, search_right = high.searched;
  while (search_left || search_right) {
    OverlapPoint l, r;
    if (search_left) l = at(left.s_wheel(), left.s_rail());
    if (search_right) r = at(right.s_wheel(), right.s_rail());
    if (search_left) left.advance(l);
    if (search_right) right.advance(r);
    search_left = search_left && !left.found();
    search_right = search_right && !right.found();
  }
  return {low.searched ? left.s_wheel() : low.limit, high.searched ? right.s_wheel() : high.limit};
}

OverlapArea Overlap::area(const ContactPatch& patch, double level, double s_low, double s_high) const noexcept {
  // Gauss and Legendre: exact for the parabola of constant curvatures; six points for what departs from it.
  static const Eight node{{-0.9324695142031521, -0.6612093864662645, -0.2386191860831969, 0.2386191860831969,
                           0.6612093864662645, 0.9324695142031521, 0.0, 0.0}};
  static const Eight weight{{0.1713244923791704, 0.3607615730481386, 0.4679139345726910, 0.4679139345726910,
                             0.3607615730481386, 0.1713244923791704, 0.0, 0.0}};
  constexpr Eigen::Index first = 0, last = 5;
  const double middle = 0.5 * (s_low + s_high);
  const double half = 0.5 * (s_high - s_low);
  if (!(half > 0.0)) return {};
  const Eight from_patch = middle - patch.s_wheel + half * node;
  const PointLanes point = at(patch.s_wheel + from_patch, patch.s_rail + from_patch);
  const Eight part = weight * (point.penetration - level).max(0.0);
  // The silhouette's own speed along the wheel profile has steps where the curvature has.
  const double chord = std::hypot(point.at.y[last] - point.at.y[first], point.at.z[last] - point.at.z[first]) /
                       (half * (node[last] - node[first]));
  return {half * chord * part.sum(), half * chord * (part * from_patch).sum()};
}

ContactPatch Overlap::pair_at(const ContactPatch& patch, double s_wheel) const noexcept {
  const OverlapPoint point = at(s_wheel, patch.s_rail + (s_wheel - patch.s_wheel));
  ContactPatch pair = patch_of_pair(pair_, pose_, trigonometry_, {point.s_wheel, point.s_rail});
  pair.source = patch.source;
  return pair;
}

}  // namespace railtab
