#include "railtab/runtime/moving_load/resonance_curve.hpp"

#include <algorithm>
#include <cmath>

#include "railtab/runtime/moving_load/modal_motion.hpp"

namespace railtab {
namespace {

/// Amplitude of a mode after one axle of 1 N has crossed.
double left_by_one_axle(const ModalDeck& deck, const ModalForce& unit, int n, double speed) {
  ModalMotion mode(deck.omega[n], deck.damping[n]);
  double q = 0.0, dq = 0.0;
  for (std::size_t p = 0; p < unit.pieces(); ++p) {
    const double duration = (unit.start[p + 1] - unit.start[p]) / speed;
    mode.begin(q, dq, unit.cubic[p * static_cast<std::size_t>(unit.modes) + static_cast<std::size_t>(n)], speed);
    mode.move(duration, mode.factor(duration));
    q = mode.q();
    dq = mode.velocity();
  }
  mode.begin(q, dq, {0.0, 0.0, 0.0, 0.0}, speed);
  return std::abs(mode.free_part());
}

/// The distances between axles, each once, and which of them is ahead of each axle.
struct Gaps {
  std::vector<double> distance;
  std::vector<std::size_t> ahead;
  explicit Gaps(const AxleTrain& train) {
    constexpr double alike = 1e-9;  // [m]
    for (std::size_t k = 1; k < train.behind.size(); ++k) {
      const double gap = train.behind[k] - train.behind[k - 1];
      const auto found =
          std::find_if(distance.begin(), distance.end(), [gap](double other) { return std::abs(other - gap) < alike; });
      ahead.push_back(static_cast<std::size_t>(found - distance.begin()));
      if (found == distance.end()) distance.push_back(gap);
    }
  }
};

/// The largest |Σ_k P_k e^{λ(t_K − t_k)}| over K [N].
double largest_sum(const ModalMotion& mode, const AxleTrain& train, const Gaps& gaps, double speed,
                   std::vector<std::complex<double>>& factor) {
  for (std::size_t g = 0; g < gaps.distance.size(); ++g) factor[g] = mode.factor(gaps.distance[g] / speed);
  std::complex<double> sum = train.load.front();
  double most = std::norm(sum);
  for (std::size_t k = 1; k < train.load.size(); ++k) {
    sum = sum * factor[gaps.ahead[k - 1]] + train.load[k];
    most = std::max(most, std::norm(sum));
  }
  return std::sqrt(most);
}

}  // namespace

ResonanceCurve resonance_curve(const ModalDeck& deck, const AxleTrain& train, double low, double high) {
  constexpr double per_beat = 6.0;
  constexpr int fewest = 100, most = 3000, per_axle_amplitude = 8;
  const double beats = deck.frequency(deck.dynamic_modes - 1) * train.reach() * (1.0 / low - 1.0 / high);
  const int steps = static_cast<int>(std::clamp(per_beat * beats, double{fewest}, double{most}));
  ResonanceCurve curve;
  for (int i = 0; i <= steps; ++i) curve.speed.push_back(1.0 / (1.0 / low + (1.0 / high - 1.0 / low) * i / steps));
  curve.acceleration.assign(curve.speed.size(), 0.0);
  curve.displacement.assign(curve.speed.size(), 0.0);
  AxleTrain axle;
  axle.behind = {0.0};
  axle.load = {1.0};
  const ModalForce unit = modal_force(deck, axle);
  const Gaps gaps(train);
  std::vector<std::complex<double>> factor(gaps.distance.size());
  for (int n = 0; n < deck.dynamic_modes; ++n) {
    const ModalMotion mode(deck.omega[n], deck.damping[n]);
    double here = left_by_one_axle(deck, unit, n, curve.speed.front()), ahead = here;  // of one axle: varies slowly
    for (int i = 0; i <= steps; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const int part = i % per_axle_amplitude;
      if (part == 0) {
        here = ahead;
        const int next = std::min(i + per_axle_amplitude, steps);
        ahead = left_by_one_axle(deck, unit, n, curve.speed[static_cast<std::size_t>(next)]);
      }
      const double one = here + (ahead - here) * part / per_axle_amplitude;
      const double w = one * deck.largest_shape[n] * largest_sum(mode, train, gaps, curve.speed[k], factor);
      curve.displacement[k] += w;
      curve.acceleration[k] += w * deck.omega[n] * deck.omega[n];
    }
  }
  return curve;
}

}  // namespace railtab
