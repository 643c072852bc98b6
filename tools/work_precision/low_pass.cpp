#include "low_pass.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace railtab::work_precision {
namespace {

/// Direct form II transposed of H(s) = 1/(1 + c s/ω + s²/ω²) under the bilinear transform.
class Section {
 public:
  Section(double c, double limit, double time_step) {
    const double w = std::tan(std::numbers::pi * limit * time_step);
    const double norm = 1.0 / (1.0 + c * w + w * w);
    b_ = w * w * norm;
    a1_ = 2.0 * (w * w - 1.0) * norm;
    a2_ = (1.0 - c * w + w * w) * norm;
  }
  /// As if `value` had come in for ever.
  void settle(double value) {
    second_ = (b_ - a2_) * value;
    first_ = (2.0 * b_ - a1_) * value + second_;
  }
  double operator()(double value) {
    const double out = b_ * value + first_;
    first_ = 2.0 * b_ * value - a1_ * out + second_;
    second_ = b_ * value - a2_ * out;
    return out;
  }

 private:
  double b_, a1_, a2_, first_ = 0.0, second_ = 0.0;
};

void filter(std::vector<std::vector<float>>& steps, double limit, double time_step) {
  if (steps.empty()) return;
  for (const double pole : {0.125, 0.375}) {  // Butterworth's, fourth order [half a turn]
    Section low_pass(2.0 * std::cos(std::numbers::pi * pole), limit, time_step);
    for (std::size_t k = 0; k < steps.front().size(); ++k) {
      low_pass.settle(steps.front()[k]);
      for (auto step = steps.begin(); step != steps.end(); ++step)
        (*step)[k] = static_cast<float>(low_pass((*step)[k]));
      low_pass.settle(steps.back()[k]);
      for (auto step = steps.rbegin(); step != steps.rend(); ++step)
        (*step)[k] = static_cast<float>(low_pass((*step)[k]));
    }
  }
  constexpr double settling = 0.12;  // s, whole steps of 0.5 to 2 ms and of 1.5 ms
  const auto ends = std::min(static_cast<std::ptrdiff_t>(std::lround(settling / time_step)),
                             static_cast<std::ptrdiff_t>(steps.size() / 2));
  steps.erase(steps.end() - ends, steps.end());
  steps.erase(steps.begin(), steps.begin() + ends);
}

}  // namespace

ComparedHistory low_passed(const ComparedHistory& history, double time_step, double force_limit, double deck_limit) {
  ComparedHistory result = history;
  filter(result.force, force_limit, time_step);
  filter(result.lateral, force_limit, time_step);
  filter(result.deck, deck_limit, time_step);
  return result;
}

}  // namespace railtab::work_precision
