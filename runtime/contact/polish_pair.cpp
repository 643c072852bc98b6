#include <limits>

#include "railtab/runtime/contact/contact_pair.hpp"

namespace railtab {

namespace {

// What follows is one chain of dependent operations, and the price of a look-up is its length: quotients are taken
// apart so that roots and divisions run side by side, and what the patch needs is known at the start before the Newton
// step is, so that the step only adds a few terms to it.

/// A vector of the plane of contact, or a derivative of one.
struct Planar {
  double y, z;
};
Planar operator+(Planar p, Planar q) noexcept { return {p.y + q.y, p.z + q.z}; }
Planar operator-(Planar p, Planar q) noexcept { return {p.y - q.y, p.z - q.z}; }
Planar operator*(double k, Planar p) noexcept { return {k * p.y, k * p.z}; }
double dot(Planar p, Planar q) noexcept { return p.y * q.y + p.z * q.z; }
double cross(Planar p, Planar q) noexcept { return p.y * q.z - p.z * q.y; }

/// From rail-head axes into those of the wheelset before roll.
Planar unrolled(Planar p, const PoseTrigonometry& trig) noexcept {
  return {trig.cos_roll * p.y + trig.sin_roll * p.z, trig.cos_roll * p.z - trig.sin_roll * p.y};
}

/// A point of a profile with the Taylor series of its cubic: at + h (tangent + h (half_bend + h sixth)).
struct ProfilePoint {
  Planar at, tangent, half_bend, sixth;

  ProfilePoint(const ProfileCurve& curve, std::size_t piece, double s) noexcept {
    const double* c = curve.piece_coefficients(piece);
    const auto row = [c](int n) { return Planar{c[2 * n], c[2 * n + 1]}; };
    const double t = s - curve.piece_begin(piece);
    const double t3 = 3.0 * t;
    sixth = row(3);
    half_bend = row(2) + t3 * sixth;
    at = row(0) + t * (row(1) + t * (row(2) + t * sixth));
    tangent = row(1) + t * (2.0 * row(2) + t3 * sixth);
  }
  [[nodiscard]] Planar at_step(double h) const noexcept { return at + h * (tangent + h * (half_bend + h * sixth)); }
  [[nodiscard]] Planar tangent_at_step(double h) const noexcept {
    return tangent + h * (2.0 * half_bend + 3.0 * h * sixth);
  }
};

/// The common-normal equations (Eqs. 1-4) at a pair, t_r·d_wr = 0 (f) and t_w × t_r = 0 (g), in the axes of the
/// wheelset before roll, with their Newton step. As CommonNormal in contact_pair.cpp, with the tangent of the wheel's
/// silhouette (u, dz/cos(yaw)), u² = dy² - tan²(yaw) dz².
struct NewtonStep {
  double depth;        ///< t_r × d_wr: penetration times the length of t_r [m]
  double g, g_w;       ///< and its derivative by s_wheel
  double speed;        ///< silhouette's derivative by s_wheel over its tangent
  double wheel, rail;  ///< the step [m]
  bool exists, minimum;

  NewtonStep(const ProfilePoint& W, const ProfilePoint& C, const WheelRailPair& pair, const WheelsetCentre& centre,
             const PoseTrigonometry& trig) noexcept {
    const double R = pair.nominal_radius() + W.at.z;
    const double dy = W.tangent.y;
    const double dz = W.tangent.z;
    const double t2 = trig.tan_yaw * trig.tan_yaw;
    const double u2 = dy * dy - t2 * dz * dz;
    exists = (dy > 0.0) & (u2 > 0.0);
    const double u = std::sqrt(u2);
    const double inverse_u = u * (1.0 / u2);
    const double inverse_dy = 1.0 / dy;
    const double R_dy = R * inverse_dy;
    const Planar S{trig.cos_yaw * (pair.tape_circle_offset() + W.at.y - t2 * dz * R_dy), R_dy * u};
    const Planar T{u, dz * trig.inverse_cos_yaw};
    const Planar half_dT{(dy * W.half_bend.y - t2 * dz * W.half_bend.z) * inverse_u,
                         W.half_bend.z * trig.inverse_cos_yaw};
    const double bend = -2.0 * t2 * cross(W.half_bend, W.tangent) * R_dy * inverse_dy;
    speed = trig.cos_yaw * (u * inverse_dy - bend * inverse_u);

    const Planar rail_tangent = unrolled(C.tangent, trig);
    const Planar rail_half_bend = unrolled(C.half_bend, trig);
    const Planar e = S - unrolled(C.at - Planar{centre.y, centre.z}, trig);
    depth = cross(rail_tangent, e);
    const double f = dot(rail_tangent, e);
    g = cross(T, rail_tangent);
    g_w = 2.0 * cross(half_dT, rail_tangent);
    const double f_w = speed * dot(rail_tangent, T);
    const double f_r = 2.0 * dot(rail_half_bend, e) - dot(C.tangent, C.tangent);
    const double g_r = 2.0 * cross(T, rail_half_bend);
    const double det = f_w * g_r - f_r * g_w;
    const double inverse_det = 1.0 / det;
    wheel = (f_r * g - g_r * f) * inverse_det;
    rail = (g_w * f - f_w * g) * inverse_det;
    minimum = (det > 0.0) & (f_r < 0.0) & (speed > 0.0);
  }
};

/// The patch at the end of a small step: the profiles' points exactly, the silhouette to the second order across the
/// normal, along which alone its place matters, lengths of tangents and curvatures to the first.
void set_patch(const WheelRailPair& pair, const PoseTrigonometry& trig, const ProfilePoint& W, const ProfilePoint& C,
               std::size_t rail_piece, const NewtonStep& step, ContactPatch& p) noexcept {
  const double h_w = step.wheel;
  const double h_r = step.rail;
  const Planar inverse{1.0 / std::sqrt(dot(W.tangent, W.tangent)), 1.0 / std::sqrt(dot(C.tangent, C.tangent))};
  const double inverse_wheel = inverse.y * (1.0 - 2.0 * h_w * dot(W.tangent, W.half_bend) * inverse.y * inverse.y);
  const double stretch = 2.0 * h_r * dot(C.tangent, C.half_bend) * inverse.z * inverse.z;
  const double inverse_rail = inverse.z * (1.0 - stretch);
  const double bend = 2.0 * cross(C.tangent, C.half_bend);
  const double bend_change = 6.0 * h_r * cross(C.tangent, C.sixth);
  const double turn = h_r * (bend + 0.5 * bend_change) * inverse.z * inverse_rail;
  const double shallower =
      h_w * step.speed * (step.g + 0.5 * h_w * step.g_w) + h_r * h_r * (0.5 * bend + bend_change / 6.0);
  p.penetration = (step.depth - shallower) * inverse.z * (1.0 + 0.5 * turn * turn);
  p.angle = pair.rail().tangent_angle(rail_piece, C.tangent.y, C.tangent.z, inverse.z) +
            turn * (1.0 - turn * turn * (1.0 / 3));
  p.curv_rail = (bend + bend_change) * inverse_rail * inverse_rail * inverse_rail;
  p.curv_wheel = (2.0 * cross(W.half_bend, W.tangent) + 6.0 * h_w * cross(W.sixth, W.tangent)) * inverse_wheel *
                 inverse_wheel * inverse_wheel;
  const Planar rail = C.at_step(h_r);
  p.y_rail = rail.y;
  p.z_rail = rail.z;
  const Planar wheel = W.at_step(h_w);
  p.y_wheel = wheel.y;
  p.z_wheel = wheel.z;
  p.rolling_radius = pair.nominal_radius() + wheel.z;
  const Planar tangent = W.tangent_at_step(h_w);
  p.x = -trig.sin_yaw * (pair.tape_circle_offset() + wheel.y + p.rolling_radius * (tangent.z / tangent.y));
  p.curv_rolling = tangent.y * inverse_wheel / p.rolling_radius;
  p.concave = p.curv_wheel < 0.0;
  p.source = PatchSource::online_convex;
}

enum class Outcome : std::uint8_t { accepted, refused, again };

/// One Newton step from a pair, and the patch at its end where it is small and stays on the pieces of both profiles.
inline Outcome take_step(const WheelRailPair& pair, const WheelsetCentre& centre, const PoseTrigonometry& trig,
                         ContactPatch& patch, PairStatus& status) noexcept {
  constexpr double last_step = 20e-6;  // [m]
  const ProfileCurve& wheel = pair.wheel();
  const ProfileCurve& rail = pair.rail();
  const std::size_t wheel_piece = wheel.piece_of(patch.s_wheel);
  const std::size_t rail_piece = rail.piece_of(patch.s_rail);
  const ProfilePoint W(wheel, wheel_piece, patch.s_wheel);
  const ProfilePoint C(rail, rail_piece, patch.s_rail);
  const NewtonStep step(W, C, pair, centre, trig);
  patch.s_wheel += step.wheel;
  patch.s_rail += step.rail;
  const double size = std::abs(step.wheel) + std::abs(step.rail);
  if (!(step.exists && size < std::numeric_limits<double>::infinity())) {
    status = PairStatus::not_converged;
    return Outcome::refused;
  }
  if (size > last_step || !wheel.piece_contains(wheel_piece, patch.s_wheel) ||
      !rail.piece_contains(rail_piece, patch.s_rail)) {
    return Outcome::again;
  }
  if (!step.minimum) {
    status = PairStatus::not_a_minimum;
    return Outcome::refused;
  }
  set_patch(pair, trig, W, C, rail_piece, step, patch);
  status =
      wheel.contains(patch.s_wheel) && rail.contains(patch.s_rail) ? PairStatus::converged : PairStatus::off_profile;
  return Outcome::accepted;
}

/// The steps after the first: rare, and apart from it, for a loop would have the first one's registers saved.
[[gnu::noinline]] PairStatus take_more_steps(const WheelRailPair& pair, const WheelsetCentre& centre,
                                             const PoseTrigonometry& trig, ContactPatch& patch) noexcept {
  constexpr int most_steps = 7;
  PairStatus status = PairStatus::not_converged;
  for (int n = 0; n < most_steps; ++n) {
    if (take_step(pair, centre, trig, patch, status) != Outcome::again) return status;
  }
  return PairStatus::not_converged;
}

}  // namespace

PairStatus polish_pair(const WheelRailPair& pair, const WheelsetCentre& centre, const PoseTrigonometry& trig,
                       double s_wheel, double s_rail, ContactPatch& patch) noexcept {
  patch.s_wheel = s_wheel;
  patch.s_rail = s_rail;
  PairStatus status = PairStatus::not_converged;
  if (take_step(pair, centre, trig, patch, status) != Outcome::again) return status;
  return take_more_steps(pair, centre, trig, patch);
}

}  // namespace railtab
