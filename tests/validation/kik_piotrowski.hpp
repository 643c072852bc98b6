#pragma once

// Normal contact by virtual penetration [KikPiotrowski1996], [PiotrowskiKik2008], without a correction of the area's
// shape: for a chart of methods, not for runs. Between a circle (B = A) and B = 100 A its force is 5 % above to 2 %
// below Hertz's.

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "railtab/runtime/contact/contact_patch.hpp"
#include "railtab/runtime/contact/hertz.hpp"
#include "railtab/runtime/contact/overlap.hpp"

namespace railtab::kik_piotrowski {

/// Share of the penetration by which the profiles overlap virtually.
constexpr double virtual_share = 0.55;

/// ∫ √(l² − x²)/√(x² + t²) dx over −l..l, by the complete elliptic integrals of k = l/√(l² + t²); l, t > 0 [m].
inline double pressed_line(double l, double t) {
  const double distance = std::hypot(l, t), k = l / distance;
  return 2.0 * distance * (std::comp_ellint_1(k) - std::comp_ellint_2(k));
}

/// Both integrals over a contact area x_l(t), of the pressure's shape √(x_l² − x²): its volume [m³] and its
/// displacement at t = 0, ∬ √(x_l² − x²)/r dx dt [m²].
struct ShapeIntegrals {
  double volume = 0.0, displacement = 0.0;
};

/// One half of the area, from the deepest point at arc length s_wheel to `end`. Gauss points over √t, which removes the
/// logarithm at t = 0; t: distance in the tangent plane.
inline void add_half(const Overlap& overlap, const ContactPatch& deepest, double level, double end,
                     ShapeIntegrals& sum) {
  static constexpr std::array<double, 8> node{0.0198550717512319, 0.1016667612931866, 0.2372337950418355,
                                              0.4082826787521751, 0.5917173212478249, 0.7627662049581645,
                                              0.8983332387068134, 0.9801449282487681};
  static constexpr std::array<double, 8> weight{0.0506142681451881, 0.1111905172266872, 0.1568533229389436,
                                                0.1813418916891810, 0.1813418916891810, 0.1568533229389436,
                                                0.1111905172266872, 0.0506142681451881};
  const double reach = end - deepest.s_wheel;
  const OverlapPoint origin = overlap.at(deepest.s_wheel, deepest.s_rail);
  const double cosine = std::cos(deepest.angle), sine = std::sin(deepest.angle);
  for (std::size_t i = 0; i < node.size(); ++i) {
    const double along = reach * node[i] * node[i];
    const OverlapPoint p = overlap.at(deepest.s_wheel + along, deepest.s_rail + along);
    const double g = p.penetration - level;
    if (g <= 0.0) continue;
    const double t = std::abs((p.y - origin.y) * cosine + (p.z - origin.z) * sine);
    const double squared = 2.0 * g / deepest.curv_rolling;  // x_l²
    const double width = 2.0 * std::abs(reach) * node[i] * weight[i];
    sum.volume += width * 0.5 * std::numbers::pi * squared;
    sum.displacement += width * pressed_line(std::sqrt(squared), t);
  }
}

/// Force on the rail (y, z) of the patches of a right wheel at a pose, each by itself:
///
///   g(t) = d(t) − (1 − 0.55) d₀ ≥ 0,  x_l² = 2 R g,  p ~ √(x_l² − x²),  N = π E* d₀ ∬p / ∬(p/r),
///
/// d(t) the penetration, d₀ that of the deepest point, r the distance from it. Patches that are connected above the
/// level 0.45 d₀ of the deepest one are one area; what lies beyond the saddle to another area is that one's.
inline Eigen::Vector2d force(const WheelRailPair& pair, const WheelsetPose& pose, const ContactPatches& patches,
                             const ElasticMaterial& material) {
  const Overlap overlap(pair, pose);
  const int count = patches.count;
  const auto patch = [&](int i) -> const ContactPatch& { return patches.patch[static_cast<std::size_t>(i)]; };
  std::array<OverlapPoint, ContactPatches::capacity> saddle;  // i: between patches i and i + 1
  for (int i = 0; i + 1 < count; ++i) saddle[static_cast<std::size_t>(i)] = overlap.saddle(patch(i), patch(i + 1));
  std::array<bool, ContactPatches::capacity> taken{};
  Eigen::Vector2d total = Eigen::Vector2d::Zero();
  while (true) {
    int first = -1;
    for (int i = 0; i < count; ++i) {
      if (!taken[static_cast<std::size_t>(i)] && (first < 0 || patch(i).penetration > patch(first).penetration)) {
        first = i;
      }
    }
    if (first < 0 || patch(first).penetration <= 0.0) return total;
    const ContactPatch& deepest = patch(first);
    const double level = (1.0 - virtual_share) * deepest.penetration;
    /// Adds patches on one side that are connected above the level; where the search for the area's end goes.
    const auto flank = [&](int direction) -> OverlapFlank {
      int last = first;
      while (true) {
        const int next = last + direction;
        if (next < 0 || next >= count) {
          return {&patch(last), direction > 0 ? pair.wheel().s_end() : pair.wheel().s_begin()};
        }
        const OverlapPoint& between = saddle[static_cast<std::size_t>(std::min(last, next))];
        if (between.penetration <= level) return {&patch(last), between.s_wheel};
        if (taken[static_cast<std::size_t>(next)]) return {&patch(last), between.s_wheel, false};
        last = next;
        taken[static_cast<std::size_t>(last)] = true;
      }
    };
    taken[static_cast<std::size_t>(first)] = true;
    const OverlapFlank low = flank(-1), high = flank(1);
    const OverlapEnds ends = overlap.ends(level, low, high);
    ShapeIntegrals sum;
    add_half(overlap, deepest, level, ends.low, sum);
    add_half(overlap, deepest, level, ends.high, sum);
    if (!(sum.displacement > 0.0)) continue;
    const double normal =
        std::numbers::pi * material.contact_modulus() * deepest.penetration * sum.volume / sum.displacement;
    total += normal * Eigen::Vector2d(-std::sin(deepest.angle), std::cos(deepest.angle));
  }
}

}  // namespace railtab::kik_piotrowski
