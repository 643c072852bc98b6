#include "railtab/runtime/moving_load/speed_search.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "railtab/runtime/base/linear_interpolation.hpp"
#include "railtab/runtime/moving_load/resonance_curve.hpp"

namespace railtab {
namespace {

using Quantity = DeckPeak PassagePeaks::*;
using Found = std::map<double, PassagePeaks>;

/// At each speed of the curve the distance within which it falls by 4 % on its nearer side [m/s].
std::vector<double> widths(const std::vector<double>& speed, const std::vector<double>& value) {
  constexpr double share = 0.96;
  std::vector<double> width;
  const std::size_t last = speed.size() - 1;
  for (std::size_t k = 0; k <= last; ++k) {
    std::size_t left = k, right = k;
    while (left > 0 && right < last && value[left] > share * value[k] && value[right] > share * value[k]) {
      --left;
      ++right;
    }
    width.push_back(std::max(speed[k] - speed[left], speed[right] - speed[k]));
    width.back() = std::max(width.back(), 1e-3 * (speed[last] - speed[0]));
  }
  return width;
}

/// One quantity over the speed, estimated from the resonance curve and the passages found.
class Estimate {
 public:
  Estimate(const std::vector<double>& speed, const std::vector<double>& resonance, Quantity quantity)
      : speed_(speed), resonance_(resonance), width_(widths(speed, resonance)), quantity_(quantity) {}

  /// The speed of the next passage; none where no speed promises more.
  [[nodiscard]] std::optional<double> next(const Found& found) const {
    constexpr double bonus = 0.05, gain = 1.002, nearest = 0.05;
    double least = INFINITY, highest = 0.0;
    for (const auto& [speed, passage] : found) {
      least = std::min(least, (passage.*quantity_).value);
      highest = std::max(highest, (passage.*quantity_).value);
    }
    std::optional<double> best;
    double best_promise = gain * highest;
    auto right = std::next(found.begin());
    for (std::size_t k = 0; k < speed_.size(); ++k) {
      const double v = speed_[k];
      while (std::next(right) != found.end() && right->first < v) ++right;
      const auto left = std::prev(right);
      const double distance = std::min(std::abs(v - left->first), std::abs(right->first - v)) / width_[k];
      if (distance < nearest) continue;
      const double part = std::clamp((v - left->first) / (right->first - left->first), 0.0, 1.0);
      const double factor = (1.0 - part) * factor_at(*left, least) + part * factor_at(*right, least);
      const double promise = factor * std::hypot(resonance_[k], least) * (1.0 + bonus * std::min(1.0, distance));
      if (promise > best_promise) {
        best_promise = promise;
        best = v;
      }
    }
    return best;
  }

 private:
  [[nodiscard]] double factor_at(const Found::value_type& passage, double least) const {
    return (passage.second.*quantity_).value / std::hypot(interpolate(speed_, resonance_, passage.first), least);
  }

  const std::vector<double>& speed_;
  const std::vector<double>& resonance_;
  std::vector<double> width_;
  Quantity quantity_;
};

/// Speeds of the highest peaks of a curve.
std::vector<double> highest_peaks(const std::vector<double>& speed, const std::vector<double>& value,
                                  std::size_t most) {
  std::vector<std::pair<double, double>> peaks;  // amount, speed
  for (std::size_t i = 1; i + 1 < value.size(); ++i) {
    if (value[i] > value[i - 1] && value[i] >= value[i + 1]) peaks.emplace_back(value[i], speed[i]);
  }
  std::sort(peaks.rbegin(), peaks.rend());
  std::vector<double> speeds;
  for (std::size_t k = 0; k < std::min(most, peaks.size()); ++k) speeds.push_back(peaks[k].second);
  return speeds;
}

}  // namespace

std::vector<PassagePeaks> search_critical_speeds(const ModalDeck& deck, const AxleTrain& train, double low,
                                                 double high) {
  constexpr int even = 5;
  constexpr std::size_t most_passages = 25;
  const ModalForce force = modal_force(deck, train);
  const ResonanceCurve curve = resonance_curve(deck, train, low, high);
  const Estimate acceleration(curve.speed, curve.acceleration, &PassagePeaks::acceleration);
  const Estimate displacement(curve.speed, curve.displacement, &PassagePeaks::displacement);
  Found found;
  const auto evaluate = [&](double speed) { found.emplace(speed, train_passage(deck, force, speed)); };
  for (int i = 0; i < even; ++i) evaluate(low + (high - low) * i / (even - 1));
  for (const double speed : highest_peaks(curve.speed, curve.acceleration, 3)) evaluate(speed);
  for (const double speed : highest_peaks(curve.speed, curve.displacement, 2)) evaluate(speed);
  for (int round = 0; found.size() < most_passages; ++round) {
    const bool second = round % 3 == 2;  // every third passage for the displacement, which has fewer peaks
    std::optional<double> next = (second ? displacement : acceleration).next(found);
    if (!next) next = (second ? acceleration : displacement).next(found);
    if (!next) break;
    evaluate(*next);
  }
  std::vector<PassagePeaks> passages;
  for (const auto& [speed, passage] : found) passages.push_back(passage);
  return passages;
}

}  // namespace railtab
