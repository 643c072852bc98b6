#include "railtab/runtime/contact/patch_loads.hpp"

#include <algorithm>
#include <cmath>

namespace railtab {

namespace {

constexpr double averaging_length = 1e-3;  // m

// Turning of the tangent over [s - w, s + w] per length, with the sign of CurvePoint::curvature().
double mean_curvature(const ProfileCurve& curve, double s, double curvature) {
  const double w = std::min(averaging_length, 0.2 / std::max(std::abs(curvature), 1e-9));
  const double low = std::max(s - w, curve.s_begin());
  const double high = std::min(s + w, curve.s_end());
  const CurvePoint a = curve.at(low);
  const CurvePoint b = curve.at(high);
  const double sine =
      (a.dy * b.dz - a.dz * b.dy) / std::sqrt((a.dy * a.dy + a.dz * a.dz) * (b.dy * b.dy + b.dz * b.dz));
  return std::asin(std::clamp(sine, -1.0, 1.0)) / (high - low);
}

HertzContact patch_hertz(const NormalContactModel& model, const ContactGeometry& geometry, const ContactPatch& p) {
  double relative = p.curv_wheel + p.curv_rail;
  if (!geometry.is_paper()) {
    const WheelRailPair& pair = geometry.pair();
    relative =
        mean_curvature(pair.rail(), p.s_rail, p.curv_rail) - mean_curvature(pair.wheel(), p.s_wheel, p.curv_wheel);
  }
  return hertz_contact(0.5 * p.curv_rolling, std::max(0.5 * relative, model.curvature_floor), model.material);
}

double power_3_2(double d) { return d > 0.0 ? d * std::sqrt(d) : 0.0; }

// A wheel point against the rail: its penetration along the rail's normal, and how that grows along the wheel.
struct PointPenetration {
  double value, slope, s_rail;
};

PointPenetration point_penetration(const WheelRailPair& pair, const WheelsetCentre& centre,
                                   const PoseTrigonometry& trig, double s_wheel, double s_rail) {
  const SilhouettePoint w = placed(
      silhouette_point(pair.wheel().at(s_wheel), pair.tape_circle_offset(), pair.nominal_radius(), trig), centre, trig);
  CurvePoint r = pair.rail().at(s_rail);
  for (int iteration = 0; iteration < 6; ++iteration) {
    const double along = r.dy * (w.y - r.y) + r.dz * (w.z - r.z);
    const double change = r.dy * r.dy + r.dz * r.dz - r.ddy * (w.y - r.y) - r.ddz * (w.z - r.z);
    const double step = along / change;
    s_rail += step;
    r = pair.rail().at(s_rail);
    if (std::abs(step) < 1e-10) break;
  }
  const double length = std::sqrt(r.dy * r.dy + r.dz * r.dz);
  const double ny = -r.dz / length;  // into the rail
  const double nz = r.dy / length;
  return {ny * (w.y - r.y) + nz * (w.z - r.z), ny * w.dy + nz * w.dz, s_rail};
}

}  // namespace

double saddle_penetration(const WheelRailPair& pair, const WheelsetPose& pose, const ContactPatch& left,
                          const ContactPatch& right) noexcept {
  const PoseTrigonometry trig(pose);
  const WheelsetCentre centre = wheelset_centre(pair, pose);
  double low = left.s_wheel;
  double high = right.s_wheel;
  double s_rail = 0.5 * (left.s_rail + right.s_rail);
  PointPenetration middle{};
  // Penetration falls from the left patch to the saddle and rises to the right one: bisection on its slope. Once near,
  // Newton on the common normal is exact, or the error of bisection is of second order.
  constexpr int coarse = 7, fine = 16;
  for (int i = 0; i < coarse + fine; ++i) {
    const double s = 0.5 * (low + high);
    middle = point_penetration(pair, centre, trig, s, s_rail);
    s_rail = middle.s_rail;
    (middle.slope < 0.0 ? low : high) = s;
    if (i + 1 == coarse) {
      const RefinedPair saddle = refine_pair(pair, pose, trig, 0.5 * (low + high), s_rail, 8);
      if (saddle.status == PairStatus::not_a_minimum && saddle.patch.s_wheel > left.s_wheel &&
          saddle.patch.s_wheel < right.s_wheel) {
        return saddle.patch.penetration;
      }
    }
  }
  return middle.value;
}

PatchLoads patch_loads(const NormalContactModel& model, const ContactGeometry& geometry, const WheelsetPose& pose,
                       const ContactPatches& patches) noexcept {
  PatchLoads loads;
  std::array<double, ContactPatches::capacity> shared{};  // w_i d_s^{3/2}
  for (std::size_t i = 0; i + 1 < static_cast<std::size_t>(patches.count) && !geometry.is_paper(); ++i) {
    const ContactPatch& left = patches.patch[i];
    const ContactPatch& right = patches.patch[i + 1];
    if (left.penetration <= 0.0 || right.penetration <= 0.0) continue;
    const double saddle = saddle_penetration(geometry.pair(), pose, left, right);
    if (saddle <= 0.0) continue;
    const double left_rise = std::max(left.penetration - saddle, 0.0);
    const double right_rise = std::max(right.penetration - saddle, 0.0);
    const double both = left_rise + right_rise;
    const double left_share = both > 0.0 ? right_rise / both : 0.5;
    const double below = power_3_2(saddle);
    shared[i] = std::max(shared[i], left_share * below);
    shared[i + 1] = std::max(shared[i + 1], (1.0 - left_share) * below);
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(patches.count); ++i) {
    loads[i].hertz = patch_hertz(model, geometry, patches.patch[i]);
    const double own = std::max(power_3_2(patches.patch[i].penetration) - shared[i], 0.0);
    loads[i].elastic_force = loads[i].hertz.stiffness * own;
  }
  return loads;
}

}  // namespace railtab
