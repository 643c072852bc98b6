#include "railtab/runtime/contact/overlap.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace railtab {

OverlapPoint Overlap::at(double s_wheel, double s_rail) const noexcept {
  const SilhouettePoint w = placed(
      silhouette_point(pair_.wheel().at(s_wheel), pair_.tape_circle_offset(), pair_.nominal_radius(), trigonometry_),
      centre_, trigonometry_);
  // The rail's foot point by Newton. A last step is not evaluated where its part in the penetration, counted to second
  // order, leaves rounding: up to `small_on_piece` on one cubic of the profile, of which the third order is below
  // 1e-11 m, and up to `small` across a joint, where curvature may jump.
  constexpr int iterations = 8;
  constexpr double small = 1e-8, small_on_piece = 1e-5;
  const ProfileCurve& rail = pair_.rail();
  for (int i = 0;; ++i) {
    const std::size_t piece = rail.piece_of(s_rail);
    const CurvePoint r = rail.on_piece(piece, s_rail);
    const double ey = w.y - r.y;
    const double ez = w.z - r.z;
    const double tangent2 = r.dy * r.dy + r.dz * r.dz;
    const double along = r.dy * ey + r.dz * ez;
    const double change = tangent2 - r.ddy * ey - r.ddz * ez;
    const double step = along / change;
    s_rail += step;
    const double size = std::abs(step);
    if (!(size < small || (size < small_on_piece && rail.piece_contains(piece, s_rail))) && i < iterations) continue;
    const double length = std::sqrt(tangent2);
    // Into the rail, turned to the foot point.
    const double turn = step * (r.dy * r.ddz - r.dz * r.ddy) / tangent2;
    const double ny = (-r.dz - turn * r.dy) / length;
    const double nz = (r.dy - turn * r.dz) / length;
    const double depth = (-r.dz * ey + r.dy * ez) / length;
    const double bend = (r.dy * r.ddz - r.dz * r.ddy) / (tangent2 * length);
    const double offset = along / length;
    return {s_wheel, s_rail, depth - 0.5 * bend * offset * offset * tangent2 / change, ny * w.dy + nz * w.dz, w.y, w.z};
  }
}

OverlapPoint Overlap::saddle(const ContactPatch& left, const ContactPatch& right) const noexcept {
  double low = left.s_wheel;
  double high = right.s_wheel;
  OverlapPoint middle{};
  middle.s_rail = 0.5 * (left.s_rail + right.s_rail);
  // Penetration falls from the left patch to the saddle and rises to the right one: bisection on its slope. Once near,
  // Newton on the common normal is exact, or the error of bisection is of second order.
  constexpr int coarse = 7, fine = 16;
  for (int i = 0; i < coarse + fine; ++i) {
    middle = at(0.5 * (low + high), middle.s_rail);
    (middle.slope < 0.0 ? low : high) = middle.s_wheel;
    if (i + 1 == coarse) {
      const RefinedPair pair = refine_pair(pair_, pose_, trigonometry_, 0.5 * (low + high), middle.s_rail, 8);
      if (pair.status == PairStatus::not_a_minimum && pair.patch.s_wheel > left.s_wheel &&
          pair.patch.s_wheel < right.s_wheel) {
        return at(pair.patch.s_wheel, pair.patch.s_rail);
      }
    }
  }
  return middle;
}

double Overlap::reach(const ContactPatch& patch, int direction, double level, double limit) const noexcept {
  const double d = patch.penetration;
  const double fall = std::sqrt(d - level);
  // For constant curvatures d - penetration is B s², so that its root is a straight line over s: Newton on that.
  const double B = std::max(0.5 * (patch.curv_wheel + patch.curv_rail), 0.05);
  double near = 0.0;  // distances along the wheel profile that hold the level between them
  double far = std::max(0.0, direction * (limit - patch.s_wheel));
  double s = std::min(fall / std::sqrt(B), far);
  constexpr int iterations = 24;
  // Of the distance. Newton's last step leaves its square, and the area above the level counts the square of that.
  constexpr double newton_tolerance = 1e-3, bisection_tolerance = 1e-6;
  for (int i = 0; i < iterations; ++i) {
    const OverlapPoint point = at(patch.s_wheel + direction * s, patch.s_rail + direction * s);
    const double root = std::sqrt(std::max(d - point.penetration, 0.0));
    (point.penetration > level ? near : far) = s;
    double next = s - (root - fall) * 2.0 * root / (-direction * point.slope);
    const bool newton = next > near && next < far;
    if (!newton) {
      if (near >= far) break;
      next = 0.5 * (near + far);
    }
    const double step = std::abs(next - s);
    s = next;
    if (step < (newton ? newton_tolerance : bisection_tolerance) * s) break;
  }
  return s;
}

OverlapArea Overlap::area(const ContactPatch& patch, double level, double s_low, double s_high) const noexcept {
  // Gauss and Legendre: exact for the parabola of constant curvatures; six points for what departs from it.
  constexpr std::array<double, 3> node{0.2386191860831969, 0.6612093864662645, 0.9324695142031521};
  constexpr std::array<double, 3> weight{0.4679139345726910, 0.3607615730481386, 0.1713244923791704};
  const double middle = 0.5 * (s_low + s_high);
  const double half = 0.5 * (s_high - s_low);
  if (!(half > 0.0)) return {};
  std::array<OverlapPoint, 2> outer{};
  OverlapArea sum;
  for (std::size_t i = 0; i < node.size(); ++i) {
    for (std::size_t side = 0; side < 2; ++side) {
      const double s = middle + (side == 0 ? -1.0 : 1.0) * half * node[i];
      outer[side] = at(s, patch.s_rail + (s - patch.s_wheel));
      const double part = weight[i] * std::max(outer[side].penetration - level, 0.0);
      sum.area += part;
      sum.moment += part * (s - patch.s_wheel);
    }
  }
  // The silhouette's own speed along the wheel profile has steps where the curvature has.
  const double chord = std::hypot(outer[1].y - outer[0].y, outer[1].z - outer[0].z) / (2.0 * half * node.back());
  return {half * chord * sum.area, half * chord * sum.moment};
}

ContactPatch Overlap::pair_at(const ContactPatch& patch, double s_wheel) const noexcept {
  const OverlapPoint point = at(s_wheel, patch.s_rail + (s_wheel - patch.s_wheel));
  ContactPatch pair = patch_of_pair(pair_, pose_, trigonometry_, point.s_wheel, point.s_rail);
  pair.source = patch.source;
  return pair;
}

}  // namespace railtab
