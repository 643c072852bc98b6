#pragma once

#include <string>
#include <vector>

#include "railtab/runtime/line/irregularity.hpp"

namespace railtab {

/// How rails deviate where bridge spans move as rigid bodies [MontenegroCalcada2023, Fig. 21].
enum class SpanDeviationShape {
  bending,         ///< BS: two spans fold about their common support, which moves by the amplitude
  parallel_shift,  ///< PS: one span turns, so that the track beyond it is shifted by the amplitude
};
enum class SpanDeviationDirection { vertical, lateral };

struct SpanDeviationParameters {
  SpanDeviationShape shape = SpanDeviationShape::bending;
  SpanDeviationDirection direction = SpanDeviationDirection::vertical;
  double span = 20.0;        ///< length of a span L [m], > 0
  double amplitude = 0.008;  ///< δ [m]; down or to the right where positive
  double start = 0.0;        ///< where the first span that moves begins [m]
  /// Relative bending stiffness of rails and pads β (Eq. 23) [1/m]; 0: that of Table 3, transition_stiffness().
  double beta = 0.0;
  void validate() const;  ///< @throws InputError
};

/// β = (k_p/(4 E I_r))^{1/4} (Eq. 23) [1/m].
/// @param pad_stiffness per length of rail [N/m²]; @param EI of the rail [N m²]
[[nodiscard]] double transition_stiffness(double pad_stiffness, double EI) noexcept;
/// β of [MontenegroCalcada2023, Table 3]: 1.387 1/m vertical, 3.239 1/m lateral.
[[nodiscard]] double transition_stiffness(SpanDeviationDirection direction) noexcept;

/// Deviation of both rails from spans that turn by θ = ±δ/L as rigid bodies. Every kink of angle θ is smoothed as the
/// rail on its pads would: on a Winkler foundation that has the kink,
///   r(s) = θ max(s, 0) + θ/(4β) e^{−β|s|} (cos β|s| − sin β|s|),
/// which is Eq. 22 (with the sign of its second branch put right) without its end at |s| = L_t. Twice continuously
/// differentiable; zero before the first span but for the decay.
class SpanDeviation {
 public:
  explicit SpanDeviation(const SpanDeviationParameters& parameters);  ///< @throws InputError
  [[nodiscard]] RailDeviation at(double x) const noexcept;

 private:
  struct Kink {
    double x, angle;
  };
  std::vector<Kink> kinks_;
  double beta_ = 0.0;
  SpanDeviationDirection direction_;
};

}  // namespace railtab
