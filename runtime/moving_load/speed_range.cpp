#include "railtab/runtime/moving_load/speed_range.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <optional>

#include "railtab/runtime/moving_load/work_sharing.hpp"

namespace railtab {
namespace {

enum class Quantity { acceleration, displacement };

double value_of(const PassagePeaks& passage, Quantity quantity) {
  return quantity == Quantity::acceleration ? passage.acceleration.value : passage.displacement.value;
}

const PassagePeaks& largest(const std::vector<PassagePeaks>& passages, Quantity quantity) {
  return *std::max_element(passages.begin(), passages.end(), [quantity](const auto& a, const auto& b) {
    return value_of(a, quantity) < value_of(b, quantity);
  });
}

/// Search for the largest values of one train over the speed.
class SpeedSearch {
 public:
  SpeedSearch(const ModalDeck& deck, const AxleTrain& train, double low, double high)
      : deck_(deck), train_(train), force_(modal_force(deck, train)), low_(low), high_(high) {}

  std::vector<PassagePeaks> run() {
    constexpr int even = 7;
    for (int i = 0; i < even; ++i) evaluate(low_ + (high_ - low_) * i / (even - 1));
    evaluate_resonances();
    for (const Quantity quantity : {Quantity::acceleration, Quantity::displacement}) {
      while (found_.size() < most_passages) {
        const std::optional<double> next = next_speed(quantity);
        if (!next) break;
        evaluate(*next);
      }
    }
    std::vector<PassagePeaks> passages;
    for (const auto& [speed, passage] : found_) passages.push_back(passage);
    return passages;
  }

 private:
  using Found = std::map<double, PassagePeaks>;
  static constexpr std::size_t most_passages = 25;

  void evaluate(double speed) { found_.emplace(speed, train_passage(deck_, train_, force_, speed)); }

  /// The highest peaks of the free amplitude over the speed.
  void evaluate_resonances() {
    constexpr int intervals = 200;
    constexpr std::size_t most_peaks = 4;
    constexpr double lowest_share = 0.5;
    const AxleTrain axle{"", {0.0}, {1.0}, 0.0, 0.0, false, {}};
    const ModalForce unit = modal_force(deck_, axle);
    std::vector<double> speed, acceleration, displacement;
    for (int i = 0; i <= intervals; ++i) {
      speed.push_back(low_ + (high_ - low_) * i / intervals);
      const FreeAmplitude amplitude = free_amplitude(deck_, train_, unit, speed.back());
      acceleration.push_back(amplitude.acceleration);
      displacement.push_back(amplitude.displacement);
    }
    for (const std::vector<double>* curve : {&acceleration, &displacement}) {
      std::vector<std::pair<double, double>> peaks;  // amount, speed
      for (std::size_t i = 1; i + 1 < curve->size(); ++i) {
        if ((*curve)[i] > (*curve)[i - 1] && (*curve)[i] >= (*curve)[i + 1]) peaks.emplace_back((*curve)[i], speed[i]);
      }
      std::sort(peaks.rbegin(), peaks.rend());
      const std::size_t count = std::min(curve == &acceleration ? most_peaks : most_peaks / 2, peaks.size());
      for (std::size_t k = 0; k < count && peaks[k].first > lowest_share * peaks.front().first; ++k) {
        evaluate(peaks[k].second);
      }
    }
  }

  /// Where a peak among the passages may rise: its height by the parabola through it and its neighbours, and the speed
  /// to try next; none where the peak is known well enough.
  struct Rise {
    double height, next;
  };
  [[nodiscard]] std::optional<Rise> rise(Found::const_iterator peak, Quantity quantity) const {
    constexpr double narrow = 0.005, gain = 5e-4;
    const double b = peak->first, fb = value_of(peak->second, quantity), width = narrow * (high_ - low_);
    if (peak == found_.begin() || std::next(peak) == found_.end()) {
      const double side = peak == found_.begin() ? std::next(peak)->first : std::prev(peak)->first;
      if (std::abs(side - b) <= 2.0 * width) return std::nullopt;
      return Rise{fb, 0.5 * (b + side)};
    }
    const double a = std::prev(peak)->first, c = std::next(peak)->first;
    const double fa = value_of(std::prev(peak)->second, quantity), fc = value_of(std::next(peak)->second, quantity);
    const double left = (fb - fa) / (b - a), right = (fc - fb) / (c - b), bend = (right - left) / (c - a);
    const double slope = left + bend * (b - a), top = bend < 0.0 ? b - 0.5 * slope / bend : b;
    const double height = bend < 0.0 ? fb - 0.25 * slope * slope / bend : fb;
    const double wider = std::max(b - a, c - b);
    if (wider <= 4.0 * width && height < (1.0 + gain) * fb) return std::nullopt;
    if (wider <= 2.0 * width) return std::nullopt;
    const bool lopsided = wider > 4.0 * std::min(b - a, c - b);
    if (!lopsided && std::abs(top - b) > 0.25 * width && top > a && top < c) return Rise{height, top};
    return Rise{height, b - a > c - b ? b - std::min(0.5 * (b - a), 2.0 * (c - b))
                                      : b + std::min(0.5 * (c - b), 2.0 * (b - a))};
  }

  /// The speed to try next among all peaks that may be the highest.
  [[nodiscard]] std::optional<double> next_speed(Quantity quantity) const {
    constexpr double rival = 0.97;
    double highest = 0.0;
    for (const auto& [speed, passage] : found_) highest = std::max(highest, value_of(passage, quantity));
    std::optional<Rise> best;
    for (auto it = found_.begin(); it != found_.end(); ++it) {
      const double f = value_of(it->second, quantity);
      const bool above_left = it == found_.begin() || f >= value_of(std::prev(it)->second, quantity);
      const bool above_right = std::next(it) == found_.end() || f >= value_of(std::next(it)->second, quantity);
      if (!above_left || !above_right) continue;
      const std::optional<Rise> found = rise(it, quantity);
      if (found && found->height >= rival * highest && (!best || found->height > best->height)) best = found;
    }
    if (!best) return std::nullopt;
    return best->next;
  }

  const ModalDeck& deck_;
  const AxleTrain& train_;
  ModalForce force_;
  double low_, high_;
  Found found_;
};

}  // namespace

const PassagePeaks& TrainResponse::critical_acceleration() const { return largest(passages, Quantity::acceleration); }
const PassagePeaks& TrainResponse::critical_displacement() const { return largest(passages, Quantity::displacement); }

std::vector<TrainResponse> train_responses(const ModalDeck& deck, const std::vector<AxleTrain>& trains,
                                           const SpeedRange& range, int threads,
                                           const std::function<void(double)>& finished) {
  std::vector<TrainResponse> responses(trains.size());
  std::vector<ModalForce> forces(trains.size());
  std::mutex reporting;
  std::size_t done = 0;
  const bool refined = range.speeds.empty();
  const std::size_t passages = refined ? 1 : range.speeds.size(), count = trains.size() * (passages + 1);
  const auto report = [&] {
    const std::lock_guard lock(reporting);
    ++done;
    if (finished) finished(static_cast<double>(done) / static_cast<double>(count));
  };
  share_work(trains.size(), threads, [&](std::size_t t) {
    responses[t].train = t;
    responses[t].standing = largest_static_deflection(deck, trains[t]);
    if (!trains[t].only_static && !refined) {
      forces[t] = modal_force(deck, trains[t]);
      responses[t].passages.resize(passages);
    }
    report();
  });
  share_work(trains.size() * passages, threads, [&](std::size_t task) {
    const std::size_t t = task / passages, i = task % passages;
    if (!trains[t].only_static) {
      if (refined) {
        responses[t].passages = SpeedSearch(deck, trains[t], range.low, range.high).run();
      } else {
        responses[t].passages[i] = train_passage(deck, trains[t], forces[t], range.speeds[i]);
      }
    }
    report();
  });
  return responses;
}

}  // namespace railtab
