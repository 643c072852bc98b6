#pragma once

#include <array>
#include <cstddef>
#include <cstring>

#include "railtab/runtime/base/pack.hpp"

namespace railtab {

/// Weights of the four B-splines around a query and their derivatives with respect to its fraction of the cell; in each
/// pack the axes a/b, t, α, β.
struct CreepSplineWeights {
  Pack value[4], slope[4];

  explicit CreepSplineWeights(const Pack& f) noexcept {
    constexpr double sixth = 1.0 / 6.0;
    const Pack g = 1.0 - f, ff = f * f, gg = g * g;
    value[0] = sixth * gg * g;
    value[1] = sixth * (4.0 + ff * (3.0 * f - 6.0));
    value[2] = sixth * (4.0 + gg * (3.0 * g - 6.0));
    value[3] = sixth * ff * f;
    slope[0] = -0.5 * gg;
    slope[1] = f * (1.5 * f - 2.0);
    slope[2] = g * (2.0 - 1.5 * g);
    slope[3] = 0.5 * ff;
  }
};

/// What a query wants of the force: itself, its derivatives with respect to the creepages, and to a/b.
enum class CreepWanted { force, by_creepage, by_ratio_too };

/// V = (F_x/t, F_y/t, M_z/(t m)), the fourth lane idle, and its derivatives, where wanted, with respect to t, α, β and
/// a/b in their steps.
struct CreepSplineJet {
  Pack value, t, alpha, beta, alpha_beta, ratio;
};

namespace creep_spline_detail {

/// Four places of β, three functions each, one after the other in three packs: with one place in each.
inline void separate(const Pack* three, Pack* places) noexcept {
  places[0] = three[0];
  places[1] = __builtin_shufflevector(three[0], three[1], 3, 4, 5, 5);
  places[2] = __builtin_shufflevector(three[1], three[2], 2, 3, 4, 4);
  places[3] = __builtin_shufflevector(three[2], three[2], 1, 2, 3, 3);
}

inline void over_beta(const Pack* places, const Pack* weights, Pack& sum) noexcept {
  constexpr int beta = 3;
  sum = weights[0][beta] * places[0] + weights[1][beta] * places[1] + weights[2][beta] * places[2] +
        weights[3][beta] * places[3];
}

}  // namespace creep_spline_detail

/// Contraction of the 4⁴ coefficients around a query. The coefficients are floats, the sums are not: what a query
/// returns is as smooth as the spline, to rounding of doubles.
/// @param corner of place (0, 0, 0, 0); three functions to a place, β fastest. @param stride of a/b, t, α, in floats
template <CreepWanted wanted>
void creep_spline_jet(const float* corner, const std::array<std::size_t, 3>& stride, const CreepSplineWeights& w,
                      CreepSplineJet& jet) noexcept {
  using creep_spline_detail::over_beta, creep_spline_detail::separate;
  constexpr int ratio = 0, t = 1, alpha = 2;
  constexpr bool by_ratio = wanted == CreepWanted::by_ratio_too, slopes = wanted != CreepWanted::force;
  constexpr int packs = 3;  // four places of β, three functions
  Pack value[packs]{}, by_t[packs]{}, by_alpha[packs]{}, along_ratio[packs]{};
  // a/b first: it leaves a quarter of the numbers for the rest.
  for (std::size_t l = 0; l < 4; ++l) {
    Pack at_alpha[packs]{}, slope_t[packs]{}, slope_ratio[packs]{};
    for (std::size_t j = 0; j < 4; ++j) {
      const float* row = corner + j * stride[1] + l * stride[2];
      for (int q = 0; q < packs; ++q, row += 4) {
        Pack c[4];
        for (std::size_t i = 0; i < 4; ++i) widen(row + i * stride[0], c[i]);
        if constexpr (by_ratio) {
          slope_ratio[q] += w.value[j][t] * (w.slope[0][ratio] * c[0] + w.slope[1][ratio] * c[1] +
                                             w.slope[2][ratio] * c[2] + w.slope[3][ratio] * c[3]);
        }
        c[0] =
            w.value[0][ratio] * c[0] + w.value[1][ratio] * c[1] + w.value[2][ratio] * c[2] + w.value[3][ratio] * c[3];
        at_alpha[q] += w.value[j][t] * c[0];
        if constexpr (slopes) slope_t[q] += w.slope[j][t] * c[0];
      }
    }
    for (int q = 0; q < packs; ++q) {
      value[q] += w.value[l][alpha] * at_alpha[q];
      if constexpr (slopes) {
        by_alpha[q] += w.slope[l][alpha] * at_alpha[q];
        by_t[q] += w.value[l][alpha] * slope_t[q];
      }
      if constexpr (by_ratio) along_ratio[q] += w.value[l][alpha] * slope_ratio[q];
    }
  }
  Pack v[4];
  separate(value, v);
  over_beta(v, w.value, jet.value);
  if constexpr (!slopes) return;
  Pack v_t[4], v_alpha[4];
  separate(by_t, v_t);
  separate(by_alpha, v_alpha);
  over_beta(v_t, w.value, jet.t);
  over_beta(v_alpha, w.value, jet.alpha);
  over_beta(v, w.slope, jet.beta);
  over_beta(v_alpha, w.slope, jet.alpha_beta);
  if constexpr (by_ratio) {
    Pack v_ratio[4];
    separate(along_ratio, v_ratio);
    over_beta(v_ratio, w.value, jet.ratio);
  }
}

}  // namespace railtab
