#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "railtab/runtime/contact/common_normal.hpp"
#include "railtab/runtime/contact/contact_pair.hpp"

namespace railtab::polish {

// The longest chain of dependent operations decides the time of a look-up. Therefore two components share a register,
// quotients are split so that roots and divisions run in parallel, and the patch is evaluated at the start pair, beside
// the Newton step, which then adds a few terms to it. The kernel is in a header so that the table's look-up inlines it.

/// (y, z) of a vector in the plane of contact, or a quantity of (wheel, rail): two doubles in one register.
using Two = double __attribute__((vector_size(16)));

inline Two first_of(Two p, Two q) noexcept { return Two{p[0], q[0]}; }
inline Two second_of(Two p, Two q) noexcept { return Two{p[1], q[1]}; }
inline double dot(Two p, Two q) noexcept { return p[0] * q[0] + p[1] * q[1]; }
inline double cross(Two p, Two q) noexcept { return p[0] * q[1] - p[1] * q[0]; }
inline PlaneVector<double> components(Two value) noexcept { return {value[0], value[1]}; }
inline void store(Two value, double& first) noexcept { std::memcpy(&first, &value, sizeof value); }

/// From rail-head axes into those of the wheelset before roll.
inline Two unrolled(Two p, const PoseTrigonometry& trig) noexcept {
  return trig.cos_roll * p + trig.sin_roll * Two{p[1], -p[0]};
}

/// A point of a profile with the Taylor series of its cubic: at + h (tangent + h (half_bend + h sixth)).
struct ProfilePoint {
  std::size_t piece;
  Two at, tangent, half_bend, sixth;

  ProfilePoint(const ProfileCurve& curve, double s) noexcept : piece(curve.piece_of(s)) {
    const double* const c = curve.piece_coefficients(piece);
    const auto row = [c](int n) {
      Two value;
      std::memcpy(&value, c + 2 * n, sizeof value);
      return value;
    };
    const double t = s - curve.piece_begin(piece);
    sixth = row(3);
    half_bend = row(2) + (3.0 * t) * sixth;
    at = row(0) + t * (row(1) + t * (row(2) + t * sixth));
    tangent = row(1) + t * (row(2) + half_bend);
  }
  [[nodiscard]] Two at_step(double h) const noexcept { return at + h * (tangent + h * (half_bend + h * sixth)); }
  [[nodiscard]] Two tangent_at_step(double h) const noexcept {
    return tangent + h * (2.0 * half_bend + (3.0 * h) * sixth);
  }
};

/// Newton's step on the common normal (common_normal.hpp) at a pair, in the axes of the wheelset before roll. The
/// silhouette is that of wheel_silhouette.hpp with its tangent t_w = (u, dz/cos(yaw)), u² = dy² - tan²(yaw) dz², so
/// that the root need not wait for a quotient.
struct NewtonStep {
  double depth;        ///< t_r × e: penetration times the length of t_r [m]
  double g, g_w;       ///< and its derivative by s_wheel
  double speed;        ///< silhouette's derivative by s_wheel over its tangent
  double wheel, rail;  ///< the step [m]; not finite where the wheel has no silhouette
  bool minimum;

  NewtonStep(const ProfilePoint& W, const ProfilePoint& C, const WheelRailPair& pair, const WheelsetCentre& centre,
             const PoseTrigonometry& trig) noexcept {
    const double dy = W.tangent[0];
    const double dz = W.tangent[1];
    const double t2 = trig.tan_yaw * trig.tan_yaw;
    const double t2_dz = t2 * dz;
    const double u2 = dy * dy - t2_dz * dz;
    const double u = std::sqrt(u2);
    const double inverse_u = u * (1.0 / u2);
    const double inverse_dy = 1.0 / dy;
    const double R_dy = (pair.nominal_radius() + W.at[1]) * inverse_dy;
    const PlaneVector<double> tangent{u, dz * trig.inverse_cos_yaw};
    const PlaneVector<double> bend{2.0 * (dy * W.half_bend[0] - t2_dz * W.half_bend[1]) * inverse_u,
                                   2.0 * W.half_bend[1] * trig.inverse_cos_yaw};
    const double curl = 2.0 * t2 * cross(W.half_bend, W.tangent) * (R_dy * inverse_dy);
    speed = trig.cos_yaw * (u * inverse_dy + curl * inverse_u);

    Two rail_tangent = C.tangent;
    Two rail_bend = C.half_bend + C.half_bend;
    Two rail_at = C.at - Two{centre.y, centre.z};
    if (trig.sin_roll != 0.0) {
      rail_tangent = unrolled(rail_tangent, trig);
      rail_bend = unrolled(rail_bend, trig);
      rail_at = unrolled(rail_at, trig);
    }
    const RailTangent<double> rail_point{
        components(rail_tangent), components(rail_bend), {dot(C.tangent, C.tangent), 0.0}};
    const PlaneVector<double> e{trig.cos_yaw * (pair.tape_circle_offset() + W.at[0] - t2_dz * R_dy) - rail_at[0],
                                R_dy * u - rail_at[1]};
    const PairEquations<double> equations = common_normal<double>({tangent, bend, speed, tangent}, rail_point, e);
    depth = cross(rail_point.tangent, e);
    g = equations.g;
    g_w = equations.g_w;
    const double determinant = equations.determinant();
    const double inverse = 1.0 / determinant;
    const PlaneVector<double> scaled = equations.scaled_step();
    wheel = scaled.y * inverse;
    rail = scaled.z * inverse;
    minimum = std::min(std::min(determinant, speed), std::min(-equations.f_r, dy)) > 0.0;
  }
};

/// The patch at the end of a small step: the profiles' points exactly, the silhouette to the second order across the
/// normal, along which alone its place matters, lengths of tangents and curvatures to the first.
inline void set_patch(const WheelRailPair& pair, const PoseTrigonometry& trig, const ProfilePoint& W,
                      const ProfilePoint& C, const NewtonStep& step, ContactPatch& p) noexcept {
  const double h_w = step.wheel;
  const double h_r = step.rail;
  const Two h{h_w, h_r};
  // Of (wheel, rail).
  const Two t_y = first_of(W.tangent, C.tangent);
  const Two t_z = second_of(W.tangent, C.tangent);
  const Two b_y = first_of(W.half_bend, C.half_bend);
  const Two b_z = second_of(W.half_bend, C.half_bend);
  const Two length2 = t_y * t_y + t_z * t_z;
  const Two inverse = 1.0 / Two{std::sqrt(length2[0]), std::sqrt(length2[1])};
  const Two stretch = (h + h) * (t_y * b_y + t_z * b_z);
  const Two inverse_after = inverse * (1.0 - stretch * (inverse * inverse));
  const Two half_bend = t_y * b_z - t_z * b_y;
  const Two half_change = (3.0 * h) * (t_y * second_of(W.sixth, C.sixth) - t_z * first_of(W.sixth, C.sixth));
  const Two curvature = Two{-2.0, 2.0} * (half_bend + half_change) * (inverse_after * inverse_after * inverse_after);
  static_assert(offsetof(ContactPatch, curv_rail) == offsetof(ContactPatch, curv_wheel) + sizeof(double));
  store(curvature, p.curv_wheel);
  p.concave = curvature[0] < 0.0;

  const double turn = h_r * (2.0 * half_bend[1] + half_change[1]) * (inverse[1] * inverse_after[1]);
  const double shallower =
      h_w * step.speed * (step.g + 0.5 * h_w * step.g_w) + h_r * h_r * (half_bend[1] + half_change[1] * (1.0 / 3));
  p.penetration = (step.depth - shallower) * inverse[1] * (1.0 + 0.5 * turn * turn);
  p.angle = pair.rail().tangent_angle(C.piece, C.tangent[0], C.tangent[1], inverse[1]) +
            turn * (1.0 - turn * turn * (1.0 / 3));

  static_assert(offsetof(ContactPatch, z_rail) == offsetof(ContactPatch, y_rail) + sizeof(double));
  static_assert(offsetof(ContactPatch, z_wheel) == offsetof(ContactPatch, y_wheel) + sizeof(double));
  store(C.at_step(h_r), p.y_rail);
  const Two wheel = W.at_step(h_w);
  store(wheel, p.y_wheel);
  const double radius = pair.nominal_radius() + wheel[1];
  p.rolling_radius = radius;
  const Two tangent = W.tangent_at_step(h_w);
  p.x = -trig.sin_yaw * (pair.tape_circle_offset() + wheel[0] + radius * (tangent[1] / tangent[0]));
  p.curv_rolling = tangent[0] * inverse_after[0] / radius;
  p.source = PatchSource::online_convex;
}

enum class Outcome : std::uint8_t { accepted, rejected, again };

/// One Newton step from the position of a patch, and the patch at its end where it is small and stays on the pieces of
/// both profiles.
/// @param status of the patch where the outcome is not `again`
[[gnu::always_inline]] inline Outcome take_step(const WheelRailPair& pair, const WheelsetCentre& centre,
                                                const PoseTrigonometry& trig, const PairPosition& start,
                                                ContactPatch& patch, PairStatus& status) noexcept {
  constexpr double last_step = 20e-6;    // [m]
  constexpr double largest_step = 1e-3;  // [m] beyond it, to the pair of another branch
  const ProfileCurve& wheel = pair.wheel();
  const ProfileCurve& rail = pair.rail();
  const ProfilePoint W(wheel, start.s_wheel);
  const ProfilePoint C(rail, start.s_rail);
  const NewtonStep step(W, C, pair, centre, trig);
  patch.s_wheel = start.s_wheel + step.wheel;
  patch.s_rail = start.s_rail + step.rail;
  const double size = std::abs(step.wheel) + std::abs(step.rail);
  if (!(size <= last_step && wheel.piece_contains(W.piece, patch.s_wheel) &&
        rail.piece_contains(C.piece, patch.s_rail))) [[unlikely]] {
    if (size <= largest_step) return Outcome::again;
    status = PairStatus::not_converged;
    return Outcome::rejected;
  }
  if (!step.minimum) [[unlikely]] {
    status = PairStatus::not_a_minimum;
    return Outcome::rejected;
  }
  set_patch(pair, trig, W, C, step, patch);
  status = PairStatus::converged;
  return Outcome::accepted;
}

/// The steps after the first, from the position of the patch: rare, and a function of its own, because a loop would
/// have the registers of the first step saved.
[[nodiscard]] PairStatus take_more_steps(const WheelRailPair& pair, const WheelsetCentre& centre,
                                         const PoseTrigonometry& trig, ContactPatch& patch) noexcept;

/// polish_pair(), see there.
[[gnu::always_inline]] inline PairStatus polished(const WheelRailPair& pair, const WheelsetCentre& centre,
                                                  const PoseTrigonometry& trig, const PairPosition& start,
                                                  ContactPatch& patch) noexcept {
  PairStatus status = PairStatus::not_converged;
  if (take_step(pair, centre, trig, start, patch, status) != Outcome::again) [[likely]]
    return status;
  return take_more_steps(pair, centre, trig, patch);
}

}  // namespace railtab::polish
